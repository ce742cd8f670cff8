"""What to fly next: the manoeuvre that discriminates best, by simulation, between the members of a confusion group.

An optimal discriminating experiment (Atkinson and Fedorov 1975, Biometrika 62, 57-70; T-optimality): each manoeuvre is flown by the
simulator with the effect that was named, the other members of the group are fitted to that flight, and the manoeuvre on which the best
of them fits worst is the one to fly.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rovval.core.channels import VELOCITIES
from rovval.core.data import Array, ClockReport, Reason, Run
from rovval.diagnose.criteria import BUSY_LEAST, BUSY_QUANTILE
from rovval.diagnose.decision.verdict import Decision
from rovval.diagnose.problem.cross_validation import by_fold, cross_validate, make_folds
from rovval.diagnose.problem.prior import wide_sd
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.normal_equations import normal_equations
from rovval.diagnose.residuals.nuisances import initial_state_sd
from rovval.diagnose.residuals.ridge import Prior
from rovval.diagnose.residuals.sensitivities import linearise
from rovval.diagnose.result.causes import alone, members
from rovval.diagnose.result.diagnosis import NextExperiment, ScheduleLeg, ThrusterSchedule
from rovval.diagnose.result.manoeuvres import Helm, Manoeuvre, bank
from rovval.diagnose.windows.multiple_shooting import cut_run
from rovval.effects import Parameter
from rovval.plant import Inputs

DT = 0.1  # s, the common grid


@dataclass(frozen=True, slots=True)
class Experiment:
    """A manoeuvre and how well it discriminates.

    Attributes:
        manoeuvre: what to fly.
        separates: names of the confusion group, the cause first.
        misfit: weighted squared misfit of the best other member, in units of a window's noise.
    """

    manoeuvre: Manoeuvre
    separates: tuple[str, ...]
    misfit: float

    def summary(self) -> NextExperiment:
        """What to fly and why, for the diagnosis."""
        text = f"{self.manoeuvre.name}: {self.manoeuvre.text}"
        return NextExperiment(manoeuvre=text, separates=self.separates, misfit=self.misfit)

    def schedule(self, thrusters: tuple[str, ...]) -> ThrusterSchedule:
        """How to fly it: thruster speeds in rpm, leg after leg."""
        t, legs = 0.0, list[ScheduleLeg]()
        for leg in self.manoeuvre.legs:
            rpm = {name: round(60.0 * s, 1) for name, s in zip(thrusters, leg.speed, strict=True)}
            legs.append(ScheduleLeg(t_s=t, duration_s=leg.seconds, thrusters=rpm))
            t += leg.seconds
        return ThrusterSchedule(name=self.manoeuvre.name, text=self.manoeuvre.text, unit="rpm", schedule=tuple(legs))


def next_experiment(problem: Problem, decision: Decision) -> Experiment | None:
    """The experiment that would decide between the first cause and what this log does not tell from it; None where every cause is isolated alone, or
    no manoeuvre can be simulated."""
    for one in decision.causes if decision.fit else ():
        assert decision.fit is not None
        group = members(decision, one)
        if len(group) > 1:
            speed = np.concatenate([np.abs(p.actuation.inputs.speed) for p in problem.runs])
            most = np.maximum(np.quantile(speed, BUSY_QUANTILE, axis=0), BUSY_LEAST * speed.max())
            return best(problem, alone(problem, decision.fit, one), group, most)
    return None


def best(problem: Problem, beta: Array, group: tuple[str, ...], most_speed: Array) -> Experiment | None:
    """The experiment that separates a ``group`` (names, the cause first) best, or None where none can be simulated.

    ``beta`` (k,) are the parameters of the plant with the cause as it was fitted, ``most_speed`` (thrusters,) in rev/s.
    """
    found: Experiment | None = None
    for manoeuvre in bank(Helm(problem.plant.vehicle, most_speed)):
        misfit = _misfit(problem, beta, group, manoeuvre)
        if misfit is not None and (found is None or misfit > found.misfit):
            found = Experiment(manoeuvre, group, misfit)
    return found


def _misfit(problem: Problem, beta: Array, members: tuple[str, ...], manoeuvre: Manoeuvre) -> float | None:
    """Misfit of the best other member on a flight made with the cause; None where the flight cannot be simulated."""
    run = _flown(problem, beta, manoeuvre)
    if run is None:
        return None
    plant = problem.plant
    stretches = cut_run(run, plant.vehicle, plant.model, DT * (problem.runs[0].steps + 1))
    free = {name: tuple(s for s in plant.hypotheses[name] if _can_act(plant.slots[s].parameter, run)) for name in members}
    base = np.where([slot.hypothesis in free and slot.parameter.places for slot in plant.slots], problem.prior_mean, plant.null)
    columns = tuple(sorted({s for slots in free.values() for s in slots}))
    keep = [problem.runs[0].channels.index(c) for c in stretches.channels if c in problem.runs[0].channels]
    if len(keep) != len(stretches.channels) or stretches.steps + 1 > len(problem.gap.variance):
        return None
    variance = problem.gap.variance[: stretches.steps + 1][:, keep]
    data = normal_equations(linearise(stretches, base, columns), stretches.ok, variance, initial_state_sd(stretches))
    ring = by_fold(data, make_folds(np.zeros(len(data.c), dtype=int)))
    left = [
        cross_validate(ring, Prior(wide_sd(plant, slots)), problem.design_effect).loss
        for name, slots in free.items()
    ]
    return (min(left[1:]) - left[0]) / (problem.design_effect * len(data.c))


def _can_act(parameter: Parameter, run: Run) -> bool:
    """Whether the run holds what a parameter acts by; that of another parameter of the effect may be missing."""
    return not parameter.needs or run.measured(parameter.needs)


def _flown(problem: Problem, beta: Array, manoeuvre: Manoeuvre) -> Run | None:
    """A run of the manoeuvre as the simulator with the fitted effects would log it, from rest at 10 m depth, without noise."""
    vehicle = problem.plant.vehicle
    speed = np.concatenate([np.tile(leg.speed, (round(leg.seconds / DT), 1)) for leg in manoeuvre.legs])
    n = len(speed)
    t = np.arange(n, dtype=np.float64) * DT
    side = {
        name: np.full(n, float(np.nanmedian(problem.runs[0].run.get(name))))
        for name in ("altitude", "wall_distance", "voltage", "tether_length")
        if problem.runs[0].run.measured(name)
    }
    inputs = Inputs(dt=DT, speed=speed, hold=False, t=t, altitude=side.get("altitude"), wall_distance=side.get("wall_distance"),
                    voltage=side.get("voltage"), tether_length=side.get("tether_length"))  # fmt: skip
    eta0 = np.array([[0.0, 0.0, 10.0, 0.0, 0.0, 0.0]])
    turned = np.zeros(n)
    for _ in range(2):  # how far it turns is known once it was flown
        motion = problem.plant.simulate(replace(inputs, turned=turned), np.array([0]), n - 1, np.zeros((1, 6)), eta0, beta[None])
        turned = np.unwrap(motion.eta[0, :, 5])
    if motion.stopped[0] >= 0:
        return None
    values = dict(zip(VELOCITIES, motion.nu[0].T, strict=True)) | dict(zip(("x", "y", "z", "phi", "theta", "psi"), motion.eta[0].T, strict=True))
    values |= {f"n:{name}": speed[:, i] for i, name in enumerate(vehicle.thrusters)} | side
    logged = {c for part in problem.runs for c in (*VELOCITIES, "x", "y", "z", "phi", "theta", "psi") if part.run.measured(c)}
    values = {name: v for name, v in values.items() if name in logged or ":" in name or name in side}
    reasons = {name: np.full(n, Reason.OK, dtype=np.uint8) for name in values}
    clock = ClockReport("simulated", n, n, DT, None, None)
    return Run("manoeuvre", "simulated", "", "", vehicle.name, None, DT, values, reasons, {}, clock)
