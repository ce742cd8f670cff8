"""A log as an operator's own software would export it: the sample dive under other names and units."""

from __future__ import annotations

import csv
import gzip
from pathlib import Path

from rovval import demo

KNOT = 1852.0 / 3600.0
RENAMED = {
    "LinVelX": "speed_ahead",
    "LinVelY": "speed_right",
    "LinVelZ": "speed_down",
    "AngVelZ": "turn_rate",
    "Depth": "depth",
    "Heading": "heading",
}


def write_own_log(path: Path, seconds: int = 60) -> None:
    """The sample dive, speeds in knots, turn rate and heading in degrees, thrusters in rpm."""
    with gzip.open(demo.SAMPLE, "rt", encoding="utf-8") as sample:
        rows = list(csv.DictReader(sample))[: seconds * 10]
    thrusters = [name.removesuffix("_PV") for name in rows[0] if name.endswith("_PV")]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["t", *RENAMED.values(), *(f"rpm_{t}" for t in thrusters)])
        for i, row in enumerate(rows):
            values = [float(row[c]) / (KNOT if c.startswith("LinVel") else 1.0) for c in RENAMED]
            writer.writerow([i / 10, *values, *(row[f"{t}_PV"] for t in thrusters)])
