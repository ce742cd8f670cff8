"""What a diagnosis returns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """``document``: the JSON of the contract (rovval.diagnosis/1). ``settings``: the effects found, as ``--effect`` takes them.
    ``vehicle_fixed``: TOML of the vehicle with these effects added, "" where nothing was found."""

    document: dict[str, Any]
    settings: tuple[str, ...]
    vehicle_fixed: str
