"""What no ROV does: recorded shaft speeds beyond the vehicle file's own limit, and simulated motion beyond sane limits."""

from __future__ import annotations

import numpy as np

from rovval.core.channels import AXES, channel
from rovval.core.data import Array, Run
from rovval.core.errors import Finding
from rovval.core.units import DEGREES
from rovval.vehicle.model import Vehicle

SANE_SPEED = channel("u").high  # m/s; the channel table's own: a log is masked beyond it
SANE_RATE = 2 * np.pi  # rad/s, a turn a second; chosen above the fastest of the published logs in use, 4.8 rad/s (a BlueROV2 in a tank)


def overspeed(run: Run, vehicle: Vehicle) -> tuple[Finding, ...]:
    """A finding for each thruster whose recorded speed or set-point exceeds the ``rpm_max`` of its vehicle's file, if that has one."""
    found = []
    for thruster in vehicle.thruster:
        for name in (f"n:{thruster.name}", f"n_cmd:{thruster.name}"):
            rpm = np.abs(run.get(name)[run.ok(name)]) * 60.0
            if thruster.rpm_max is None or not (beyond := rpm > thruster.rpm_max).any():
                continue
            detail = (
                f"{beyond.sum()} of {len(rpm)} values beyond the {thruster.rpm_max:g} rpm of vehicle {vehicle.name}, worst {rpm.max():.4g} rpm; "
                "used as recorded: check unit and scale, or the file's rpm_max"
            )
            found.append(Finding("overspeed", name, detail))
    return tuple(found)


def first_beyond(nu: Array) -> tuple[int, str] | None:
    """First sample of a simulated motion (T, 6) beyond `SANE_SPEED` or `SANE_RATE`, and which axis by how much; None where all are sane."""
    over = np.abs(nu) / np.repeat([SANE_SPEED, SANE_RATE], 3)
    beyond = np.flatnonzero((over > 1.0).any(axis=1))
    if not len(beyond):
        return None
    k = int(beyond[0])
    j = int(np.argmax(over[k]))
    value = nu[k, j]
    said = f"{value:.3g} m/s, limit {SANE_SPEED:g} m/s" if j < 3 else f"{value * DEGREES:.3g} deg/s, limit {SANE_RATE * DEGREES:.3g} deg/s"
    return k, f"{AXES[j]} at {said}"
