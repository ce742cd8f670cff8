"""Inference: MAP fit, Laplace evidence, standard errors, held-out reduction of the gap, identifiability."""
