"""Every number of the diagnosis that decides anything, with its meaning, unit and origin."""

PRIOR_WIDTH = 4.0  # wide prior, in typical sizes: keeps a parameter that the log does not see from running away
FEW_WINDOWS = 6  # chosen: windows that are too few to average the form of an equation over
