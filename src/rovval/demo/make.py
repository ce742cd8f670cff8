"""Makes the sample log that comes with rovval: ``python -m rovval.demo.make [FILE]``. Deterministic; run it again and nothing changes.

SYNTHETIC: a Merlin dive by rovval's own plant (model fossen) under the commands of `demo.mission`, with one effect that the nominal
simulator does not know (`EFFECT`) and the sensor noise of `NOISE`. It is written as Merlin's hardware log (profile merlin).
"""

from __future__ import annotations

import csv
import gzip
import io
import sys
from pathlib import Path

import numpy as np

from rovval.core.channels import POSE, VELOCITIES
from rovval.core.data import RATE_HZ, Array, ClockReport, Reason, Run
from rovval.demo import EFFECT, SAMPLE
from rovval.demo.mission import speeds
from rovval.simulation import simulate
from rovval.vehicle import load
from rovval.vehicle.model import Vehicle

SEED = 20260101
START_DEPTH_M = 25.0
ORIGIN = (58.97, 5.73)  # degrees, off Stavanger: only to make latitude and longitude look like ones
EARTH_RADIUS_M = 6371008.8  # mean radius, IUGG
LAG_S = 0.25  # chosen: how the shaft follows its set-point
# one sigma; DVL, depth sensor and gyro of the class that a work-class vehicle carries (chosen from data sheets' orders of magnitude)
NOISE = {
    "velocity": 0.004,
    "rate": np.radians(0.02),
    "angle": np.radians(0.02),
    "depth": 0.01,
    "position": 0.03,
    "acceleration": 0.01,
    "rpm": 0.3,
}
THRUSTERS = ("VFP", "VFS", "VAC", "HFP", "HFS", "HAP", "HAS")


def main(path: Path) -> None:
    """Write the sample, compressed without a time stamp so that equal content is an equal file."""
    vehicle = load("merlin")
    rng = np.random.default_rng(SEED)
    set_point = speeds(vehicle)
    turned = lagged(set_point)
    nu, eta = dive(vehicle, turned)
    text = as_csv(noisy_rows(nu, eta, set_point, turned, rng))
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("wb") as raw, gzip.GzipFile("", "wb", 9, raw, mtime=0) as file:
        file.write(text.encode())
    sys.stderr.write(f"{path}: {len(turned)} rows, {path.stat().st_size} bytes\n")


def lagged(set_point: Array) -> Array:
    """First-order shaft speed (n, k) after its set-point."""
    keep = np.exp(-1.0 / (RATE_HZ * LAG_S))
    turned = np.zeros_like(set_point)
    for i in range(1, len(set_point)):
        turned[i] = keep * turned[i - 1] + (1.0 - keep) * set_point[i]
    return turned


def dive(vehicle: Vehicle, rpm: Array) -> tuple[Array, Array]:
    """Velocity and pose (n, 6) of the vehicle with the effect in it."""
    n = len(rpm)
    start = np.full(n, np.nan)
    start[0] = 0.0
    values = {f"n:{name}": rpm[:, j] / 60.0 for j, name in enumerate(vehicle.thrusters)}
    values |= dict.fromkeys((*VELOCITIES, *POSE), start) | {"z": start + START_DEPTH_M, "psi": start + np.radians(40.0)}
    reasons = {c: np.where(np.isfinite(v), Reason.OK, Reason.NOT_LOGGED).astype(np.uint8) for c, v in values.items()}
    clock = ClockReport("row", n, n, 1.0 / RATE_HZ, None, None)
    run = Run("demo", "demo", "", "", "merlin", None, 1.0 / RATE_HZ, values, reasons, {}, clock)
    sim = simulate(run, vehicle, "fossen", (EFFECT,))
    if not sim.free.ok.all():
        raise SystemExit(f"the dive could not be simulated to its end: {sim.stops}")
    return sim.free.nu, sim.free.eta


def noisy_rows(nu: Array, eta: Array, set_point: Array, turned: Array, rng: np.random.Generator) -> dict[str, Array]:
    """The log's columns, each with its sensor's noise."""
    n = len(nu)

    def noise(kind: str, width: int) -> Array:
        return np.asarray(rng.normal(scale=NOISE[kind], size=(n, width)))

    position = eta[:, :2] + noise("position", 2)
    angle = np.degrees(eta[:, 3:] + noise("angle", 3))
    linear, rate = nu[:, :3] + noise("velocity", 3), np.degrees(nu[:, 3:] + noise("rate", 3))
    acceleration = np.gradient(nu[:, :3], 1.0 / RATE_HZ, axis=0) + noise("acceleration", 3)
    measured = turned + noise("rpm", turned.shape[1]) * (np.abs(turned) > 1.0)
    north, east = (
        np.degrees(position[:, 0] / EARTH_RADIUS_M),
        np.degrees(position[:, 1] / EARTH_RADIUS_M) / np.cos(np.radians(ORIGIN[0])),
    )
    columns = {"Latitude": ORIGIN[0] + north, "Longitude": ORIGIN[1] + east, "Depth": eta[:, 2] + noise("depth", 1)[:, 0]}
    columns |= {"Roll": angle[:, 0], "Pitch": angle[:, 1], "Heading": np.mod(angle[:, 2], 360.0)}
    for name, block in (("LinVel", linear), ("AngVel", rate), ("LinAcc", acceleration)):
        columns |= {f"{name}{axis}": block[:, i] for i, axis in enumerate("XYZ")}
    for j, name in enumerate(THRUSTERS):
        columns |= {f"{name}_SP": set_point[:, j], f"{name}_PV": measured[:, j]}
    return columns


DIGITS = {"Latitude": 7, "Longitude": 7, "Depth": 3, "Heading": 2, "Roll": 3, "Pitch": 3}


def as_csv(columns: dict[str, Array]) -> str:
    """The hardware log's text: time of day from 10:00:00, then the columns."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["Hour", "Minute", "Second", "Millisecond", *columns])
    for i in range(len(next(iter(columns.values())))):
        seconds, tenth = divmod(i, 10)
        stamp = [10, seconds // 60, seconds % 60, 100 * tenth]
        writer.writerow([*stamp, *(_cell(name, float(values[i])) for name, values in columns.items())])
    return out.getvalue()


def _cell(column: str, value: float) -> str:
    digits = DIGITS.get(column, 1 if column.endswith(("_SP", "_PV")) else 4)
    return f"{round(value, digits) + 0.0:.{digits}f}"  # + 0.0: no minus before a zero


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else SAMPLE)
