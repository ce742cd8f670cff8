"""The library: one file an effect, found by being there."""
