"""Whether a vehicle's numbers can be a vehicle: every problem that physics shows, found at once."""

from __future__ import annotations

import numpy as np

from rovval.core.channels import AXES
from rovval.vehicle.ardusub import FRAMES, factors
from rovval.vehicle.model import Mixer, PulseTable, Vehicle, allocation, as_matrix, inertia, rigid_body_mass

WEIGHT_MISMATCH = 0.25  # chosen: an ROV is trimmed to within a few per cent; a quarter is a wrong unit or a wrong volume
DIRECTION_TOLERANCE = 1e-3  # chosen: a direction is printed with three digits or more
LEVER_TOLERANCE = 1e-6  # N or N m of 1 N of thrust: less than that is rounding of a direction's digits


def audit(vehicle: Vehicle) -> tuple[str, ...]:
    """Problems that make the vehicle unusable, one sentence each with value and limit; empty for a sound one."""
    return (*_mass(vehicle), *_damping(vehicle), *_trim(vehicle), *_thrusters(vehicle), *_commands(vehicle), *_tolerances(vehicle))


def unsourced(vehicle: Vehicle) -> tuple[str, ...]:
    """Groups of numbers without an entry in ``sources``: the shipped vehicles have none."""
    groups = (
        "mass", "inertia", "added_mass", "linear_drag", "quadratic_drag", "volume", "centre_of_gravity",
        "centre_of_buoyancy", "size", "density", "gravity", "thruster.position", "thruster.direction", "thruster.k_pos", "thruster.k_neg",
    )
    limits = ("thruster.rpm_max",) if any(t.rpm_max is not None for t in vehicle.thruster) else ()
    extra = (*limits, *(("mixer",) if vehicle.mixer else ()), *(("pulse_table",) if vehicle.pulse_table else ()))
    return tuple(g for g in (*groups, *extra) if g not in vehicle.sources)


def uncontrolled_axes(vehicle: Vehicle) -> tuple[str, ...]:
    """Axes that no combination of thrusters can push alone (rank of the allocation, axis by axis)."""
    left = np.linalg.svd(allocation(vehicle), full_matrices=True)
    rank = int((1e-9 * left.S[0] < left.S).sum())
    reach = (left.U[:, :rank] ** 2).sum(axis=1)
    return tuple(axis for axis, part in zip(AXES, reach, strict=True) if part < 1 - 1e-6)


def _mass(vehicle: Vehicle) -> list[str]:
    body, problems = vehicle.body, []
    tensor = inertia(body)
    moments = np.linalg.eigvalsh(tensor)
    if moments[0] <= 0:
        problems.append(f"inertia tensor is not positive definite (smallest principal moment {moments[0]:.4g} kg m2, limit > 0)")
    elif moments[2] > (moments[0] + moments[1]) * (1 + 1e-9):
        problems.append(
            f"inertia tensor breaks the triangle rule: principal moments {np.round(moments, 4).tolist()} kg m2, "
            "the largest may not exceed the sum of the others"
        )
    added = as_matrix(body.added_mass)
    if not np.allclose(added, added.T, rtol=1e-6, atol=1e-9):
        problems.append("added_mass is not symmetric (potential flow: M_A = M_A^T, Fossen 2021, 6.3)")
    if (np.diag(added) < 0).any():
        problems.append(f"added_mass has a negative diagonal {np.diag(added).tolist()}: give M_A, positive, not X_udot")
    total = np.linalg.eigvalsh(0.5 * (added + added.T) + rigid_body_mass(body))
    if total[0] <= 0:
        problems.append(f"M_RB + M_A is not positive definite (smallest eigenvalue {total[0]:.4g}, limit > 0)")
    return problems


def _tolerances(vehicle: Vehicle) -> list[str]:
    """Correlations must be those of a covariance."""
    rows = vehicle.tolerance_correlation
    wrong = {key: (len(row), i) for i, (key, row) in enumerate(rows.items()) if len(row) != i}
    problems = [f"tolerance_correlation of {key}: {count} numbers, {before} expected, one for each key before it" for key, (count, before) in wrong.items()]
    if problems or not rows:
        return problems
    least = float(np.linalg.eigvalsh(vehicle.correlation)[0])
    return [] if least > 0 else [f"tolerance_correlation is not positive definite (smallest eigenvalue {least:.3g}, limit > 0): write it with `rovval fit`"]


def _damping(vehicle: Vehicle) -> list[str]:
    """Power taken from any motion must not be negative: nu^T D(nu) nu >= 0."""
    problems = []
    linear, quadratic = as_matrix(vehicle.body.linear_drag), as_matrix(vehicle.body.quadratic_drag)
    for name, matrix in (("linear_drag", linear), ("quadratic_drag", quadratic)):
        negative = [AXES[i] for i in range(6) if matrix[i, i] < 0]
        if negative:
            problems.append(f"{name} is negative on {', '.join(negative)}: give D, positive, not X_u")
    if problems:
        return problems
    nu = np.random.default_rng(0).normal(size=(2000, 6))
    power = np.einsum("bi,ij,bj->b", nu, linear, nu) + np.einsum("bi,ij,bj->b", nu, quadratic, np.abs(nu) * nu)
    if (power < -1e-9).any():
        worst = nu[power.argmin()]
        problems.append(f"damping feeds energy in: power {power.min():.3g} W taken at velocity {np.round(worst, 2).tolist()} (limit >= 0)")
    without = [AXES[i] for i in range(6) if linear[i, i] == 0 and quadratic[i, i] == 0]
    if without:
        problems.append(f"no damping at all on {', '.join(without)}")
    return problems


def _trim(vehicle: Vehicle) -> list[str]:
    ratio = vehicle.buoyancy / vehicle.weight
    problems = []
    if abs(ratio - 1) > WEIGHT_MISMATCH:
        problems.append(
            f"buoyancy {vehicle.buoyancy:.1f} N against weight {vehicle.weight:.1f} N: ratio {ratio:.3f}, limit 1 +- {WEIGHT_MISMATCH} (is volume in m3?)"
        )
    lever = vehicle.body.centre_of_gravity[2] - vehicle.body.centre_of_buoyancy[2]
    if lever < 0:
        problems.append(f"centre of gravity is {-lever:.3f} m above the centre of buoyancy: it would float upside down (z is down)")
    return problems


def _thrusters(vehicle: Vehicle) -> list[str]:
    problems = []
    names = vehicle.thrusters
    if repeated := sorted({n for n in names if names.count(n) > 1}):
        problems.append(f"thruster names repeat: {', '.join(repeated)}")
    for thruster in vehicle.thruster:
        length = float(np.linalg.norm(thruster.direction))
        if abs(length - 1) > DIRECTION_TOLERANCE:
            problems.append(f"thruster {thruster.name}: direction has length {length:.4f}, limit 1 +- {DIRECTION_TOLERANCE}")
    return problems


def _commands(vehicle: Vehicle) -> list[str]:
    problems = []
    if mixer := vehicle.mixer:
        for stick, row in mixer.factors.items():
            if stick not in AXES:
                problems.append(f"mixer: unknown stick {stick!r}, known: {', '.join(AXES)}")
            if len(row) != len(vehicle.thruster):
                problems.append(f"mixer: stick {stick!r} has {len(row)} factors for {len(vehicle.thruster)} thrusters")
        if not problems:
            problems = _driven_backwards(vehicle, mixer) + _unlike_its_frame(mixer)
    if (own := vehicle.uuv) and {len(own.k_pos), len(own.k_neg)} not in ({0}, {len(vehicle.thruster)}):
        problems.append(f"uuv: {len(own.k_pos)} k_pos and {len(own.k_neg)} k_neg for {len(vehicle.thruster)} thrusters")
    if table := vehicle.pulse_table:
        sizes = {len(table.pwm_us), len(table.thrust), len(table.pwm_us if table.rpm is None else table.rpm)}
        if len(sizes) != 1 or (np.diff(table.pwm_us) <= 0).any():
            problems.append("pulse_table: pwm_us, thrust and (if given) rpm must have one length and pwm_us must increase")
        else:
            problems += _strong_side(vehicle, table)
    return problems


def _driven_backwards(vehicle: Vehicle, mixer: Mixer) -> list[str]:
    """Sticks that drive a thruster against their own axis: factor times wrench of the thruster's positive thrust (`allocation`) below zero."""
    problems, wrench = [], allocation(vehicle)
    for stick, row in mixer.factors.items():
        for name, factor, push in zip(vehicle.thrusters, row, wrench[AXES.index(stick)], strict=True):
            if factor * push < -LEVER_TOLERANCE:
                unit = "N" if AXES.index(stick) < 3 else "N m"
                problems.append(
                    f"mixer: stick {stick!r} drives {name} against it: factor {factor:g}, but 1 N of its positive thrust gives {push:.3g} {unit} of {stick} "
                    "(one of factor, direction and position has the wrong sign)"
                )
    return problems


def _unlike_its_frame(mixer: Mixer) -> list[str]:
    """Factors that are not those of the autopilot's frame that the mixer names: with directions and factors both negated the vehicle steers
    as well, and the strong and the weak side of every thruster are swapped."""
    if mixer.frame is None:
        return []
    if mixer.frame not in FRAMES:
        return [f"mixer: unknown frame {mixer.frame!r}, known: {', '.join(FRAMES)}"]
    published, problems = factors(mixer.frame), []
    for stick in dict.fromkeys((*published, *mixer.factors)):
        want = published.get(stick)
        if (have := mixer.factors.get(stick)) != want:
            problems.append(f"mixer: stick {stick!r} has factors {_row(have)}, ArduSub's frame {mixer.frame} has {_row(want)}")
    return problems


def _row(row: tuple[float, ...] | None) -> str:
    return "none" if row is None else "[" + ", ".join(f"{value:g}" for value in row) + "]"


def _strong_side(vehicle: Vehicle, table: PulseTable) -> list[str]:
    """Thrusters whose gains are stronger the other way than the table of pulse widths that they are driven by."""
    ahead, astern = max(table.thrust), -min(table.thrust)
    wrong = [t.name for t in vehicle.thruster if (t.k_pos - t.k_neg) * (ahead - astern) < 0]
    if not wrong:
        return []
    said = f"the table pushes {ahead:.3g} N ahead and {astern:.3g} N astern"
    return [f"thruster {', '.join(wrong)}: k_pos and k_neg have their strong side where pulse_table has its weak one ({said})"]
