"""A Merlin log for tests: smooth known motion at 10 Hz, written as the vehicle's CSV, with every spoiling asked for."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

THRUSTERS = ("VFP", "VFS", "VAC", "HFP", "HFS", "HAP", "HAS")


def columns(n: int = 300, start_s: float = 36000.0, seed: int = 0) -> dict[str, list[str]]:
    """Header -> cells, ``n`` rows from ``start_s`` (s of the day)."""
    t = np.arange(n) * 0.1
    ms = np.rint((start_s + t) * 1000).astype(int) % 86_400_000
    psi = (350.0 + 2.0 * t) % 360.0
    out: dict[str, list[str]] = {
        "Hour": [str(m // 3_600_000) for m in ms],
        "Minute": [str(m // 60_000 % 60) for m in ms],
        "Second": [str(m // 1000 % 60) for m in ms],
        "Millisecond": [str(m % 1000) for m in ms],
    }
    rng = np.random.default_rng(seed)
    wave = {name: np.sin(0.3 * t + k) + 0.01 * rng.normal(size=n) for k, name in enumerate("uvwpqr")}
    numbers = {
        "Latitude": 60.3 + 1e-6 * t, "Longitude": 5.2 + 2e-6 * t, "Depth": 10.0 + 0.1 * np.sin(0.2 * t),
        "Roll": 2 * np.sin(t), "Pitch": 3 * np.cos(t), "Heading": psi,
        "LinVelX": 0.5 * wave["u"], "LinVelY": 0.2 * wave["v"], "LinVelZ": 0.1 * wave["w"],
        "AngVelX": wave["p"], "AngVelY": wave["q"], "AngVelZ": 2.0 + 0.01 * wave["r"],
        "LinAccX": 0.1 * wave["v"], "LinAccY": 0.1 * wave["w"], "LinAccZ": 0.1 * wave["u"],
    }  # fmt: skip
    for k, name in enumerate(THRUSTERS):
        numbers[f"{name}_SP"] = np.round(300 * np.sin(0.1 * t + k))
        numbers[f"{name}_PV"] = 298 * np.sin(0.1 * t + k)
    return out | {name: [f"{x:.9g}" for x in v] for name, v in numbers.items()}


def text(cells: dict[str, list[str]], separator: str = ",", end: str = "\n") -> str:
    """The table as text."""
    rows = [list(cells), *zip(*cells.values(), strict=True)]
    return end.join(separator.join(row) for row in rows) + end


def write(folder: Path, n: int = 300, name: str = "dive.csv", edit: Callable[[dict[str, list[str]]], None] | None = None) -> Path:
    """A Merlin CSV in ``folder``; ``edit`` may change the cells first."""
    cells = columns(n)
    if edit is not None:
        edit(cells)
    path = folder / name
    path.write_text(text(cells), encoding="utf-8")
    return path
