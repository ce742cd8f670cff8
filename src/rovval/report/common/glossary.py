"""Words of the pages that a reader need not know, each in one sentence; docs/glossary.md has all terms, and where they come from."""

from __future__ import annotations

TERMS = {
    "gap": "the simulated minus the measured motion, in short windows that each start from the measured state",
    "window": "a stretch of the log, 10 s as a rule, that is simulated from its measured first state",
    "rms": "root mean square: the size of an error that goes up and down",
    "sensor noise": "the error that the noise of the sensors alone makes; no simulator comes nearer",
    "held-out": "of data that the values under judgement were not fitted to",
    "interval": "the true value lies in it with a probability of 90 %, if the equations are right",
    "probability": "of one answer among all that were compared: a healthy vehicle, effects of the library, a file that is off, something else",
    "tolerance": "how far off a healthy simulator's coefficient may be, as one standard deviation; --calibration-slop sets it",
    "regime": "a part of the log with something in common: a range of speed, of turn rate, of depth, of a thruster's activity",
    "effect": "something that the simulator leaves out or has wrong",
    "evidence": "how much more likely the log is with an effect than without it: twice the natural logarithm of the ratio",
    "confusion group": "effects that this log cannot tell from one another",
    "IAE": "integral over time of the absolute error",
    "skill": "1 - MSE / MSE of predicting no motion: 1 is perfect, 0 no better than predicting none, below 0 worse",
    "free run": "one simulation from the log's first state to its end, in which errors add up",
}
