"""What to fly next: the manoeuvre, by simulation, that best separates the members of a confusion group.

Each manoeuvre of a small bank is flown by the simulator with the effect that was named; the other members are fitted to that flight. The
manoeuvre on which the best of them fits worst is the one to fly. The bank follows the thesis's movement protocol (4.4) and adds
coast-downs, turns through every heading, single thrusters, weak steps and a chirp.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rovval.core.channels import AXES, VELOCITIES
from rovval.core.data import Array, ClockReport, Reason, Run
from rovval.diagnose.criteria import PRIOR_WIDTH
from rovval.diagnose.inference.cross_validation import Ring, fit, folds_of
from rovval.diagnose.inference.prior import Prior
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.residuals.normal_equations import products
from rovval.diagnose.residuals.sensitivities import linearise, state_spread
from rovval.diagnose.windows.shooting import cut
from rovval.vehicle.model import allocation

DT = 0.1
WINDOW_S = 10.0


@dataclass(frozen=True, slots=True)
class Leg:
    """Seconds, and the speed of each thruster in rev/s."""

    seconds: float
    speed: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Manoeuvre:
    """A schedule that a pilot or a script can fly."""

    name: str
    text: str
    legs: tuple[Leg, ...]


@dataclass(frozen=True, slots=True)
class Advice:
    """The best manoeuvre and how well it separates: weighted squared misfit of the best rival, in units of a window's noise."""

    manoeuvre: Manoeuvre
    separates: tuple[str, ...]
    misfit: float


def best_manoeuvre(problem: Problem, beta: Array, members: tuple[str, ...], most_speed: Array) -> Advice | None:
    """The manoeuvre that separates ``members`` (hypothesis names, the named one first) best, or None where none does."""
    best: Advice | None = None
    for manoeuvre in bank(problem, most_speed):
        misfit = _misfit(problem, beta, members, manoeuvre)
        if misfit is not None and (best is None or misfit > best.misfit):
            best = Advice(manoeuvre, members, misfit)
    return best


def bank(problem: Problem, most_speed: Array) -> tuple[Manoeuvre, ...]:
    """The manoeuvres, with thruster speeds scaled to the largest (k,) that the log used."""
    k = len(most_speed)
    rest = tuple([0.0] * k)

    def push(axis: str, share: float, other: str = "", other_share: float = 0.0) -> tuple[float, ...]:
        wrench = np.zeros(6)
        wrench[AXES.index(axis)] = share
        if other:
            wrench[AXES.index(other)] = other_share
        return _speeds(problem, wrench, most_speed, max(abs(share), abs(other_share)))

    def legs(*parts: tuple[float, tuple[float, ...]]) -> tuple[Leg, ...]:
        return tuple(Leg(seconds, speed) for seconds, speed in parts)

    found = [
        Manoeuvre(
            f"{axis} steps at three strengths with coast-downs",
            f"push in {axis} at 40, 70 and 100 % for 20 s each, thrusters off for 10 s after each",
            legs(*((s, v) for share in (0.4, 0.7, 1.0) for s, v in ((20.0, push(axis, share)), (10.0, rest)))),
        )
        for axis in ("surge", "sway", "heave", "yaw")
    ]
    found += [
        Manoeuvre(
            f"{axis} forth and back",
            f"push in {axis} at 80 % for 20 s each way with 10 s off between, twice",
            legs(*((s, v) for share in (0.8, -0.8) * 2 for s, v in ((20.0, push(axis, share)), (10.0, rest)))),
        )
        for axis in ("surge", "sway", "heave")
    ]
    found += [
        Manoeuvre("full circle at speed", "surge at 80 % while turning at 40 %, 100 s, through every heading", legs((100.0, push("surge", 0.8, "yaw", 0.4)))),
        Manoeuvre("oblique runs", "surge and sway together at 80 %, 25 s in each of the four diagonals",
                  legs(*((25.0, push("surge", a, "sway", b)) for a, b in ((0.8, 0.8), (0.8, -0.8), (-0.8, 0.8), (-0.8, -0.8))))),
        Manoeuvre("weak steps", "push in surge, sway and heave at 10 and 20 % for 12 s each way",
                  legs(*((12.0, push(axis, share)) for axis in ("surge", "sway", "heave") for share in (0.1, -0.1, 0.2, -0.2)))),
        Manoeuvre("quick reversals", "surge forth and back at 80 % with periods of 2, 4 and 8 s, 24 s each",
                  legs(*((half, push("surge", sign * 0.8)) for half in (1.0, 2.0, 4.0) for _ in range(int(12 / half)) for sign in (1, -1)))),
        Manoeuvre("thrusters one by one", "each thruster alone at 80 % forward 8 s, off 4 s, backward 8 s, off 4 s",
                  legs(*((s, _alone(k, j, v * most_speed[j])) for j in range(k) for s, v in ((8.0, 0.8), (4.0, 0.0), (8.0, -0.8), (4.0, 0.0))))),
        Manoeuvre("drift", "all thrusters off for 80 s", legs((80.0, rest))),
    ]  # fmt: skip
    return tuple(found)


def _alone(k: int, j: int, speed: float) -> tuple[float, ...]:
    return tuple(float(speed) if i == j else 0.0 for i in range(k))


def _speeds(problem: Problem, wrench: Array, most_speed: Array, share: float) -> tuple[float, ...]:
    """Thruster speeds whose thrust points along ``wrench``, the busiest thruster at ``share`` of its largest thrust in the log."""
    vehicle = problem.plant.vehicle
    scale = np.array([1.0, 1.0, 1.0, *np.maximum(np.ptp([t.position for t in vehicle.thruster], axis=0), 0.1)])
    thrust = np.linalg.pinv(allocation(vehicle)) @ (wrench * scale)
    gain = np.where(thrust >= 0, [t.k_pos for t in vehicle.thruster], [t.k_neg for t in vehicle.thruster]) * 3600.0
    speed = np.sign(thrust) * np.sqrt(np.abs(thrust) / gain)
    limit = np.max(np.abs(speed) / np.maximum(most_speed, 1e-9))
    return tuple((speed * np.sqrt(share) / limit).tolist()) if limit > 0 else tuple([0.0] * len(speed))


def _misfit(problem: Problem, beta: Array, members: tuple[str, ...], manoeuvre: Manoeuvre) -> float | None:
    """Misfit of the best rival on a flight made with the named effect; None where the flight cannot be simulated."""
    run = _flown(problem, beta, manoeuvre)
    if run is None:
        return None
    plant = problem.plant
    stretches = cut(run, plant.vehicle, plant.model, WINDOW_S)
    base = plant.null.copy()
    free = {name: plant.hypotheses[name] for name in members}
    columns = tuple(sorted({s for slots in free.values() for s in slots}))
    keep = [problem.parts[0].channels.index(c) for c in stretches.channels if c in problem.parts[0].channels]
    if len(keep) != len(stretches.channels) or stretches.steps + 1 > len(problem.variance):
        return None
    variance = problem.variance[: stretches.steps + 1][:, keep]
    data = products(linearise(stretches, base, columns), stretches.ok, variance, state_spread(stretches))
    ring = Ring.of(data, folds_of(np.zeros(len(data.c), dtype=int)))
    left = [
        fit(ring, Prior({s: PRIOR_WIDTH * plant.slots[s].parameter.typical for s in slots}), problem.inflation).loss
        for name, slots in free.items()
    ]
    return (min(left[1:]) - left[0]) / (problem.inflation * len(data.c))


def _flown(problem: Problem, beta: Array, manoeuvre: Manoeuvre) -> Run | None:
    """A run of the manoeuvre as the simulator with the fitted effects would log it, from rest at 10 m depth, without noise."""
    from rovval.plant import Inputs

    vehicle = problem.plant.vehicle
    speed = np.concatenate([np.tile(leg.speed, (round(leg.seconds / DT), 1)) for leg in manoeuvre.legs])
    n = len(speed)
    t = np.arange(n, dtype=np.float64) * DT
    side = {
        name: np.full(n, float(np.nanmedian(problem.parts[0].run.get(name))))
        for name in ("altitude", "wall_distance", "voltage", "tether_length")
        if problem.parts[0].run.measured(name)
    }
    inputs = Inputs(dt=DT, speed=speed, hold=False, t=t, altitude=side.get("altitude"), wall_distance=side.get("wall_distance"),
                    voltage=side.get("voltage"), tether_length=side.get("tether_length"))  # fmt: skip
    eta0 = np.array([[0.0, 0.0, 10.0, 0.0, 0.0, 0.0]])
    motion = problem.plant.simulate(inputs, np.array([0]), n - 1, np.zeros((1, 6)), eta0, beta[None])
    if motion.stopped[0] >= 0:
        return None
    values = dict(zip(VELOCITIES, motion.nu[0].T, strict=True)) | dict(zip(("x", "y", "z", "phi", "theta", "psi"), motion.eta[0].T, strict=True))
    values |= {f"n:{name}": speed[:, i] for i, name in enumerate(vehicle.thrusters)} | side
    logged = {c for part in problem.parts for c in (*VELOCITIES, "x", "y", "z", "phi", "theta", "psi") if part.run.measured(c)}
    values = {name: v for name, v in values.items() if name in logged or ":" in name or name in side}
    reasons = {name: np.full(n, Reason.OK, dtype=np.uint8) for name in values}
    clock = ClockReport("simulated", n, n, DT, None, None)
    return Run("manoeuvre", "simulated", "", "", vehicle.name, None, DT, values, reasons, {}, clock)
