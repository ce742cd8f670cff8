"""Report of a blind check: how often the answers are right on each kind of logs."""
