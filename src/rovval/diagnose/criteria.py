"""Every number of the diagnosis that decides anything: name, value, unit, what it means and where it comes from.

The sections follow the rooms of `diagnose`, from the ground up. How hard it looks for models stands in `effort`. "Chosen" is a judgement of the authors
without a published source; "opened sets" are development logs with a known answer (`rovval blind`). What belongs to one effect stands in that effect's file.
"""

MATERIAL = 0.05  # share of a sum of squares (of a variance, of a gap) from which something is worth acting on or telling (chosen)

# -- windows: what of a log is measurement, and how it is cut -----------------------------------------------------------------------

LEAST_NOISE = {  # m/s, rad/s, rad, m: standard deviation below which no sensor of an ROV is believed (chosen; a noise-free log divides by nothing)
    "u": 1e-3, "v": 1e-3, "w": 1e-3, "p": 1e-3, "q": 1e-3, "r": 1e-3, "phi": 1e-3, "theta": 1e-3, "psi": 2e-3, "x": 5e-3, "y": 5e-3, "z": 5e-3,
}  # fmt: skip
OUTLIER_SIGMA = 8.0  # standard deviations: a sample this far from the mean of its neighbours is an outlier of the sensor (chosen)
QUANTISED_REPEATS = 5  # how often each value repeats itself on average in a channel of coarse steps (chosen)
QUANTISED_MISFIT = 0.1  # of a step: by how much values may miss the grid of steps (chosen)
SATURATED_SAMPLES = 8  # samples at the end of a range that are no coincidence (chosen)
SATURATED_PROMINENCE = 5  # times as many as at any of the next three values (chosen)
SATURATED_RISE = 3.0  # times the rounding step, by which the end of a range is reached in one sample: a steady state is neared slowly (chosen)
HELD_SHARE = 0.3  # of the samples that repeat the one before: more is a slow sensor, written at the log's rate (chosen)
SLOWEST_PING, PING_REGULARITY = 30, 0.9  # samples between pings at most, and share of the pings that keep such a period (chosen)
AT_REST_S, AT_REST_M = 3.0, 0.03  # s, m: aground is at rest so long within the noise of a depth sensor (chosen)
CONTACT_DEPTH_RANGE = 0.3  # m: contact is looked for in logs that change depth by more (chosen)
CONTACT_DEPTH_MARGIN = 0.08  # m: within this of the ends of the depth range that the log covers (chosen)
LEAST_WINDOWS = 3  # of a run, of a level between two changes, before an onset: one to hold out, two to fit on
FEW_WINDOWS = 6  # windows: fewer are too few to average model-form error over, or to tell a steady force from a disturbance (chosen)
SMOOTHING = 11  # samples, 1 s at 10 Hz: over which form error is averaged, and motion smoothed for what would drown in noise, as a delay's slope (chosen)
MEASURED_SHARE = 0.6  # of a window's samples: with fewer measured it is left out (chosen)


# -- residuals: sensitivities, parity and normal equations --------------------------------------------------------------------------

UNLOGGED_START_SD = 0.3  # m/s, rad/s, rad: start of what was neither logged nor follows from the pose: anything slow is possible (chosen)
LEAST_START_SD = 0.005  # m/s, rad/s, m: least error of a start of which the value itself was measured (chosen),
LEAST_ANGLE_START_SD = 0.01  # rad: and of one that is an angle, half a degree (chosen)
SLOPE_START_NOISE = 3.0  # times the noise of a logged pose: error of a start taken as its slope over a second (chosen)
SLOPE_START_SD = 0.01  # m/s, rad/s: least error of a start taken as the slope of the logged pose over a second (chosen)
ATTITUDE_DRIFT_SD = 0.004  # rad: slow error of an AHRS within a window, 0.2 degrees (MTi class data sheets)
SIGN_SMOOTHING = 0.1  # of a velocity's rms: from there on a generic force that depends on its sign has reached its size (chosen)
LEAST_AXIS_FORCE = 0.01  # of the largest axis's force, and that of the weight: no axis is held to have less, so that none is mute (chosen)
PARITY_LEAST_SD = (0.005, 0.005, 0.002, 0.001, 0.001, 0.001)  # m, rad: noise of a parity relation below which no sensor is believed (chosen)
PARITY_MEASURED_SHARE = 0.9  # of a window's samples, of every velocity and angle: with fewer measured, bridged gaps would look like faults (chosen)
DEAD_RECKONED_SHARE = 0.5  # of its noise: a position that follows the integrated velocity closer was integrated from it (chosen)
FAULT_SPARE_WINDOWS = 5  # windows more than parameters, from which their scatter says how sure a sensor fault is: six for one


# -- problem and inference: prior, noise model, disturbance, cross-validation, MAP fit, intervals -----------------------------------

OUT_OF_TOLERANCE = 5.0  # standard deviations of tolerance from which a coefficient is off by more than a tolerance of the stated size
HELD_OUT_RUNS = 3  # runs from which one is held out at a time; of fewer, windows are (chosen)
HELD_OUT_FOLDS = 5  # folds of windows (Hastie, Tibshirani and Friedman 2009, 7.10: five to ten)
HELD_OUT_BLOCK = 2  # neighbouring windows that are held out together: 20 s, beyond the memory of hull and thrusters
STEADY_FORCE_SD = 0.1  # prior of a steady force of the environment, as a share of the thrusters' rms on its axis
SEGMENT_CORRELATION = (0.02, 0.98)  # limits of a disturbance's correlation from one segment of a window to the next
INTERVAL_PROBABILITY = 0.90  # of every interval that is stated
OBSERVABLE_SIGMA = 3.0  # standard errors with which an effect of typical size must show in a log for its absence to mean anything (chosen)
CORRELATED = 0.7  # correlation from which two numbers are told to be seen together only: half of the variance of each is the other's
WIDEST_INTERVAL = 2.0  # typical sizes: a half interval beyond it about what the file has, at the fitted point, is no answer (chosen)
EXACT_WINDOWS = 8.0  # windows for which the equations are as good as exact: of m, each says 1 / (1 + m / this) of what it seems to (development logs)
PRIOR_WIDTH = 4.0  # wide prior, in typical sizes, in which effects are fitted: keeps a parameter that the log does not see from running away
PRIOR_FREEDOM = 3.0  # of Student's t, scaled by the typical size, the prior in which effects are compared: large ones are rare, not impossible (chosen)


# -- hypotheses: which could be told by this log, and where their fits begin --------------------------------------------------------

LARGE_SIZE = 3.0  # typical sizes: an effect so large must show as much, or it does not compete (chosen); in few windows a typical one must
CHANGE_FALSE_ALARM = 0.01  # rate at which a log without a change of level is split all the same (chosen)
SHORTEST_PERIOD_S = 2.0  # s: the shortest period of an effect of the library; ten samples of it are enough
SPRING_LEAST_STIFFNESS = 5.0  # N/m: half of what is typical of `tether_snag`; softer is an even pull (opened sets: snags 8 to 900, an even pull 0 to 3)


# -- search and decision: prior masses, what is fitted, something else ---------------------------------------------------------------

# Evidence is twice the logarithm of a Bayes factor: 2 to 6 is positive, 6 to 10 strong, above 10 very strong (Kass and Raftery 1995).
PRIOR_HEALTHY = 0.50  # prior mass of a vehicle that is as its file has it, within tolerance (chosen: one log in two has nothing to find),
PRIOR_CAUSES = 0.43  # of causes of the library, one or several (chosen),
FURTHER_CAUSE = 1.0 / 3.0  # each further one has this share of the mass that there is without it (chosen),
PRIOR_FILE = 0.02  # of a file that is off in many numbers at once (chosen),
PRIOR_SOMETHING_ELSE = 0.05  # and of something that the library does not hold (chosen)
LIBRARY_ALIKE = 2.0 / 3.0  # share of what the library lacks that looks like something of it (opened and development sets of three plants: 11 of 16)
NOT_FOUND = 0.05  # share of logs of the library's effects that no set of causes that is fitted explains (opened logs of two plants: 7 of 175 by today's search)
SHOWS_BESIDE = (0.08, 0.5)  # share of logs with generic forces beside causes that are right, and that only look it (three plants: 6 of 87, 26 of 52)
FORCE_RIGHT = 0.02  # median unlogged force where right causes act, in the thrusters' (160 opened logs of two plants: 0.015 and 0.026),
FORCE_ALIKE = 0.10  # and where only what looks like causes does (77 logs of three plants: 0.10 of 43, 0.14 of 34),
FORCE_SHAPE = 1.5  # shape of the log-logistic distributions of both (the same logs: 1.6 and 1.2; an exponential is 46 worse in log likelihood)
HEALTHY_GAP = 0.20  # mean gap above noise of healthy vehicles over what tolerances could make (36 healthy logs of two plants: 0.22, 0.07 to 0.78)
CALIBRATED_SPREAD = 0.7  # of the log of the gap over what a calibration left, where it has one run: 0.25 on logs of one pilot in MuJoCo, 1.2 on tank runs
CAUSES_LEAVE = 0.15  # mean share that right causes leave where they act on held-out windows (58 effects of two plants: 0.04 to 0.12; real runs: more),
FORM_LEAVES = 0.90  # and of what the others leave, that their form error leaves where it is taken for one more cause (opened sets and real runs: 0.90 of 57)
BETWEEN_CAUSES = 0.4  # power of the posterior odds of sets of as many causes (156 opened logs of two plants: log loss 0.40 at 0.2, 0.36 here, 0.35 at 1)
FORM_ALIKE = 0.25  # prior probability that the form error of causes looks like one more (development logs: of 18 further names on three plants 10 are right)
FILE_WIDTH = 10.0  # times the tolerance: prior standard deviation of a number of such a file (chosen: 50 % where the tolerance is 5 %)
NAMED_FROM = 0.6  # probability from which causes are named, or no gap is claimed: what is wrong costs half as much again as silence (decision theory; chosen)
LEAST_EVIDENCE = 6.0  # evidence that is called strong (Kass and Raftery 1995): with more, an effect that is not named is told as the nearest
VARIATIONS = (0.2, 0.8)  # of its size: how much a cause varies whose form is another, and what only comes near one (two plants: 0.1 to 0.3, mostly 0.3 to 2)
GROUP_PROBABILITY = 0.90  # of a confusion group
MOST_FORCES = 4  # generic forces that stand for something else (chosen)
GENERIC_SIZES = (0.01, 0.1, 1.0)  # prior sizes of a generic force that are tried, in the rms of the thrusters' own on that axis (chosen)


# -- decision: consistency, indications, what is left ---------------------------------------------------------------------------------

OPEN_GAP_RIGHT = 0.06  # mean open gap where the equations are right (164 healthy development logs, in seven groups of 0.00 to 0.15),
OPEN_GAP_ELSE = 0.54  # and median where something else is at work (97 opened logs of two plants; shape 0.99, fitted)
INCONSISTENT_SHARE = 0.1  # of what causes reduce most (opened sets: right ones 0.005 at most, a real run 0.05; a gyro that clips as inertia 0.22)


# -- result: attribution, next experiment, recalibration ----------------------------------------------------------------------------

STRONG_QUANTILE = 0.8  # chosen: of a velocity's size in the log, above which its regime is "strong"; an acceleration above it is a transient
LEAST_SPEED, LEAST_TURN_RATE = 0.05, 1.0  # m/s, deg/s; chosen: a vehicle that is slower nearly all the time has no regimes of that velocity
LEAST_DEPTH_SPAN = 1.0  # m; chosen: a log that spans less has no regimes of depth
LOW_ALTITUDES = (1.0, 2.0, 4.0)  # m; chosen: regimes near the bottom
WORKING_SHARE = 0.3  # chosen: of the 95 % quantile of a thruster's speed, above which it counts as turning
SLICE_LIFT = 1.3  # chosen: below it a slice holds hardly more of the gap than its time would, and of some hundred one does by chance
SLICES_AN_AXIS, SLICES = 3, 5  # chosen: slices told of one axis, and in all
PARAMETER_FORM_ERROR = 0.10  # of a parameter's departure, one standard error: equations are only nearly right (logs of two independent plants ask for it)
GROUP_NAMES = 3  # chosen: members told of a confusion group
BUSY_QUANTILE, BUSY_LEAST = 0.98, 0.2  # chosen: quantile of a thruster's speed that counts as the most it does, and its least share of the busiest one's peak
RECALIBRATION_LEAST = 3  # chosen: coefficients; one or two are what an effect of the library, or its nearest relative, leaves
