"""What goes into a flight (``Planted``) and what comes out of it (``Flight``)."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
PlantName = Literal["a", "b"]
PLANTS: Mapping[str, PlantName] = MappingProxyType({"a": "a", "b": "b"})  # `rovval.blind.plant` with `planted` and `missions`, and `rovval.blind.second`
AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")
RATE_HZ = 10.0  # the control and log rate of the Merlin, thesis 4.5
STEP_S = 1.0 / RATE_HZ


@dataclass(frozen=True, slots=True)
class Planted:
    """One thing to plant: a name of the plant's catalogue, its axis or thruster, how strong, and from when.

    ``severity`` 1 is clearly visible on a rich log, 0 is absent. ``target`` None lets the flight choose (by its seed) where
    the effect needs a target; ``onset_s`` None means from the start, except for effects that are events.
    """

    name: str
    target: str | None = None
    severity: float = 1.0
    onset_s: float | None = None


@dataclass(frozen=True, slots=True)
class Flight:
    """One generated log. ``time_s`` (N,) counts from the first row; ``true`` and ``measured`` map a name to (N,).

    ``true`` is SI and radians (north-east-down, forward-starboard-down); ``measured`` is named and scaled as the CSV's columns
    are, NaN where the cell is empty. ``truth`` is JSON-able: what was planted, its numbers, its realised size.
    """

    vehicle: str
    mission: str
    thrusters: tuple[str, ...]
    time_s: Array
    true: Mapping[str, Array]
    measured: Mapping[str, Array]
    start_of_day_s: float
    truth: Mapping[str, Any]


def stream(seed: int, *words: str) -> np.random.Generator:
    """A random stream of its own for each purpose, so that planting one thing never shifts the draws of another."""
    return np.random.default_rng([seed & 0xFFFFFFFF, *(zlib.crc32(word.encode()) for word in words)])
