"""The plant in plain NumPy, written from the equations: what the compiled kernel is tested against, lane by lane."""
