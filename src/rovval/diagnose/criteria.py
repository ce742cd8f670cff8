"""Every number of the diagnosis that decides anything: name, value, unit, what it means and where it comes from.

The sections follow the rooms of `diagnose`, from the ground up. "Chosen" is a judgement of the authors without a published source; "opened sets" are
development logs with a known answer (`rovval blind`). What belongs to one effect stands in that effect's file.
"""

# -- windows: what of a log is measurement, and how it is cut -----------------------------------------------------------------------


# -- residuals: sensitivities, parity and normal equations --------------------------------------------------------------------------


# -- inference: prior, noise model, disturbance, MAP fit, cross-validation, intervals -----------------------------------------------

PRIOR_WIDTH = 4.0  # wide prior, in typical sizes: keeps a parameter that the log does not see from running away
FEW_WINDOWS = 6  # chosen: windows that are too few to average the form of an equation over

# -- hypotheses: which could be told by this log, and where their fits begin --------------------------------------------------------


# -- search: detection, candidates, forward selection, confusion groups, onsets -----------------------------------------------------


# -- decision: benefit, constancy, consistency, verdict -----------------------------------------------------------------------------


# -- result: attribution, next experiment, recalibration ----------------------------------------------------------------------------
