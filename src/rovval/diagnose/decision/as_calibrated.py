"""The vehicle as it was calibrated: what its equations left of the logs that it was calibrated on, they leave of every other, and no cause is new in that.

What is left goes with the motion, so that causes of the library explain a part of it, surely and on every log. A cause that came since then makes the gap
larger than it was where the cause acts. How much larger it is, of squared errors above noise, is log-normal about 1 where nothing came, as wide as the
runs of the calibration differ among themselves; where something came it is 1 + x times that, and x log-logistic of median 1: as much as there was, or any.

A cause that came since then is larger, too, than it seemed to be in the runs of the calibration (`fit.calibration.apparent_sizes`): what a vehicle is off by
resembles one thruster that is a little weak on every log, and not one that is dead. Where nothing came the size is Student's t about none, with a degree of
freedom for each run and one for all parameters together; where something came it is larger than that, and its square as many times as the gap.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, log, pi, sqrt

import numpy as np
from scipy import stats
from scipy.special import log_ndtr

from rovval.diagnose.criteria import PRIOR_HEALTHY
from rovval.diagnose.inference.gap import TINY


def odds_as_calibrated(grown: Sequence[float], other: float, spread: float) -> float:
    """Odds of a vehicle that is as it was calibrated over another model of prior mass ``other``, by how much the gap has ``grown`` since then, where that model
    acts, or on each of several axes: it may act on any one of them. ``spread`` is that of a vehicle that is as it was (`gap.spread_as_calibrated`). None
    without a calibration."""
    return PRIOR_HEALTHY / other * len(grown) / sum(1.0 / max(_as_it_was(size, spread), TINY) for size in grown) if grown else 0.0


def sizes_as_they_were(sizes: Sequence[float], freedom: float) -> float:
    """Ratio of the densities of a vehicle that is as it was calibrated and of one to which something came, by how large (in standard deviations of the apparent
    size, of so much ``freedom``) the parameters of causes are: it may have come in any one of them. 1 where nothing is known of them."""
    return len(sizes) / sum(1.0 / max(_size_as_it_was(size, freedom), TINY) for size in sizes) if sizes else 1.0


def _size_as_it_was(size: float, freedom: float) -> float:
    """The same ratio (1) of one ``size``: Student's t, over a mixture of such that are wider by a factor 1 / w, the logarithm of whose square is exponential of
    mean 1."""
    w = np.geomspace(1e-4, 1.0, 500)
    return float(stats.t.pdf(size, freedom) / np.trapezoid(2.0 * w**2 * stats.t.pdf(size * w, freedom), w))


def _as_it_was(grown: float, spread: float) -> float:
    """Ratio of both densities of a gap that is ``grown`` times what it was (1): log-normal, over that times 1 + x. The logarithm of 1 + x is exponential of
    mean 1, so that the other is an exponentially modified Gaussian (Grushka 1972)."""
    size = log(max(grown, TINY))
    as_it_was = -0.5 * (size / spread) ** 2 - log(spread * sqrt(2.0 * pi))
    return exp(as_it_was - (0.5 * spread**2 - size + float(log_ndtr(size / spread - spread))))
