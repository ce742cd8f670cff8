"""A flight to a CSV with the header of the Merlin hardware log, and three columns more: altitude, voltage, tether length."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rovval.blind.plant.spec import Flight, stream
from rovval.storage.atomic import drafts

TIME = ("Hour", "Minute", "Second", "Millisecond")
MOTION = (
    "Latitude", "Longitude", "Depth", "Roll", "Pitch", "Heading", "LinVelX", "LinVelY", "LinVelZ",
    "AngVelX", "AngVelY", "AngVelZ", "LinAccX", "LinAccY", "LinAccZ",
)  # fmt: skip
EXTRA = ("Altitude", "Voltage", "TetherLength")
DECIMALS = {"Latitude": 8, "Longitude": 8, "Depth": 3, "Roll": 3, "Pitch": 3, "Heading": 3, "Altitude": 2, "TetherLength": 2}
JITTER_S = 0.002  # of the time stamp, chosen


def header(thrusters: tuple[str, ...]) -> tuple[str, ...]:
    """Column names in order."""
    speeds = tuple(f"{name}_{kind}" for name in thrusters for kind in ("SP", "PV"))
    return TIME + MOTION + speeds + EXTRA


def _decimals(name: str) -> int:
    """Digits after the point: whole set-points, a tenth of an rpm in feedback and a tenth of a volt at least."""
    if name.endswith("_SP"):
        return 0
    return DECIMALS.get(name, 1 if name.endswith("_PV") else 4 if name != "Voltage" else 2)


def rows(flight: Flight) -> Iterator[list[str]]:
    """Cells of every row; empty where nothing was measured. The clock wraps at midnight."""
    names = header(flight.thrusters)[len(TIME) :]
    jitter = JITTER_S * np.clip(stream(int(flight.truth["seed"]), "jitter").standard_normal(len(flight.time_s)), -2.5, 2.5)
    stamps = np.round((flight.start_of_day_s + flight.time_s + jitter) * 1000.0).astype(np.int64) % 86_400_000
    columns = [[("" if v != v else f"{v:.{_decimals(n)}f}") for v in flight.measured[n].tolist()] for n in names]
    for i, stamp in enumerate(stamps.tolist()):
        seconds, milli = divmod(stamp, 1000)
        minutes, second = divmod(seconds, 60)
        hour, minute = divmod(minutes, 60)
        yield [str(hour), str(minute), str(second), str(milli), *(column[i] for column in columns)]


def write_csv(flight: Flight, path: Path) -> None:
    """Write the log; an existing file is replaced whole."""
    with drafts(path) as [draft], draft.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header(flight.thrusters))
        writer.writerows(rows(flight))
