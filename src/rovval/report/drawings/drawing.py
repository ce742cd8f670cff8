"""Small drawings of lines, boxes and words: described here in pixels, written as inline SVG by ``templates/parts.html``.

They need no script and take their colours from the page's style sheet, by the class ``css`` of each shape.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import floor, log10
from typing import Any, ClassVar


@dataclass(frozen=True, slots=True)
class Text:
    """One line of words at (x, y); ``anchor`` is the end of it that stands there: start, middle or end."""

    x: float
    y: float
    words: str
    css: str = ""
    anchor: str = "start"
    kind: ClassVar[str] = "text"


@dataclass(frozen=True, slots=True)
class Line:
    """A straight line from (x1, y1) to (x2, y2)."""

    x1: float
    y1: float
    x2: float
    y2: float
    css: str
    kind: ClassVar[str] = "line"


@dataclass(frozen=True, slots=True)
class Box:
    """A filled box with its upper left corner at (x, y); ``round`` is the radius of its corners."""

    x: float
    y: float
    width: float
    height: float
    css: str
    round: float = 0.0
    kind: ClassVar[str] = "box"


@dataclass(frozen=True, slots=True)
class Dot:
    """A filled circle round (x, y)."""

    x: float
    y: float
    radius: float
    css: str
    kind: ClassVar[str] = "dot"


@dataclass(frozen=True, slots=True)
class Curve:
    """A line through ``points`` (x, y); ``hue`` is its colour (degrees) where its class has none."""

    points: tuple[tuple[float, float], ...]
    css: str
    hue: int | None = None
    kind: ClassVar[str] = "curve"


Shape = Text | Line | Box | Dot | Curve


@dataclass(frozen=True, slots=True)
class Drawing:
    """Shapes on a ``width`` by ``height`` sheet, y downwards, with a ``label`` for those who cannot see it. ``columns`` are the values that it shows, by
    their headings, as `drawings.columns` packs them: the reader saves them as CSV."""

    width: float
    height: float
    label: str
    shapes: tuple[Shape, ...]
    columns: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)


def round_up(value: float) -> float:
    """The next round number, as the end of a scale has it: 1, 1.5, 2, 2.5, 3, 4, 5, 6 or 8 times a power of ten."""
    if value <= 0.0:
        return 1.0
    power = 10.0 ** floor(log10(value))
    return next(m * power for m in (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0) if m * power >= value * (1 - 1e-9))
