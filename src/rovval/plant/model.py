"""A vehicle as one of the platforms has it, with every effect of the library in it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from rovval.core.errors import UsageProblem
from rovval.effects.lanes import nominal
from rovval.effects.log import Log
from rovval.plant import platforms, sensors, slots
from rovval.plant.arguments import checked
from rovval.plant.codegen.layout import RATE_LIMIT, SPEED_LIMIT
from rovval.plant.inputs import Inputs, prepare
from rovval.plant.integration import Integrator, Starts
from rovval.plant.lowering import lower, rows_at_rest
from rovval.plant.sensor_delay import Clock, Delay, true_start
from rovval.vehicle.model import Vehicle

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Course = Callable[[Starts, int], tuple[Array, Indices, Indices]]  # of lanes and steps, their motion as `Integrator.motion` has it
REASONS = (
    "", f"speed above {SPEED_LIMIT:g} m/s", f"rate above {RATE_LIMIT:g} rad/s", "state not finite", "thruster speed missing in the log",
    "the payload that was set down leaves no inertia")  # fmt: skip


@dataclass(frozen=True, slots=True)
class Motion:
    """``nu`` (B, T + 1, 6) m/s and rad/s in body axes, ``eta`` (B, T + 1, 6) m north east down and rad, as the log's sensors would write them. A lane
    that left sane limits keeps its last valid state from sample ``stopped`` (B,) on (-1: it did not), and ``why`` names lane, time and reason."""

    nu: Array
    eta: Array
    stopped: Indices
    why: tuple[str, ...]


class Plant:
    """A vehicle as one of the platforms has it, and the library's parameters for it (see the package's example).

    ``slots``: what each of the K numbers of a lane's parameter vector is; ``null`` (K,): their values at which no effect changes anything; ``index``:
    where each key stands; ``hypotheses``: the slots of each effect, by axis, thruster or sensor where it has one; ``integrator`` runs it;
    ``simulated``: the vehicle with the numbers that the platform takes, ``nominal``: these as a lane.
    """

    def __init__(self, vehicle: Vehicle, model: str = "fossen", substeps: int = 1) -> None:
        """``substeps``: Runge-Kutta steps per sample of the log; a platform with an engine has a step of its own. Raises UsageProblem for a model that
        is no platform, a vehicle that the platform cannot simulate, or no step at all."""
        if substeps < 1:
            raise UsageProblem(f"model {model!r} with {substeps} substeps", "at least 1")
        platform = platforms.load(model)
        self.simulated = platform.vehicle(vehicle)
        self.vehicle, self.model, self.substeps = vehicle, model, substeps
        self.slots: tuple[slots.Slot, ...] = slots.slots(vehicle, model)
        self.null: Array = np.array([s.parameter.null for s in self.slots])
        self.null.setflags(write=False)
        self.index: Mapping[str, int] = MappingProxyType({s.key: i for i, s in enumerate(self.slots)})
        groups: dict[str, tuple[int, ...]] = {}
        for i, slot in enumerate(self.slots):
            groups[slot.hypothesis] = (*groups.get(slot.hypothesis, ()), i)
        self.hypotheses: Mapping[str, tuple[int, ...]] = MappingProxyType(groups)
        late = platform.engine.time_constant(vehicle) if platform.engine else 0.0
        self.nominal = replace(nominal(self.simulated), vehicle=vehicle, lag=np.array([late]))
        self._resting = rows_at_rest(self.nominal, self.index, self.null)
        self.integrator = Integrator(self.simulated, substeps, platform.engine)

    def steps(self, dt: float) -> int:
        """Steps of the integration in a sample of ``dt`` s."""
        return self.integrator.steps(dt)

    def thrust(self, speed: Array) -> Array:
        """Nominal thrust (S, k) N of thruster speeds (S, k) rev/s, at rest in the water."""
        n = 60.0 * np.asarray(speed, dtype=float)
        ahead = np.array([t.k_pos for t in self.simulated.thruster])
        astern = np.array([t.k_neg for t in self.simulated.thruster])
        return np.asarray(np.where(n > 0, ahead, astern) * n * np.abs(n))

    def simulate(
        self, inputs: Inputs, start: Indices, steps: int, nu0: Array, eta0: Array, beta: Array,
        extra: Indices | None = None, extra_gain: Array | None = None,
    ) -> Motion:
        """Run ``B`` lanes of ``steps`` samples from the measured first states ``nu0`` and ``eta0`` (B, 6) at samples ``start`` (B,).

        ``beta`` (B, K) are the effects' parameters in the order of ``slots`` (``null``: nothing), ``extra`` (B,) an index into
        ``inputs.extra`` or -1, ``extra_gain`` (B,) its factor.

        Raises:
            BadInput: shapes that do not fit, samples that the log does not hold, states that are not finite.
            UsageProblem: parameters out of bounds, or an effect whose channel the inputs do not hold.
        """
        thrusters = len(self.vehicle.thruster)
        start, nu0, eta0, beta, which, gain, first, numbers = checked(
            self.slots, self.null, thrusters, inputs, start, steps, nu0, eta0, beta, extra, extra_gain
        )
        prepared = prepare(inputs, self.vehicle)
        lowered = lower(self.nominal, self.slots, self.index, self.null, beta[first], self._resting)
        starts = Starts(start, *sensors.unobserve(self.vehicle, self.index, self.null, beta, nu0, eta0), which, gain, numbers)
        motion = partial(self.integrator.motion, inputs, prepared, lowered, self.integrator.packed(lowered, inputs.dt, starts))
        delays = sensors.delays(self.index, self.null, beta)
        starts, before, after = self._behind(delays, inputs, motion, starts) if delays else (starts, np.empty((len(start), 0, 12)), 0)
        out, stopped, codes = motion(starts, steps + after)
        out, led = np.concatenate([before, out], axis=1) if delays else out, before.shape[1]
        seen = sensors.overwritten(
            self.vehicle, self.index, self.null, beta,
            Log(out[..., :6], out[..., 6:], inputs.dt, nu0, eta0, led),
        )  # fmt: skip
        stopped = np.where(stopped > steps, -1, stopped)
        why = tuple(f"lane {b} stopped at {stopped[b] * inputs.dt:.1f} s: {REASONS[codes[b]]}" for b in np.flatnonzero(stopped >= 0))
        window = slice(led, led + steps + 1)
        return Motion(seen.nu[:, window], seen.eta[:, window], stopped, why)

    def _behind(self, delays: Sequence[Delay], inputs: Inputs, motion: Course, starts: Starts) -> tuple[Starts, Array, int]:
        """The lanes at their true first states behind sensors that are late, the samples before those (B, m, 12), and how many samples beyond the
        windows sensors that are early show."""

        def simulate(some: Indices, start: Indices, state: Array, steps: int) -> tuple[Array, Indices]:
            there = replace(starts.take(some), sample=start, nu=state[:, :6], eta=state[:, 6:])
            out, stopped, _ = motion(there, steps)
            return out, stopped

        clock = Clock(simulate, inputs.dt, len(inputs.speed))
        state, before, after = true_start(clock, starts.sample, np.concatenate([starts.nu, starts.eta], axis=1), delays)
        return replace(starts, nu=state[:, :6], eta=state[:, 6:]), before, after


def parse_settings(plant: Plant, settings: Sequence[str]) -> Array:
    """(K,) parameters of settings like ``inflow_loss:loss=0.3`` and ``thruster_degraded[HFP]:loss=0.4,...``.

    Raises:
        UsageProblem: names every unknown effect, parameter and value out of bounds at once.
    """
    return slots.parse(plant.slots, plant.index, plant.null, settings)
