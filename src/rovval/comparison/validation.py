"""The verdict of ASME V&V 20-2009 on each axis: is the comparison error larger than all that is unsure in the comparison itself?

The comparison error is E = S - D, simulated minus measured; what is unsure in it is u_val = sqrt(u_num^2 + u_input^2 + u_D^2), and the error of the model
lies in E +- k u_val (sections 1-5 and 6). E is here the rms over the rows of the windows, each of which is a validation point, and

- u_D is the white noise of the channel;
- u_num is what the integration differs by from an independent one;
- u_input is what the noise of the measured state that a window starts from makes, at most as much as the channel's own.

What is left out is named in `LEFT_OUT`: nobody has stated it. The true u_val is therefore larger, and an error that is "seen" here is one of the model or
of what is left out.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt

import numpy as np

from rovval.comparison.between import RESOLUTION
from rovval.core.channels import AXES, VELOCITIES
from rovval.core.data import Comparison

COVERAGE_FACTOR = 2.0  # k: 95 % of normal errors (V&V 20-2009, 6.3)
LEFT_OUT = (
    "u_input of the vehicle's numbers and of the recorded thruster speeds",
    "u_D of what a sensor has wrong throughout: bias, scale, mounting, late stamps",
)
SEEN, DOUBTFUL, HIDDEN = "seen", "doubtful", "hidden"


@dataclass(frozen=True, slots=True)
class Validation:
    """Of one axis, in its unit: the comparison ``error`` E (rms) and the standard uncertainties of data, integration and inputs, as far as known."""

    unit: str
    error: float
    u_data: float
    u_numerical: float
    u_input: float

    @property
    def u_validation(self) -> float:
        """All of them together: u_val."""
        return sqrt(self.u_data**2 + self.u_numerical**2 + self.u_input**2)

    @property
    def interval(self) -> tuple[float, float]:
        """Where the error of the model lies: E +- k u_val, not below 0."""
        spread = COVERAGE_FACTOR * self.u_validation
        return max(0.0, self.error - spread), self.error + spread

    @property
    def verdict(self) -> str:
        """``seen``: E is above k u_val. ``hidden``: E is no larger than u_val. ``doubtful``: between."""
        if self.error > COVERAGE_FACTOR * self.u_validation:
            return SEEN
        return HIDDEN if self.error <= self.u_validation else DOUBTFUL


def validation(comparison: Comparison) -> Mapping[str, Validation]:
    """By axis of the windows; an axis whose noise cannot be told from its log has no verdict."""
    run, sim, found = comparison.run, comparison.sim, {}
    for j, axis in enumerate(AXES):
        row = comparison.windowed.get(axis)
        if row is None or row.noise <= 0.0:
            continue
        kind = VELOCITIES[:3] if j < 3 else VELOCITIES[3:]
        motion = np.concatenate([run.get(n)[run.ok(n)] for n in kind] + [sim.windowed.nu[sim.windowed.ok][:, VELOCITIES.index(n)] for n in kind])
        fastest = float(np.abs(motion).max())
        found[axis] = Validation(row.unit, row.rmse, u_data=row.noise, u_numerical=RESOLUTION * fastest, u_input=row.noise)
    return found
