"""Logs with a planted cause, for tests of the diagnosis: from the project's own plant (known to the last digit, noise on top) and from
the independent plant of `rovval.blind`, which shares no code with it."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from rovval import vehicle
from rovval.blind.cases.csv_log import write_csv
from rovval.blind.cases.flight import fly
from rovval.blind.plant.spec import Flight, Planted
from rovval.core.channels import POSE, VELOCITIES
from rovval.core.data import Array, ClockReport, Reason, Run
from rovval.diagnose import Diagnosis, diagnose
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.problem.problem import Problem, pose
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.simulation import simulate
from rovval.storage.archive import open_run
from rovval.vehicle.model import Vehicle, allocation

LIBRARY = Path(vehicle.__file__).parent / "library"
NOISE = dict.fromkeys("uvw", 0.004) | dict.fromkeys("pqr", 0.0005) | {"x": 0.03, "y": 0.03, "z": 0.01} | dict.fromkeys(("phi", "theta", "psi"), 0.0005)
SHARE = {"surge": 1.0, "sway": 0.7, "heave": 0.5, "yaw": 0.5}  # of the largest push on an axis that the commands use


@functools.cache
def merlin() -> Vehicle:
    return vehicle.load("merlin")


def commands(v: Vehicle, seed: int, seconds: float) -> Array:
    """Thruster speeds (n, k) rev/s: pushes on four axes, each held for 4 to 12 s, with pauses."""
    rng, n = np.random.default_rng(seed), round(seconds * 10)
    push = np.zeros((n, 6))
    for axis, (name, share) in zip((0, 1, 2, 5), SHARE.items(), strict=True):
        at = 0
        while at < n:
            length = int(rng.integers(40, 120))
            push[at : at + length, axis] = share * rng.choice([-1.0, -0.6, -0.3, 0.0, 0.3, 0.6, 1.0]) if name else 0.0
            at += length
    reach = allocation(v)
    size = np.abs(reach).sum(axis=1)
    unit = (push * size) @ np.linalg.pinv(reach).T
    thrust = unit / np.abs(unit).max() * 0.006 * v.weight
    gain = np.where(thrust >= 0, [t.k_pos for t in v.thruster], [t.k_neg for t in v.thruster])
    return np.asarray(np.sign(thrust) * np.sqrt(np.abs(thrust) / gain) / 60.0)


def bare(values: dict[str, Array], v: Vehicle, name: str) -> Run:
    """A run of channels in SI; NaN is not logged."""
    reasons = {c: np.where(np.isfinite(x), Reason.OK, Reason.NOT_LOGGED).astype(np.uint8) for c, x in values.items()}
    n = len(next(iter(values.values())))
    return Run(name, name, "", "", v.name, None, 0.1, values, reasons, {}, ClockReport("row", n, n, 0.1, None, None))


@functools.cache
def own(effects: tuple[str, ...] = (), seed: int = 0, seconds: float = 240.0, noise: float = 1.0, v: Vehicle | None = None) -> Run:
    """A log of the project's own plant with ``effects`` in it and sensor noise of ``noise`` times `NOISE`."""
    v = v or merlin()
    speed = commands(v, seed, seconds)
    start = np.full(len(speed), np.nan)
    start[0] = 0.0
    channels = {f"n:{t}": speed[:, j] for j, t in enumerate(v.thrusters)}
    first = bare(channels | dict.fromkeys((*VELOCITIES, *POSE), start) | {"z": start + 25.0}, v, f"own{seed}")
    sim = simulate(first, v, "fossen", effects)
    assert sim.free.ok.all(), sim.stops
    rng = np.random.default_rng([seed, 1])
    motion = np.concatenate([sim.free.nu, sim.free.eta], axis=1)
    seen = {c: motion[:, i] + noise * NOISE[c] * rng.normal(size=len(motion)) for i, c in enumerate((*VELOCITIES, *POSE))}
    return bare(channels | seen, v, f"own{seed}")


@functools.cache
def diagnosed(effects: tuple[str, ...] = (), seed: int = 5, seconds: float = 100.0) -> Diagnosis:
    """The diagnosis of such a log of Merlin, made once for all tests of a process that look at it."""
    return diagnose([own(effects, seed, seconds)], merlin())


@functools.cache
def posed(effects: tuple[str, ...] = (), seed: int = 5, seconds: float = 200.0) -> tuple[Problem, list[Hypothesis]]:
    """The estimation problem of such a log of Merlin, and the hypotheses of the library that it was linearised in."""
    windows, _ = cut([own(effects, seed, seconds)], merlin(), "fossen", 10.0)
    library, _ = hypotheses(windows)
    return pose(windows, columns_of(library), 0.05), library


def slot(problem: Problem, key: str) -> int:
    """Place of a parameter, ``waves.period``, among those of the problem's plant."""
    return next(i for i, s in enumerate(problem.plant.slots) if s.key == key)


def logged(flight: Flight, path: Path) -> Run:
    """A flight of either plant of the blind check, written to ``path`` and read as Merlin's CSV is."""
    write_csv(flight, path)
    return open_run(path, "merlin", path.parent / "archive")


@functools.cache
def foreign(
    folder: Path, planted: Sequence[tuple[str, str, float]], seed: int, seconds: float = 200.0, slop: float = 0.0, v: str = "merlin",
    mission: str = "rich", onset: float | None = None,
) -> Run:  # fmt: skip
    """A log of the independent plant, written and read as Merlin's CSV; ``planted``: (effect, target, severity)."""
    effects = [Planted(name, target or None, severity, onset) for name, target, severity in planted]
    return logged(fly(LIBRARY / f"{v}.toml", mission, effects, seed, seconds, slop), folder / f"foreign{seed}.csv")


def bluerov2(folder: Path, name: str, seed: int, seconds: float, slop: float, *effects: tuple[str, str, float]) -> Run:
    """A log of the independent plant of a BlueROV2, flown open-loop; ``effects``: (effect, target, severity)."""
    planted = [Planted(name, target or None, severity) for name, target, severity in effects]
    return logged(fly(LIBRARY / "bluerov2_heavy.toml", "rich", planted, seed, seconds, slop), folder / name)


def turned(damping: float, answers: bool, seed: int = 4) -> Run:
    """A BlueROV2 that gusts turn, and a pilot who wants now this, now that: its thrusters give ``damping`` (N m s) against the rate of a sample before, if it
    ``answers``, or what it wants alone. A hull that nobody pushes turns after them."""
    v, rng, n = vehicle.load("bluerov2_heavy"), np.random.default_rng(seed), 2400
    wanted, gust = np.repeat(rng.normal(size=n // 40), 40), rng.normal(size=n)
    moment, rate = np.zeros(n), np.zeros(n)
    for k in range(1, n):
        moment[k] = 0.7 * moment[k - 1] + 0.3 * wanted[k] - (damping * rate[k - 1] if answers else 0.0)
        rate[k] = rate[k - 1] + 0.1 / 0.6 * (moment[k] + gust[k] - 0.5 * rate[k - 1])
    thrust = moment[:, None] * (np.linalg.pinv(allocation(v)) @ np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0]))
    speed = np.sign(thrust) * np.sqrt(np.abs(thrust) / np.where(thrust >= 0, [x.k_pos for x in v.thruster], [x.k_neg for x in v.thruster]))
    values = {c: np.zeros(n) for c in ("u", "v", "w", "p", "q", "x", "y", "z", "phi", "theta")}
    values |= {"psi": np.cumsum(rate) * 0.1, "r": rate} | {f"n:{x.name}": speed[:, i] / 60.0 for i, x in enumerate(v.thruster)}
    return bare(values, v, f"turned {damping} {answers}")


def with_values(run: Run, **values: Array) -> Run:
    """The run with other values of some channels."""
    return replace(run, values={**run.values, **values})


def without(run: Run, *channels: str) -> Run:
    """The run with channels never logged."""
    return replace(
        run,
        values={c: x for c, x in run.values.items() if c not in channels},
        reasons={c: x for c, x in run.reasons.items() if c not in channels},
    )
