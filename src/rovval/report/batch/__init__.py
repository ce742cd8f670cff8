"""Report of a batch of logs: one page with a row a run."""
