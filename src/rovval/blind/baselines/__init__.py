"""Simple methods that answer the same logs as the diagnosis: least squares on derivatives, sparse regression, a ridge over everything."""
