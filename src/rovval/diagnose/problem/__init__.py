"""The estimation problem: tolerances, noise and disturbances, held-out folds, and the metrics in which residuals are weighed."""
