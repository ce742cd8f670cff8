"""Where the vehicle is held or aground: the simulator knows neither surface, hand nor floor."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Flags, Run
from rovval.simulation.actuation import Actuation

STILL_S, STILL_M = 3.0, 0.03  # chosen: at rest for 3 s within the noise of a depth sensor
DEPTH_COVERED, AT_END = 0.3, 0.08  # m, chosen: contact is looked for only in logs that dive, near their ends of depth


def in_contact(run: Run, driven: Actuation) -> Flags:
    """Where the vehicle is at the surface, held or aground (n,): thrusters idle at the shallow end of the depth that the log covers, or
    idle and still at the deep end.

    The simulator knows neither surface, hand nor floor. Nothing is found in a log without depth or that hardly changes depth.
    """
    still = np.zeros(len(run), dtype=bool)
    depth = run.get("z")
    if not run.measured("z") or np.nanmax(depth) - np.nanmin(depth) < DEPTH_COVERED:
        return still
    span = round(STILL_S / run.dt)
    idle: Flags = np.asarray((np.abs(driven.inputs.speed) < 1e-9).all(axis=1))
    deep: Flags = np.asarray(depth > np.nanmax(depth) - AT_END)
    for at in range(0, len(run) - span, span // 5):
        if idle[at : at + span].all() and deep[at : at + span].all() and np.ptp(depth[at : at + span]) < STILL_M:
            still[at : at + span] = True
    return still | (idle & (depth < np.nanmin(depth) + AT_END))
