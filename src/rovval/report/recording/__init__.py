"""The recording for the rerun viewer: simulated and measured in time and in 3-D."""
