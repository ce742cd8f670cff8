"""Surface and bottom, which end no simulation by themselves: that a simulated vehicle is beyond them is said."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array, Run
from rovval.vehicle.model import Vehicle


def beyond_the_water(run: Run, vehicle: Vehicle, eta: Array) -> tuple[str, ...]:
    """What a reader has to know of a simulated pose ``eta`` (n, 6) whose hull left the water or went through the logged bottom; () where it did not.

    Told only where the log has the depth, and the altitude for the bottom: without them nobody knows where the surface and the bottom are.
    """
    if not run.measured("z") or not np.isfinite(eta[:, 2]).any():
        return ()
    said, half = [], 0.5 * vehicle.body.size[2]
    if (highest := float(np.nanmin(eta[:, 2]))) < -half:
        said.append(f"the simulated vehicle rises to {-highest:.3g} m above the surface, which ends nothing here: --effect free_surface:share=1 has one")
    below = eta[:, 2] + half - (run.get("z") + run.get("altitude"))
    if np.isfinite(below).any() and (deepest := float(np.nanmax(below))) > 2.0 * half:
        said.append(f"the simulated vehicle is {deepest:.3g} m below the bottom that was logged: --effect seabed:firmness=1,depth=... has one")
    return tuple(said)
