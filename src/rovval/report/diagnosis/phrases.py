"""Numbers and names as the sentences of a diagnosis have them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rovval.core.units import in_degrees


def chance(probability: float) -> str:
    """A probability that no rounding makes certain."""
    return "> 0.99" if probability > 0.99 else f"{probability:.2f}"


def value(name: str, p: Mapping[str, Any]) -> str:
    """loss = 0.31 [0.26, 0.36]."""
    factor, unit = in_degrees(1.0, p["unit"])
    best, low, high = (factor * p[k] + 0.0 for k in ("value", "low", "high"))  # + 0.0: no -0
    return f"{name} = {best:.3g} [{low:.3g}, {high:.3g}]{'' if unit == '1' else f' {unit}'}"


def span(s: Mapping[str, Any]) -> str:
    """66 % [58, 72]."""
    return f"{whole(s['total'])} % [{whole(s['low'])}, {whole(s['high'])}]"


def whole(share: float) -> str:
    """Whole per cents, never -0."""
    return str(round(100 * share))


def size(amount: float) -> str:
    """Two digits that mean something, and no exponent for a large vehicle's forces."""
    return f"{amount:.0f}" if amount >= 100.0 else f"{amount:.2g}"


def family(name: str) -> str:
    """An effect's name without its target."""
    return name.partition(".")[0].partition("[")[0]
