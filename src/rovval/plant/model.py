"""Plant: checks what it is given, lowers the effects, runs the compiled kernel, and hands back the log it would have left."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from rovval.core.errors import UsageProblem
from rovval.core.frames import quaternion_from_euler
from rovval.effects.lanes import Lanes, nominal
from rovval.effects.log import Log
from rovval.plant import geometry, sensors, slots
from rovval.plant import sensor_delay as late
from rovval.plant.arguments import checked
from rovval.plant.codegen import cache as kernel
from rovval.plant.codegen import spec as compose
from rovval.plant.codegen.layout import RATE_LIMIT, SPEED_LIMIT
from rovval.plant.inputs import Inputs, Prepared, prepare
from rovval.plant.lowering import Lowered, lower, mass_numbers, pack, steps_before_nothing, with_payload
from rovval.vehicle.model import Vehicle, square

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
MODELS = ("fossen", "freefloating")
REASONS = (
    "", f"speed above {SPEED_LIMIT:g} m/s", f"rate above {RATE_LIMIT:g} rad/s", "state not finite", "thruster speed missing in the log",
    "the payload that was set down leaves no inertia")  # fmt: skip

GAP, NOTHING = 4, 5  # of these; the kernel gives the first for either


@dataclass(frozen=True, slots=True)
class Motion:
    """``nu`` (B, T + 1, 6) m/s and rad/s, ``eta`` (B, T + 1, 6) m and rad, as the log's sensors would write them. A lane that left
    sane limits keeps its last valid state from sample ``stopped`` (B,) on (-1: it did not), and ``why`` names lane, time and reason."""

    nu: Array
    eta: Array
    stopped: Indices
    why: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class _Lanes:
    """Where each lane begins, its true first state, and its extra wrench."""

    start: Indices
    nu: Array
    eta: Array
    which: Indices
    gain: Array

    def take(self, part: Indices) -> _Lanes:
        """Some of the lanes."""
        return _Lanes(self.start[part], self.nu[part], self.eta[part], self.which[part], self.gain[part])


class Plant:
    """A vehicle as one of the two platforms has it, and the library's parameters for it (see the package's example)."""

    def __init__(self, vehicle: Vehicle, model: str = "fossen", substeps: int = 1) -> None:
        """``substeps``: Runge-Kutta steps per sample of the log."""
        if model not in MODELS or substeps < 1:
            raise UsageProblem(f"model {model!r} with {substeps} substeps", f"model is one of {', '.join(MODELS)}, substeps at least 1")
        self.vehicle, self.model, self.substeps = vehicle, model, substeps
        self.slots: tuple[slots.Slot, ...] = slots.slots(vehicle, model)
        self.null: Array = np.array([s.parameter.null for s in self.slots])
        self.null.setflags(write=False)
        self.index: Mapping[str, int] = MappingProxyType({s.key: i for i, s in enumerate(self.slots)})
        groups: dict[str, tuple[int, ...]] = {}
        for i, slot in enumerate(self.slots):
            groups[slot.hypothesis] = (*groups.get(slot.hypothesis, ()), i)
        self.hypotheses: Mapping[str, tuple[int, ...]] = MappingProxyType(groups)
        self._dense = any(_coupled(m) for m in (vehicle.body.added_mass, vehicle.body.linear_drag, vehicle.body.quadratic_drag))
        self._advance = any(t.diameter > 0 and any((*t.advance_pos, *t.advance_neg)) for t in vehicle.thruster)
        self._geometry = _geometry(vehicle)
        self.nominal = nominal(vehicle, model)

    def thrust(self, speed: Array) -> Array:
        """Nominal thrust (S, k) N of thruster speeds (S, k) rev/s, at rest in the water."""
        n = 60.0 * np.asarray(speed, dtype=float)
        ahead = np.array([t.k_pos for t in self.vehicle.thruster])
        astern = np.array([t.k_neg for t in self.vehicle.thruster])
        return np.asarray(np.where(n > 0, ahead, astern) * n * np.abs(n))

    def simulate(
        self, inputs: Inputs, start: Indices, steps: int, nu0: Array, eta0: Array, beta: Array,
        extra: Indices | None = None, extra_gain: Array | None = None,
    ) -> Motion:
        """Run ``B`` lanes of ``steps`` samples from the measured first states ``nu0`` and ``eta0`` (B, 6) at samples ``start`` (B,).

        ``beta`` (B, K) are the effects' parameters in the order of ``slots`` (``null``: nothing), ``extra`` (B,) an index into
        ``inputs.extra`` or -1, ``extra_gain`` (B,) its factor. Raises UsageProblem for parameters out of bounds or an effect
        whose channel the inputs do not hold, BadInput for shapes that do not fit.
        """
        thrusters = len(self.vehicle.thruster)
        start, nu0, eta0, beta, which, gain = checked(self.slots, self.null, thrusters, inputs, start, steps, nu0, eta0, beta, extra, extra_gain)
        prepared = prepare(inputs, self.vehicle)
        lowered = lower(self.nominal, self.slots, self.index, self.null, beta)
        lanes = _Lanes(start, *sensors.unobserve(self.vehicle, self.index, self.null, beta, nu0, eta0), which, gain)
        delays = sensors.delays(self.index, self.null, beta)
        lanes, before, after = self._late(inputs, prepared, lowered, lanes, delays) if delays else (lanes, np.empty((len(start), 0, 12)), 0)
        out, stopped, codes = self._run(inputs, prepared, lowered, lanes, steps + after)
        out, first = np.concatenate([before, out], axis=1) if delays else out, before.shape[1]
        seen = sensors.overwritten(
            self.vehicle, self.index, self.null, beta,
            Log(out[..., :6], out[..., 6:], inputs.dt, nu0, eta0, first),
        )  # fmt: skip
        stopped = np.where(stopped > steps, -1, stopped)
        why = tuple(f"lane {b} stopped at {stopped[b] * inputs.dt:.1f} s: {REASONS[codes[b]]}" for b in np.flatnonzero(stopped >= 0))
        window = slice(first, first + steps + 1)
        return Motion(seen.nu[:, window], seen.eta[:, window], stopped, why)

    def _late(
        self, inputs: Inputs, prepared: Prepared, lowered: Lowered, lanes: _Lanes, delays: Sequence[late.Delay]
    ) -> tuple[_Lanes, Array, int]:
        """The lanes at their true first states behind sensors that are late, the samples before those (B, m, 12), and how many samples beyond the
        windows sensors that are early show."""

        def simulate(some: Indices, start: Indices, state: Array, steps: int) -> tuple[Array, Indices]:
            there = replace(lanes.take(some), start=start, nu=state[:, :6], eta=state[:, 6:])
            out, stopped, _ = self._run(inputs, prepared, lowered.take(some), there, steps)
            return out, stopped

        clock = late.Clock(simulate, inputs.dt, len(inputs.speed))
        state, before, after = late.true_start(clock, lanes.start, np.concatenate([lanes.nu, lanes.eta], axis=1), delays)
        return replace(lanes, nu=state[:, :6], eta=state[:, 6:]), before, after

    def _run(self, inputs: Inputs, prepared: Prepared, lowered: Lowered, lanes: _Lanes, steps: int) -> tuple[Array, Indices, Indices]:
        """True motion (B, steps + 1, 12): u v w p q r, x y z phi theta psi; first invalid sample and its reason per lane."""
        full = lowered.full | (lanes.which >= 0)
        if full.all() or not full.any():
            return self._run_one(inputs, prepared, lowered, lanes, steps, bool(full.any()))
        out = np.empty((len(full), steps + 1, 12))
        stopped, codes = np.empty(len(full), dtype=np.int64), np.empty(len(full), dtype=np.int64)
        for kind in (False, True):
            part = np.flatnonzero(full == kind)
            out[part], stopped[part], codes[part] = self._run_one(inputs, prepared, lowered.take(part), lanes.take(part), steps, kind)
        return out, stopped, codes

    def _run_one(
        self, inputs: Inputs, prepared: Prepared, lowered: Lowered, lanes: _Lanes, steps: int, full: bool
    ) -> tuple[Array, Indices, Indices]:
        """As `_run`, in one kernel."""
        spec = compose.Spec(len(self.vehicle.thruster), self._dense, self._advance, full)
        size, blocks = len(lanes.start), -(-len(lanes.start) // compose.W)
        numbers = _blocked(pack(lowered, spec, inputs.dt, self.substeps))
        late, onset = self._payload(lowered.lanes, blocks)
        states = _blocked(np.concatenate([lanes.eta[:, :3], quaternion_from_euler(lanes.eta[:, 3:]), lanes.nu], axis=1))
        out = np.empty((blocks * compose.W, steps + 1, 12))
        stopped, reason = np.full((blocks, compose.W), -1), np.zeros((blocks, compose.W), dtype=np.int64)
        gap = prepared.steps_before_gap(lanes.start, inputs.hold)
        nothing = steps_before_nothing(lowered.lanes, prepared.t[lanes.start], inputs.dt)
        limit = np.minimum(gap, nothing)
        kernel.run(
            spec, blocks,
            (
                numbers, _some(lowered.acts), late, onset, states, _flat(lanes.start), _flat(limit), _flat(lanes.which, -1), _flat(lanes.gain), prepared.speed,
                prepared.log, prepared.t, prepared.extra, *self._geometry, inputs.dt, inputs.hold, steps, self.substeps, out, stopped, reason,
            ),
        )  # fmt: skip
        codes = np.where((reason.reshape(-1)[:size] == GAP) & (nothing < gap), NOTHING, reason.reshape(-1)[:size])
        return out[:size], stopped.reshape(-1)[:size], codes

    def _payload(self, lanes: Lanes, blocks: int) -> tuple[Array, Array]:
        """Mass numbers after a payload's onset, and the onsets (s; infinite where there is none)."""
        onset = np.full(blocks * compose.W, np.inf)
        if not lanes.payload_mass.any():
            return np.zeros((blocks, 1)), onset.reshape(blocks, compose.W)
        onset[: len(lanes)] = np.where(lanes.payload_mass != 0, lanes.payload_onset, np.inf)
        return _blocked(mass_numbers(with_payload(lanes))), onset.reshape(blocks, compose.W)


def parse_settings(plant: Plant, settings: Sequence[str]) -> Array:
    """(K,) parameters of settings like ``inflow_loss:loss=0.3`` and ``thruster_degraded[HFP]:loss=0.4,...``.

    Raises UsageProblem: names every unknown effect, parameter and value out of bounds at once.
    """
    return slots.parse(plant.slots, plant.index, plant.null, settings)


def _coupled(values: tuple[float, ...] | tuple[tuple[float, ...], ...]) -> bool:
    matrix = square(values)
    return bool((matrix != np.diag(np.diag(matrix))).any())


def _geometry(vehicle: Vehicle) -> tuple[Array, Indices, Array]:
    """What the kernel needs of the thrusters once per vehicle: 16 numbers each (place, advance-ratio rows, wrench of 1 N of side
    force, diameter), pairs and weights of the jets."""
    jets, side = geometry.jets(vehicle), geometry.hull_side(vehicle)
    rows = []
    for i, t in enumerate(vehicle.thruster):
        advance = (*t.advance_pos, *t.advance_neg) if t.diameter > 0 else (0.0,) * 6
        rows.append([*t.position, *advance, *side[i], t.diameter or 1.0])
    return np.array(rows).reshape(-1), jets.pairs, jets.weights


def _blocked(values: Array) -> Array:
    """(B, R) -> (blocks, R * W): W lanes side by side, the last block filled with copies of the last lane."""
    size, rows = values.shape
    blocks = -(-size // compose.W)
    padded = values if size == blocks * compose.W else np.concatenate([values, np.repeat(values[-1:], blocks * compose.W - size, axis=0)])
    return np.ascontiguousarray(padded.reshape(blocks, compose.W, rows).transpose(0, 2, 1)).reshape(blocks, rows * compose.W)


def _flat(values: NDArray[np.generic], fill: float | None = None) -> NDArray[np.generic]:
    """(B,) -> (blocks, W), filled with the last lane's value or ``fill``."""
    blocks = -(-len(values) // compose.W)
    rest = np.full(blocks * compose.W - len(values), values[-1] if fill is None else fill, dtype=values.dtype)
    return np.concatenate([values, rest]).reshape(blocks, compose.W)


def _some(acts: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(B, E) -> (blocks, E): what some lane of the block has."""
    size, count = acts.shape
    padded = np.concatenate([acts, np.zeros((-size % compose.W, count), dtype=bool)])
    return np.asarray(padded.reshape(-1, compose.W, count).any(axis=1))
