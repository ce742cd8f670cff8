"""What no ROV does: recorded shaft speeds beyond the vehicle file's own limit, and simulated motion beyond sane limits."""

from __future__ import annotations

import numpy as np

from rovval.core.channels import AXES, channel
from rovval.core.data import Array, Run
from rovval.core.errors import Finding
from rovval.core.units import DEGREES
from rovval.vehicle.model import Vehicle, allocation, as_matrix

SANE_SPEED = channel("u").high  # m/s; the channel table's own: a log is masked beyond it
MOST_THRUST = 5.0  # times the vehicle's weight: chosen; an observation-class ROV's thrusters together push with one to three times its weight
TOGETHER = 0.5  # correlation of thrust and velocity below which something else moves the vehicle (a current, a tether)
LEAST_RATIO = 25.0  # drag over thrust: beyond any drag that a file may have wrong, below the 39 of rad/s taken for rev/s
LEAST_ROWS = 100  # 10 s at 10 Hz
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


def thrust_against_motion(run: Run, vehicle: Vehicle) -> tuple[Finding, ...]:
    """A finding where the thrust of the recorded shaft speeds is beyond any vehicle's, or far from what the recorded motion takes.

    The drag at the measured velocity is the force that a steady motion takes (Fossen 2021, 6.4). Where thrust and velocity go together and
    the drag is many times the thrust, the speeds are too small by the root of the ratio, since thrust is their square.
    """
    names = tuple(f"n:{t}" for t in vehicle.thrusters)
    if not all(run.measured(name) for name in names):
        return ()
    rpm = run.stack(names) * 60.0
    gain = np.where(rpm >= 0.0, [t.k_pos for t in vehicle.thruster], [t.k_neg for t in vehicle.thruster])
    thrust = gain * rpm * np.abs(rpm)
    if (strongest := float(np.nanmax(np.nansum(np.abs(thrust), axis=1)))) > MOST_THRUST * vehicle.weight:
        weights = f"{strongest / vehicle.weight:.3g} times the weight of {vehicle.name}"
        detail = f"by the recorded speeds they push with {strongest:.3g} N, {weights}: is their unit right?"
        return (Finding("unit", "n:" + ", n:".join(vehicle.thrusters), detail),)
    force = thrust @ allocation(vehicle).T
    linear, quadratic = (np.diag(as_matrix(d)) for d in (vehicle.body.linear_drag, vehicle.body.quadratic_drag))
    best = max((_driven(force[:, j], run.get(n), linear[j], quadratic[j]) for j, n in enumerate("uvw")), default=(0.0, 1.0))
    correlation, ratio = best
    if correlation < TOGETHER or ratio < LEAST_RATIO:
        return ()
    times, words = min(((60.0, "rev/s taken for rpm"), (30.0 / np.pi, "rad/s taken for rpm")), key=lambda c: abs(np.log(c[0] ** 2 / ratio)))
    detail = (
        f"the drag at the recorded velocity is {ratio:.3g} times the thrust of the recorded speeds, which goes with it (correlation {correlation:.2f}): "
        f"the speeds look too small by about {np.sqrt(ratio):.2g}; {words} is {times:.3g}"
    )
    return (Finding("unit", "n:" + ", n:".join(vehicle.thrusters), detail),)


def _driven(force: Array, velocity: Array, linear: float, quadratic: float) -> tuple[float, float]:
    """Correlation of thrust and velocity on an axis, and the largest drag over the largest thrust (95th percentiles)."""
    known = np.isfinite(force) & np.isfinite(velocity)
    if known.sum() < LEAST_ROWS or not np.std(force[known]) or not np.std(velocity[known]):
        return 0.0, 1.0
    drag = (linear + quadratic * np.abs(velocity[known])) * velocity[known]
    most = float(np.quantile(np.abs(force[known]), 0.95))
    return float(np.corrcoef(force[known], velocity[known])[0, 1]), float(np.quantile(np.abs(drag), 0.95)) / most if most else 1.0


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
