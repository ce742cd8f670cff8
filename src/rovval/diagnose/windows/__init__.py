"""Windows: what of a log is measurement, and how it is cut for multiple shooting."""
