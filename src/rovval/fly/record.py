"""What is kept of a flight sample by sample, and what is reckoned from it at the end."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rovval.core.channels import POSE, VELOCITIES
from rovval.core.data import Array, Flags
from rovval.core.frames import wrap
from rovval.fly.flight import QUANTILES, SPREAD, Held, Passed
from rovval.fly.loop.controllers import SetPoints, State
from rovval.fly.mission import WayPoints
from rovval.fly.plan import Phase

ASKED = {"depth": "z", "altitude": "altitude", "heading": "psi", "surge": "u", "sway": "v"}  # set-point -> channel
UNITS = {"depth": "m", "altitude": "m", "heading": "rad", "surge": "m/s", "sway": "m/s"}
WITHIN = 0.05  # of the step: the usual settling band (Fossen 2011, 10.2)


class Record:
    """The flight of lane 0 whole; of the other lanes, the vehicles drawn, their quantiles at each sample and what each leg ended with."""

    def __init__(self, samples: int, thrusters: int, lanes: int, phases: Sequence[Phase]) -> None:
        """``samples`` at most, of ``lanes``."""
        self._rows: list[tuple[Any, ...]] = []
        self._spread = {c: np.full((len(QUANTILES), samples), np.nan) for c in SPREAD} if lanes > 1 else {}
        self._phases = phases
        self._nearest = {p.first: np.full((lanes, len(p.leg.points)), np.inf) for p in phases if isinstance(p.leg, WayPoints)}
        self._when = {p.first: np.zeros(len(p.leg.points)) for p in phases if isinstance(p.leg, WayPoints)}
        self._ends: dict[tuple[int, str], Array] = {}

    def keep(self, k: int, phase: Phase, nu: Array, eta: Array, altitude: Array | None, seen: State, speed: Array, command: Array, wrench: Array,
             given: Array, wanted: SetPoints, turn: NDArray[np.int64] | None, good: Flags) -> None:  # fmt: skip
        """Sample ``k`` of all lanes (B, ...); ``turn`` (B,) way points reached so far, ``good`` (B,) which are still flying."""
        asked = {name: getattr(wanted, name) for name in ASKED if getattr(wanted, name) is not None}
        floor = np.nan if altitude is None else altitude[0]
        believed = np.nan if seen.altitude is None else seen.altitude[0]
        self._rows.append((nu[0].copy(), eta[0].copy(), floor, seen.nu[0], seen.eta[0], believed, speed[0].copy(), command[0].copy(), wrench[0], given[0],
                           {name: float(value[0]) for name, value in asked.items()}))  # fmt: skip
        channels = _channels(nu, eta, altitude)
        for name, value in asked.items():
            off = channels[ASKED[name]] - value
            self._ends[phase.first, name] = (wrap(off) if name == "heading" else off)[1:][good[1:]]
        if isinstance(phase.leg, WayPoints) and turn is not None:
            distance = np.linalg.norm(eta[:, None, :3] - np.array(phase.leg.points), axis=2)
            distance[np.arange(distance.shape[1]) > turn[:, None]] = np.inf  # not its turn yet
            nearer = distance[0] < self._nearest[phase.first][0]
            self._when[phase.first][nearer] = k
            self._nearest[phase.first] = np.minimum(self._nearest[phase.first], distance)
        for name, bands in self._spread.items():
            values = channels[name][1:][good[1:]]
            middle = channels[name][0] if name == "psi" else 0.0
            if len(values):
                bands[:, k] = np.quantile(wrap(values - middle) if name == "psi" else values, QUANTILES) + middle

    def columns(self) -> dict[str, Any]:
        """The arrays of a `Flight`."""
        names = ("nu", "eta", "altitude", "seen_nu", "seen_eta", "seen_altitude", "speed", "command", "wrench", "given")
        out: dict[str, Any] = {name: np.array([row[i] for row in self._rows]) for i, name in enumerate(names)}
        for name in ("altitude", "seen_altitude"):
            out[name] = out[name] if np.isfinite(out[name]).any() else None
        out["set_points"] = {
            name: values for name in ASKED if np.isfinite(values := np.array([row[-1].get(name, np.nan) for row in self._rows])).any()
        }
        n = len(self._rows)
        return out | {"spread": {c: bands[:, :n] for c, bands in self._spread.items()}}

    def held(self, columns: Mapping[str, Any], dt: float) -> tuple[Held, ...]:
        """How each constant set-point of each leg was held."""
        channels = _channels(columns["nu"], columns["eta"], columns["altitude"])
        found = []
        for phase in self._phases:
            rows = slice(phase.first, min(phase.last, len(columns["nu"])))
            for name, values in columns["set_points"].items():
                asked = values[rows]
                if len(asked) and np.isfinite(asked).all() and np.ptp(asked) == 0.0 and not isinstance(phase.leg, WayPoints):
                    off = channels[ASKED[name]][rows] - asked
                    found.append(_held(phase, name, float(asked[0]), _turned(off) if name == "heading" else off, dt, self._ends.get((phase.first, name))))
        return tuple(found)

    def passed(self, dt: float) -> tuple[Passed, ...]:
        """How near each way point was passed."""
        return tuple(
            Passed(p.label, point, float(self._nearest[p.first][0, i]), float(self._when[p.first][i] * dt), _of_draws(self._nearest[p.first][1:, i]))
            for p in self._phases if isinstance(p.leg, WayPoints) and np.isfinite(self._nearest[p.first][0]).any()
            for i, point in enumerate(p.leg.points)
        )  # fmt: skip


def _turned(off: Array) -> Array:
    """Errors of a heading (n,) without jumps at half a turn, the last one within it: a turn of 180 degrees is one to the side that it went."""
    followed = np.unwrap(off)
    return np.asarray(followed - followed[-1] + wrap(followed[-1]))


def _held(phase: Phase, name: str, asked: float, off: Array, dt: float, draws: Array | None) -> Held:
    """One set-point from its errors (n,) along the leg."""
    step = -float(off[0])
    beyond = float(max((off * np.sign(step)).max(), 0.0)) if step else float(np.abs(off).max())
    out = np.flatnonzero(np.abs(off) > WITHIN * abs(step))
    settled = None if not step or (len(out) and out[-1] == len(off) - 1) else (int(out[-1]) + 1 if len(out) else 0) * dt
    return Held(phase.label, name, UNITS[name], asked, step, float(off[-1]), beyond, settled, _of_draws(draws))


def _of_draws(values: Array | None) -> Array | None:
    return values if values is not None and len(values) else None


def _channels(nu: Array, eta: Array, altitude: Array | None) -> dict[str, Array]:
    channels = {n: nu[:, i] for i, n in enumerate(VELOCITIES)} | {n: eta[:, i] for i, n in enumerate(POSE)}
    return channels | {"altitude": np.full(len(nu), np.nan) if altitude is None else altitude}
