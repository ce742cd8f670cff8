"""The vehicle as it was calibrated: what its equations left of the logs that it was calibrated on, they leave of every other, and no cause is new in that.

What is left goes with the motion, so that causes of the library explain a part of it, surely and on every log. A cause that came since then makes the gap
larger than it was where the cause acts. How much larger it is, of squared errors above noise, is log-normal about 1 where nothing came (`CALIBRATED_SPREAD`),
and else log-logistic of median 1 beyond it: as much as there was, or any.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, log, pi, sqrt

from rovval.diagnose.criteria import CALIBRATED_SPREAD, PRIOR_CAUSES, PRIOR_HEALTHY, PRIOR_SOMETHING_ELSE
from rovval.diagnose.inference.gap import TINY


def odds_over_causes(grown: float | None) -> float:
    """Odds that what looks like causes was left by the calibration, by how much the gap has ``grown`` since then where they act; none without a calibration."""
    return PRIOR_HEALTHY / PRIOR_CAUSES * _as_it_was(grown)


def odds_over_something_else(grown: Sequence[float]) -> float:
    """The same of something else, by how much each of several axes has ``grown``: it may be at work on any one of them."""
    if not grown:
        return 0.0
    return PRIOR_HEALTHY / PRIOR_SOMETHING_ELSE / (sum(1.0 / max(_as_it_was(size), TINY) for size in grown) / len(grown))


def _as_it_was(grown: float | None) -> float:
    """Ratio of both densities of a gap that is ``grown`` times what it was (1); of one that became smaller as of one that is as it was."""
    if grown is None:
        return 0.0
    size = max(grown, 1.0)
    as_it_was = exp(-0.5 * (log(size) / CALIBRATED_SPREAD) ** 2) / (CALIBRATED_SPREAD * sqrt(2.0 * pi) * size)
    return as_it_was * size**2
