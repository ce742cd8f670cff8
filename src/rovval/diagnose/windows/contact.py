"""Contact: samples at which the vehicle touches what no simulator of it models: the surface, a hand or crane, the bottom."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Flags, Run
from rovval.diagnose.criteria import AT_REST_M, AT_REST_S, CONTACT_DEPTH_MARGIN, CONTACT_DEPTH_RANGE
from rovval.simulation.actuation import Actuation


def in_contact(run: Run, driven: Actuation) -> Flags:
    """Samples (n,) of a run at which the vehicle is in contact: thrusters idle at the shallow end of the log's depth range, or idle and the
    vehicle at rest at its deep end.

    ``driven`` holds the thruster speeds. No sample of a log without depth, or whose depth varies by less than `CONTACT_DEPTH_RANGE`, is in contact.
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
