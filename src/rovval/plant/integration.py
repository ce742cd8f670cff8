"""Lanes in blocks of W side by side, as the kernel reads them, and their true motion in time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rovval.core.frames import quaternion_from_euler
from rovval.effects.lanes import Lanes
from rovval.plant import geometry
from rovval.plant.codegen import cache
from rovval.plant.codegen.spec import Spec, W
from rovval.plant.inputs import Inputs, Prepared
from rovval.plant.lowering import Lowered, mass_numbers, nothing_left, pack, steps_before_nothing, with_payload
from rovval.plant.platforms import Engine
from rovval.vehicle.model import Vehicle, as_matrix

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
GAP, NOTHING = 4, 5  # reasons for which a lane stops (`rovval.plant.model.REASONS`); the kernel gives the first for either


@dataclass(frozen=True, slots=True)
class Starts:
    """Where each lane begins: sample of the log (B,), true ``nu`` and ``eta`` there (B, 6), which extra wrench acts (B,) (-1: none) and its factor;
    ``numbers`` (B,): which of the parameter vectors that were lowered it has."""

    sample: Indices
    nu: Array
    eta: Array
    which: Indices
    gain: Array
    numbers: Indices

    def take(self, part: Indices) -> Starts:
        """Some of the lanes."""
        return Starts(self.sample[part], self.nu[part], self.eta[part], self.which[part], self.gain[part], self.numbers[part])


@dataclass(frozen=True, slots=True)
class Payload:
    """What a change of payload makes of each parameter vector (P): its mass numbers from the ``onset`` (P,) s on, ``late`` (P, 31), infinite where there is
    none, and when nothing is left to move, ``gone`` (P,) s (`nothing_left`)."""

    late: Array
    onset: Array
    gone: Array


@dataclass(frozen=True, slots=True)
class Packed:
    """What the kernel of a ``spec`` reads of the parameter vectors that were lowered: ``numbers`` (P, rows), which effect ``acts`` (P, E), and a ``payload``
    that changes."""

    spec: Spec
    numbers: Array
    acts: NDArray[np.bool_]
    payload: Payload | None


class Integrator:
    """The kernels of one vehicle: a nominal one, and one with every effect for the lanes that need it."""

    def __init__(self, vehicle: Vehicle, substeps: int, engine: Engine | None) -> None:
        """``substeps``: Runge-Kutta steps per sample of the log; an ``engine`` has a step of its own."""
        body = vehicle.body
        self.thrusters, self.substeps, self.engine = len(vehicle.thruster), substeps, engine
        self._dense = any(_coupled(m) for m in (body.added_mass, body.linear_drag, body.quadratic_drag))
        self._advance = any(t.diameter > 0 and any((*t.advance_pos, *t.advance_neg)) for t in vehicle.thruster)
        self._geometry = _geometry(vehicle)

    def steps(self, dt: float) -> int:
        """Steps of the integration in a sample of ``dt`` s."""
        return self.substeps if self.engine is None else max(1, round(dt / self.engine.step))

    def motion(
        self, inputs: Inputs, prepared: Prepared, lowered: Lowered, packed: Mapping[bool, Packed], starts: Starts, steps: int
    ) -> tuple[Array, Indices, Indices]:
        """True motion (B, steps + 1, 12): u v w p q r, x y z phi theta psi; first invalid sample (B,) (-1: none) and its reason (B,).

        ``packed``: the numbers of ``lowered`` for each kernel that some lane needs, as `packed` has them.
        """
        full = self._full(lowered, starts)
        if full.all() or not full.any():
            return self.one_kernel(packed[bool(full.any())], prepared, starts, inputs.dt, inputs.hold, steps)
        out = np.empty((len(full), steps + 1, 12))
        stopped, codes = np.empty(len(full), dtype=np.int64), np.empty(len(full), dtype=np.int64)
        for kind in (False, True):
            part = np.flatnonzero(full == kind)
            out[part], stopped[part], codes[part] = self.one_kernel(packed[kind], prepared, starts.take(part), inputs.dt, inputs.hold, steps)
        return out, stopped, codes

    def _full(self, lowered: Lowered, starts: Starts) -> NDArray[np.bool_]:
        """Lanes (B,) that need the kernel with every effect in it."""
        return np.asarray(lowered.full[starts.numbers] | (starts.which >= 0))

    def _spec(self, full: bool) -> Spec:
        return Spec(self.thrusters, self._dense, self._advance, full, self.engine.share if self.engine else 0.0)

    def packed(self, lowered: Lowered, dt: float, starts: Starts) -> dict[bool, Packed]:
        """Every parameter vector that was lowered, for the kernels with every effect (True) and with none, as far as lanes need them."""
        return {full: self._packed(lowered, dt, full) for full in np.unique(self._full(lowered, starts)).tolist()}

    def _packed(self, lowered: Lowered, dt: float, full: bool) -> Packed:
        spec = self._spec(full)
        return Packed(spec, pack(lowered, spec, dt, self.steps(dt)), lowered.acts, _payload(lowered.lanes, spec) if full else None)

    def one_kernel(self, packed: Packed, prepared: Prepared, starts: Starts, dt: float, hold: bool, steps: int) -> tuple[Array, Indices, Indices]:
        """As `motion`, all lanes by one kernel."""
        which, payload = starts.numbers, packed.payload
        size, blocks = len(starts.sample), -(-len(starts.sample) // W)
        states = blocked(np.concatenate([starts.eta[:, :3], quaternion_from_euler(starts.eta[:, 3:]), starts.nu], axis=1))
        out = np.empty((blocks * W, steps + 1, 12))
        stopped, reason = np.full((blocks, W), -1), np.zeros((blocks, W), dtype=np.int64)
        gap = prepared.steps_before_gap(starts.sample, hold)
        late, onset = (np.zeros((blocks, 1)), np.full(size, np.inf)) if payload is None else (blocked(payload.late[which]), payload.onset[which])
        nothing = gap if payload is None else steps_before_nothing(payload.gone[which], prepared.t[starts.sample], dt)
        cache.run(
            packed.spec, blocks, steps * self.steps(dt),
            (
                blocked(packed.numbers[which]), _some(packed.acts[which]), late, _flat(onset, np.inf), states, _flat(starts.sample),
                _flat(np.minimum(gap, nothing)), _flat(starts.which, -1), _flat(starts.gain), prepared.speed, prepared.log, prepared.t, prepared.extra,
                *self._geometry, dt, hold, steps, self.steps(dt), out, stopped, reason,
            ),
        )  # fmt: skip
        codes = np.where((reason.reshape(-1)[:size] == GAP) & (nothing < gap), NOTHING, reason.reshape(-1)[:size])
        return out[:size], stopped.reshape(-1)[:size], codes


def blocked(values: Array) -> Array:
    """(B, R) -> (blocks, R * W): W lanes side by side, the last block filled with copies of the last lane."""
    size, rows = values.shape
    blocks = -(-size // W)
    padded = values if size == blocks * W else np.concatenate([values, np.repeat(values[-1:], blocks * W - size, axis=0)])
    return np.ascontiguousarray(padded.reshape(blocks, W, rows).transpose(0, 2, 1)).reshape(blocks, rows * W)


def _flat(values: NDArray[np.generic], fill: float | None = None) -> NDArray[np.generic]:
    """(B,) -> (blocks, W), filled with the last lane's value or ``fill``."""
    blocks = -(-len(values) // W)
    rest = np.full(blocks * W - len(values), values[-1] if fill is None else fill, dtype=values.dtype)
    return np.concatenate([values, rest]).reshape(blocks, W)


def _some(acts: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(B, E) -> (blocks, E): what some lane of the block has."""
    size, count = acts.shape
    padded = np.concatenate([acts, np.zeros((-size % W, count), dtype=bool)])
    return np.asarray(padded.reshape(-1, W, count).any(axis=1))


def _payload(lanes: Lanes, spec: Spec) -> Payload | None:
    """What a change of payload makes of parameter vectors; None where none has one."""
    if not lanes.payload_mass.any():
        return None
    onset = np.where(lanes.payload_mass != 0, lanes.payload_onset, np.inf)
    return Payload(mass_numbers(with_payload(lanes), spec), onset, nothing_left(lanes))


def _coupled(values: tuple[float, ...] | tuple[tuple[float, ...], ...]) -> bool:
    matrix = as_matrix(values)
    return bool((matrix != np.diag(np.diag(matrix))).any())


def _geometry(vehicle: Vehicle) -> tuple[Array, Indices, Array]:
    """What the kernel needs of the thrusters once per vehicle: 16 numbers each (place, advance-ratio rows, wrench of 1 N of side
    force, diameter), pairs and weights of the jets."""
    jets, side = geometry.jets(vehicle), geometry.hull_side(vehicle)
    rows = []
    for i, t in enumerate(vehicle.thruster):
        advance = (*t.advance_pos, *t.advance_neg) if t.diameter > 0 else (0.0,) * 6
        rows.append([*t.position, *advance, *side[i], t.diameter or 1.0])
    return np.array(rows).reshape(-1), jets.pairs.copy(), jets.weights.copy()  # the kernel is compiled for arrays that may be written
