"""The wrench that does what an effect does: how it changes the acceleration of a simulated motion, at every sample, times the vehicle's mass."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.residuals.sensitivities import LANES
from rovval.diagnose.windows.windows import Windows
from rovval.vehicle.model import as_matrix, rigid_body_mass


def equivalent_wrench(windows: Windows, beta: Array, without: Array) -> Array:
    """Series (run, 6) on the run's grid, N and N m: what acts at the parameters ``beta`` (k,) and not at ``without`` (k,); zero outside the windows.

    From every sample of the motion that is simulated at ``beta`` both are simulated for one sample.
    """
    m, dt, vehicle = windows.count, windows.run.dt, windows.plant.vehicle
    motion = windows.plant.simulate(windows.actuation.inputs, windows.start, windows.steps, windows.nu0, windows.eta0, np.tile(beta, (m, 1)))
    nu, eta = (state[:, :-1].reshape(-1, 6) for state in (motion.nu, motion.eta))
    samples = windows.samples()[:, :-1].reshape(-1)
    mass = rigid_body_mass(vehicle.body) + as_matrix(vehicle.body.added_mass)
    found = np.zeros((len(windows.run), 6))
    for begin in range(0, len(samples), LANES):
        here = slice(begin, begin + LANES)
        at = samples[here]
        one, other = (
            windows.plant.simulate(windows.actuation.inputs, at, 1, nu[here], eta[here], np.tile(point, (len(at), 1))).nu[:, 1]
            for point in (beta, without)
        )
        found[at] = (one - other) / dt @ mass.T
    return found
