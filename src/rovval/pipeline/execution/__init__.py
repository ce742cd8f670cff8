"""Tasks over workers, of this machine or of a cluster: one log through its steps."""
