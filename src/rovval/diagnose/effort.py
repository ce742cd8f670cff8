"""How hard the diagnosis looks: rounds, steps, initial points, and how many models are fitted again; none of them says what is believed.

More of each costs time and may find a better fit; less may miss one. What decides between the models that were found stands in `criteria`. "Chosen" is a
judgement of the authors without a published source; "opened sets" are development logs with a known answer (`rovval blind`).
"""

# -- windows --------------------------------------------------------------------------------------------------------------------------

STIFFER = 2.0  # the decay of a motion that a hypothesis may make of the file's, and is still integrated stably: twice its drag, or half its mass (chosen)

# -- problem and inference: prior, noise model, disturbance, cross-validation, MAP fit, intervals -----------------------------------

NOISE_MODEL_ROUNDS = 5  # of disturbance, form error and fit in turn: sizes then change by a few per cent
INITIAL_DESIGN_EFFECT = 10.0  # of the first fit of the library, before anything is known of the residuals' autocorrelation (chosen)
DISTURBANCE_SEGMENTS = 12  # of a window, in each of which a force is constant: 0.8 s of 10 s, well below the period at which a small ROV rolls
DISTURBANCE_ROUNDS = 10  # of expectation and maximisation (chosen)
INITIAL_DISTURBANCE = 0.1  # of the thrusters' rms on an axis: rms of a disturbance, from which the estimate begins (chosen),
INITIAL_MEMORY_S = 1.0  # s: and its correlation time (chosen)
COMPONENT_ROUNDS = 2  # of noise and disturbances at their most likely, and of the fit of the library with them between, in turn (chosen)
COMPONENT_WINDOWS = 60  # windows, evenly spread, that these are found from: ten minutes (chosen)
COMPONENT_CYCLES, COMPONENT_WORTH = 20, 0.02  # cycles of expectation and maximisation at most, and the log likelihood that one more has to gain (chosen)
INITIAL_CORRELATION = 0.7  # of a disturbance, from one segment of a window to the next, that they begin with (chosen: any leads to the same)
LARGEST_CHANGE = 3.0  # of the logarithm of one of them, by one extrapolation (chosen: a factor of twenty)
MAP_STEPS, QUICK_STEPS = 5, 3  # damped steps of a MAP fit, and of one that only has to show whether it is worth more
DAMPINGS = (0.0, 0.003, 0.03, 0.3, 3.0)  # of a step (Marquardt 1963), tried in turn until one gains (chosen): along a valley it is damped across only,
STEP_SHARES = (0.3, 0.1)  # and shares of the undamped step, tried after these (chosen; Nocedal and Wright 2006, 3.1): where the valley bends, too
STEP_KEPT = 0.25  # of what it promises (Nocedal and Wright 2006, algorithm 4.1); the best of all where none does
STEP_WORTH = 1.0  # twice the log posterior: for a smaller gain no further step is taken
RELINEARISED_TIMES = 4  # a fit's sensitivities are made anew where a descent ends, at most (chosen)
PROGRESSIVE_S = (2.5, 5.0)  # s of each window that are fitted before the whole of it (chosen)
ONSET_SHIFTS_S = (-12.0, -6.0, -3.0, -1.5, 1.5, 3.0, 6.0, 12.0)  # s by which a fitted onset is moved in turn, kept where that is better (chosen)
BOOTSTRAP_RESAMPLES = 500  # of an interval's 5 % and 95 % quantiles (chosen; Efron and Tibshirani 1993 advise some 1000 for such)
MOST_REFITS = 5  # fits without a part of the logs: of more logs than that, a fifth is left out at a time

# -- hypotheses: which could be told by this log, and where their fits begin --------------------------------------------------------

MOST_STARTS = 12  # initial points of a hypothesis with several parameters that no slope shows (chosen: each is a column of the linearisation),
WHOLE_STARTS = 36  # and of one that begins with all of its size, at one simulation for each initial point (chosen)
ONSET_STARTS = 9  # initial points for an onset, evenly inside the log (chosen)
CHANGE_STARTS = 2  # change points of the gap that an onset begins from (chosen)
PERIOD_STARTS = 3  # periods of the residual that an effect begins from (chosen)
LEVER_SHARE = 0.7  # of the furthest thruster's distance from the origin: where a force may act ahead or astern (chosen)
DATUM_QUANTILES = (0.25, 0.5, 0.75)  # of a log's depth, where what changes with depth may have its datum (chosen)
SPEED_QUANTILES = (0.25, 0.5, 0.75)  # of the speeds at which a thruster turns in a log, where it may break away (chosen)
GAP_CHANGE_SPLITS = 2  # times that the gap is split: three change points at most (chosen)
WAVE_DOPPLER = 0.15  # relative shift of frequency within which they are: omega v / g is 0.14 at 0.9 m/s and a period of 4 s
SPRING_STARTS = 4  # springs that the fit of what holds the vehicle begins from (chosen)
SPRING_APART_S = 10.0  # s between their onsets, at least (chosen)
LINE_BEARINGS, LINE_RISES, LINE_LENGTHS = 8, (0.0, 0.6, 1.2), (0.5, 2.0)  # bearings, rises (rad) and lengths (of the track's reach) of lines tried (chosen)
LINE_STARTS, LINE_EVALUATIONS = 2, 600  # of these that the fit of a line begins from, and evaluations of its loss each time (chosen)
SPRING_EVIDENT_SHARE = 0.2  # of the gap, from which a spring is fitted in any case (opened sets: eight snags 0.22 to 0.82; of 82 others three)

# -- search and decision: prior masses, what is fitted, something else ---------------------------------------------------------------

NEGLIGIBLE = 0.01  # probability of a model beside the best one, below which it is not sought after (chosen)
SETS_WEIGHED = 3  # sets of causes, the most probable, beside which something else or further numbers of the file are weighed (chosen)
MOST_CAUSES = 8  # at once that are sought; a search ends before, where one more explains nothing more (chosen: a real vehicle's file was off in five),
MOST_BEGUN = 3  # and that are sought to begin at one time in mid-log (chosen)
MOST_CANDIDATES = 10  # hypotheses that are re-simulated in a step (chosen)
SCREENED_EVIDENCE = 0.15  # share of the best linearised evidence: with less, a hypothesis is not re-simulated (chosen),
LEAST_SCREENED = 4  # unless it is among so many of the first (chosen)
SCREENED_ANYWAY = 20.0  # and has so much evidence by itself (chosen)
SCREENED_WITHIN = 10.0  # twice the log posterior by which the library may be off in a linearisation that was made near by (chosen)
STARTS_TRIED = 3  # initial points from which a hypothesis with local minima is fitted (chosen)
COHERENT = 0.85  # coherence of sensitivities from which a hypothesis is re-simulated beside the best candidate whatever the screen said (chosen)
MOST_COHERENT = 4  # of those (chosen)
TANGENT_KEPT = 0.5  # share of the linearised evidence that a quick fit must keep, else it is made with care (chosen)
MOST_REFITTED = 2  # fits that are (chosen)
REFITTED_EVIDENCE = 0.25  # share of the best's evidence that their tangent must promise (chosen: what gains little is found again beside the best)
MOST_RELINEARISED = 4  # candidates that are fitted again with sensitivities made at their own point (chosen)
SERIOUS_EVIDENCE = 0.5  # share of the best evidence from which a candidate's gain counts (chosen)
MOST_RELATIVES = 4  # hypotheses of the library that are fitted in the place of each of several causes (chosen)
ONSETS_TRIED = 12  # first windows with it that are tried, evenly spread, before those about the best of them (chosen)
