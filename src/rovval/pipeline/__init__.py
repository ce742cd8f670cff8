"""Batch: discover logs, plan over content hashes, run the steps in processes, set bad logs aside, sum up."""
