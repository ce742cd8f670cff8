"""Answers against labels: what counts as right, scores of each log, strata with intervals, and the history of all unsealings."""
