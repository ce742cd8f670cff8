"""Fly a mission with plant b: ten times a second the pilot looks and asks, fifty times a second the craft moves on."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rovval.blind.plant.spec import AXES, RATE_HZ, Array, Flight, Planted, stream
from rovval.blind.plant.spec import STEP_S as ROW_S
from rovval.blind.second.blades import Drives
from rovval.blind.second.catalogue import plant
from rovval.blind.second.fault import Fault, Instant, Site
from rovval.blind.second.hull import hull
from rovval.blind.second.instruments import Log, measure, spoil
from rovval.blind.second.motion import STEP_S as MOVE_S
from rovval.blind.second.motion import Craft, turned
from rovval.blind.second.pilots import PILOTS, Pilot, Seen
from rovval.blind.second.sheet import Sheet, read

ROWS_A_LOOK = 10  # one look a second at what each effect pushes
SANE_M_S = 6.0  # beyond this the flight is no ROV's
SLOP = 0.05  # no coefficient of the file is off by more than this share
GUST, GUST_S = 0.1, 2.5  # unlogged force: share of the working force at a slop of one, and its correlation time (chosen)
VOLTS = (16.0, 450.0)  # nominal supply of small and of large vehicles, V


def site_of(sheet: Sheet, seed: int, seconds: float) -> Site:
    """Where the flight takes place."""
    rng = stream(seed, "b", "site")
    depth, altitude = float(rng.uniform(6.0, 25.0)), float(rng.choice([rng.uniform(1.8, 4.0), rng.uniform(4.0, 15.0)]))
    bearing, away = float(rng.uniform(-math.pi, math.pi)), float(rng.uniform(6.0, 20.0))
    winch = np.array([away * math.cos(bearing), away * math.sin(bearing), max(0.0, depth - float(rng.uniform(3.0, 8.0)))])
    return Site(seconds, depth, depth + altitude, float(rng.uniform(-math.pi, math.pi)), winch, float(rng.uniform(0.15, 0.3)))


def fly(vehicle: Path, mission: str, effects: Sequence[Planted], seed: int, duration_s: float, slop: float = SLOP) -> Flight:
    """One log of plant b. Equal arguments give the same log to the last bit; severity 0 is as not planted.

    Raises:
        ValueError: an effect, a target, a mission or a severity that there is not.
        RuntimeError: the flight left sane limits.
    """
    sheet = read(Path(vehicle))
    site = site_of(sheet, seed, duration_s)
    if mission not in PILOTS:
        raise ValueError(f"plant b has no mission {mission!r}; one of: {', '.join(PILOTS)}")
    faults = [plant(item, sheet, site, seed) for item in effects if item.severity != 0.0]
    craft = Craft(sheet, hull(sheet, slop, stream(seed, "b", "slop")), Drives(sheet, stream(seed, "b", "drives")), faults, site.seabed)
    craft.at, craft.q = np.array([0.0, 0.0, site.depth]), turned(craft.q, np.array([0.0, 0.0, site.heading]))
    pilot = PILOTS[mission](sheet, site, stream(seed, "b", "pilot"))
    true, looks = _rows(craft, pilot, site, seed, slop)
    t: Array = ROW_S * np.arange(len(true["x"]), dtype=np.float64)
    log = measure(true, sheet.units, stream(seed, "b", "instruments"))
    changes = {id(f): _record(f, log, true, t) for f in faults if f.has("record")}
    spoil(log, stream(seed, "b", "spoil"))
    begins = round(float(stream(seed, "b", "clock").uniform(0.0, 86_399.0)), 3)
    sizes = [changes.get(id(f)) or _wrenches(looks[id(f)], looks[0]) for f in faults]
    truth = {
        "vehicle": sheet.name, "plant": "b", "mission": mission, "seed": seed, "duration_s": duration_s, "slop": slop,
        "start_depth_m": site.depth, "start_altitude_m": site.seabed - site.depth,
        "effects": [_label(f, size) for f, size in zip(faults, sizes, strict=True)],
    }  # fmt: skip
    return Flight(sheet.name, mission, sheet.units, t, true, log, begins, truth)


def _label(fault: Fault, size: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "name": fault.name, "place": fault.place if fault.known else "foreign", "form": fault.form if fault.known else "foreign",
        "target": fault.target, "severity": fault.size, "onset_s": fault.onset, "values": fault.values, "realised": size,
    }  # fmt: skip


def _rows(craft: Craft, pilot: Pilot, site: Site, seed: int, slop: float) -> tuple[Log, dict[int, list[Array]]]:
    """The true channels at every row, and the wrench of the thrusters (key 0) and of each effect at every look."""
    sheet, rng = craft.sheet, stream(seed, "b", "eyes")
    gusts, store = stream(seed, "b", "gusts"), Supply(sheet, site)
    looks: dict[int, list[Array]] = {0: [], **{id(f): [] for f in craft.faults}}
    moved = [f for f in craft.faults if not f.has("record")]
    rows, yaw, far = [], site.heading, 0.0
    for i in range(round(site.seconds * RATE_HZ)):
        craft.refresh()
        craft.gust = _gust(craft.gust, sheet, slop, gusts)
        s = craft.now()
        craft.volts = store.after(s)
        roll, pitch, heading = _euler(s.turn)
        yaw += math.remainder(heading - yaw, math.tau)
        far = max(far, float(np.linalg.norm(s.at - site.winch)))
        e = rng.standard_normal(12)
        seen = Seen(s.at + 0.02 * e[:3], roll + 0.003 * e[3], pitch + 0.003 * e[4], yaw + 0.005 * e[5], np.array(s.nu) + 0.008 * e[6:], s.altitude)
        asked = pilot.ask(s.t, seen)
        craft.drives.wanted = asked
        rows.append([*s.at, roll, pitch, yaw, *s.nu, s.altitude, store.volts, 1.03 * far + 0.5, *s.n, *asked])
        if i % ROWS_A_LOOK == ROWS_A_LOOK - 1:
            looks[0].append(craft.lever @ s.thrust)
            for f in moved:
                looks[id(f)].append(craft.extra(s, f))
        if max(map(abs, s.nu[:3])) > SANE_M_S or not np.isfinite(s.nu).all():
            raise RuntimeError(f"the flight left sane limits at {s.t:.1f} s")
        for _ in range(round(ROW_S / MOVE_S)):
            craft.step()
    names = ["x", "y", "z", "roll", "pitch", "yaw", *"uvwpqr", "altitude", "voltage", "paid_out"]
    names += [f"{kind}:{unit}" for kind in ("n", "n_cmd") for unit in sheet.units]
    return dict(zip(names, np.array(rows).T.copy(), strict=True)), looks


def _gust(now: Array, sheet: Sheet, slop: float, rng: np.random.Generator) -> Array:
    """The unlogged wrench of the next row: first-order in time, with the fat tails of gusts (Student's t of five degrees)."""
    keep = math.exp(-ROW_S / GUST_S)
    arms = np.array([1.0, 1.0, 1.0, *(3 * [0.3 * sheet.half_length])])
    kick = rng.standard_t(5.0, 6) / math.sqrt(5.0 / 3.0)
    return np.asarray(keep * now + math.sqrt(1.0 - keep * keep) * GUST * slop * sheet.force * arms * kick)


class Supply:
    """The supply's voltage: sags with the work done and with the power drawn now."""

    def __init__(self, sheet: Sheet, site: Site) -> None:
        self.sheet, self.site, self.done, self.volts = sheet, site, 0.0, VOLTS[int(sheet.mass > 200.0)]
        self.full = self.volts

    def after(self, s: Instant) -> float:
        """Voltage over nominal, from here to the next row."""
        power = float(np.abs(s.static * s.n).mean()) / (self.sheet.thrust * self.sheet.rpm)
        self.done += power * ROW_S / self.site.seconds
        share = 1.0 - self.site.sag * min(1.0, 0.4 * s.t / self.site.seconds + 2.0 * self.done) - 0.02 * min(2.0, power)
        self.volts = share * self.full
        return share


def _euler(turn: Array) -> tuple[float, float, float]:
    return (
        math.atan2(float(turn[2, 1]), float(turn[2, 2])),
        -math.asin(float(np.clip(turn[2, 0], -1.0, 1.0))),
        math.atan2(float(turn[1, 0]), float(turn[0, 0])),
    )


def _record(fault: Fault, log: Log, true: Mapping[str, Array], t: Array) -> dict[str, Any]:
    """Let a fault of the log act; root mean square change of every channel that it touched."""
    before = {name: x.copy() for name, x in log.items()}
    fault.record(log, true, t)
    changed = {name: float(np.sqrt(np.mean((x - before[name]) ** 2))) for name, x in log.items()}
    return {"channel_rms": {name: size for name, size in changed.items() if size > 0.0}}


def _wrenches(extra: Sequence[Array], drive: Sequence[Array]) -> dict[str, Any]:
    """Root mean square wrench by axis, and forces and moments over those of the thrusters."""
    size, thrust = (np.sqrt(np.mean(np.array(x) ** 2, axis=0)) if len(x) else np.zeros(6) for x in (extra, drive))
    over = [float(np.linalg.norm(size[part]) / max(1e-9, float(np.linalg.norm(thrust[part])))) for part in (slice(3), slice(3, 6))]
    return {"wrench_rms": dict(zip(AXES, size.tolist(), strict=True)), "force_over_thrust": over[0], "moment_over_thrust": over[1]}


