"""Where the vehicle is held or aground: the simulator knows neither surface, hand nor floor."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Flags, Run
from rovval.diagnose.criteria import AT_REST_M, AT_REST_S, CONTACT_DEPTH_MARGIN, CONTACT_DEPTH_RANGE
from rovval.simulation.actuation import Actuation


def in_contact(run: Run, driven: Actuation) -> Flags:
    """Where the vehicle is at the surface, held or aground (n,): thrusters idle at the shallow end of the depth that the log covers, or
    idle and still at the deep end.

    The simulator knows neither surface, hand nor floor. Nothing is found in a log without depth or that hardly changes depth.
    """
    still = np.zeros(len(run), dtype=bool)
    depth = run.get("z")
    if not run.measured("z") or np.nanmax(depth) - np.nanmin(depth) < CONTACT_DEPTH_RANGE:
        return still
    span = round(AT_REST_S / run.dt)
    idle: Flags = np.asarray((np.abs(driven.inputs.speed) < 1e-9).all(axis=1))
    deep: Flags = np.asarray(depth > np.nanmax(depth) - CONTACT_DEPTH_MARGIN)
    for at in range(0, len(run) - span, span // 5):
        if idle[at : at + span].all() and deep[at : at + span].all() and np.ptp(depth[at : at + span]) < AT_REST_M:
            still[at : at + span] = True
    return still | (idle & (depth < np.nanmin(depth) + CONTACT_DEPTH_MARGIN))
