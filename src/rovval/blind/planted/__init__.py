"""Everything that can be planted, a family a file. Each class is one effect; ``rovval.blind.planted.catalogue`` lists them."""
