"""How large a planted effect really was: the wrench it made in this flight, against the wrench of the thrusters.

For every effect a twin of the plant without it is asked, at the states that the flight went through, for its acceleration;
the difference times the mass matrix is the equivalent extra wrench, whatever the effect's place. Sensor effects are sized by
what they did to the channels.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rovval.blind.plant.dynamics import BASE, Plant
from rovval.blind.plant.rotation import to_body
from rovval.blind.plant.spec import AXES, Array

ROWS_A_LOOK = 10  # rows between two looks: one a second


def _acceleration(plant: Plant, t: float, y: Array) -> Array:
    """d/dt of the velocity over ground, but for the parts that depend on attitude and water alone (they cancel)."""
    return np.asarray(plant.inverse @ plant.rhs(t, y)[7:13])


def _without(plant: Plant, gone: int) -> Plant:
    """The same vehicle without effect number ``gone``."""
    rest = [e for i, e in enumerate(plant.effects) if i != gone]
    return Plant(plant.healthy, rest, plant.scale, plant.motor, plant.bottom)


def _carry(plant: Plant, twin: Plant, gone: int, t: float, y: Array) -> Array:
    """The state of the twin at the same motion over ground."""
    kept = [y[s] for i, s in enumerate(plant.slices) if i != gone]
    out = np.concatenate([y[: BASE + 2 * plant.many], *kept])
    k = plant.see(t, y)
    water = twin.water(t, k.x, k.y, k.z)
    shift = to_body(k.r, water[0], water[1], water[2])
    rel = np.array(k.vel) - np.array([*shift, 0.0, 0.0, 0.0])
    out[7:13] = twin.mass @ rel
    return out


class Recorder:
    """Collects, during the flight, the equivalent wrench of each effect and the thrusters' wrench."""

    def __init__(self, plant: Plant) -> None:
        self.plant = plant
        act = [i for i, e in enumerate(plant.effects) if not e.overrides("record")]
        self.twins = {i: _without(plant, i) for i in act}
        self.rows: dict[int, list[Array]] = {i: [] for i in act}
        self.drive: list[Array] = []

    def look(self, t: float, y: Array) -> None:
        """One sample, at a state of the flight (before its control step is integrated)."""
        plant = self.plant
        self.drive.append(plant.reach @ plant.see(t, y).thrust)
        for i, twin in self.twins.items():
            twin.refresh(t)
            twin.set_point, twin.background, twin.volts = plant.set_point, plant.background, plant.volts
            there = _acceleration(twin, t, _carry(plant, twin, i, t, y))
            gap = _acceleration(plant, t, y) + self._water(plant, t) - there - self._water(twin, t)
            self.rows[i].append(twin.mass @ gap)

    @staticmethod
    def _water(plant: Plant, t: float) -> Array:
        """Acceleration of the water at the vehicle, body axes (relative to over-ground velocity), with the turning frame."""
        k = plant.kin
        fl = k.water
        climb = k.r[6] * k.vel[0] + k.r[7] * k.vel[1] + k.r[8] * k.vel[2]
        a = np.array(to_body(k.r, fl[3] + climb * fl[6], fl[4] + climb * fl[7], fl[5]))
        v = np.array(to_body(k.r, fl[0], fl[1], fl[2]))
        return np.concatenate([a - np.cross(k.rel[3:], v), np.zeros(3)])

    def wrenches(self, i: int) -> dict[str, Any]:
        """Root mean square by axis, and the share of the thrusters' (forces and moments apart)."""
        extra, drive = np.array(self.rows[i]), np.array(self.drive)
        size, thrust = np.sqrt(np.mean(extra**2, axis=0)), np.sqrt(np.mean(drive**2, axis=0))
        force = float(np.linalg.norm(size[:3]) / max(1e-9, float(np.linalg.norm(thrust[:3]))))
        moment = float(np.linalg.norm(size[3:]) / max(1e-9, float(np.linalg.norm(thrust[3:]))))
        return {
            "wrench_rms": dict(zip(AXES, size.tolist(), strict=True)),
            "force_over_thrust": force,
            "moment_over_thrust": moment,
        }


def channel_change(before: Mapping[str, Array], after: Mapping[str, Array]) -> dict[str, Any]:
    """Root mean square change of every channel that a sensor effect touched, CSV units."""
    out = {}
    for name, values in before.items():
        gap = float(np.sqrt(np.mean((after[name] - values) ** 2)))
        if gap > 0.0:
            out[name] = gap
    return {"channel_rms": out}


def realised(recorder: Recorder, changes: Mapping[int, dict[str, Any]], many: int) -> Sequence[dict[str, Any]]:
    """One size for each effect, in order."""
    return [changes[i] if i in changes else recorder.wrenches(i) for i in range(many)]
