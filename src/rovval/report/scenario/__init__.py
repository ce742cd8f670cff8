"""Reports of the thesis's test scenarios: in a terminal, and as one document with its figures 5.1 to 5.21 from our own simulations."""
