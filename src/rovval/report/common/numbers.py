"""Numbers as every report prints them: digits that mean something, angles in degrees, an interval in brackets, a share in per cent.

Terminal, Markdown and HTML all format here, so that a value reads the same wherever it stands: ``0.299 [0.241, 0.358] m/s``.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import floor, isfinite, log10

from rovval.core.units import in_degrees

MISSING = "-"  # what is printed for a value that is not known


def number(value: float | None, digits: int = 3) -> str:
    """A number with so many significant digits, and no exponent while it stays readable: 0.0712, 12.3, 1240."""
    if value is None or not isfinite(value):
        return MISSING
    if value == 0.0:
        return "0"
    size = floor(log10(abs(float(f"{value:.{digits - 1}e}"))))
    if not -5 <= size < 7:
        return f"{value:.{digits - 1}e}"
    return f"{value:.{max(0, digits - 1 - size)}f}"


def signed(value: float | None) -> str:
    """A skill, with its sign: +0.96, -120; "-" where there is none."""
    return MISSING if value is None else f"{value:+.2f}" if abs(value) < 100 else f"{value:+.0f}"


def quantity(value: float | None, unit: str, digits: int = 3) -> str:
    """Value and unit, angles in degrees: 0.0234 m/s, 1.42 deg/s."""
    if value is None:
        return MISSING
    shown, name = in_degrees(value, unit)
    return _with_unit(number(shown, digits), name)


def interval(low: float | None, high: float | None, unit: str = "1", digits: int = 3) -> str:
    """[0.241, 0.358] m/s; "-" where there is none."""
    if low is None or high is None:
        return MISSING
    (bottom, name), (top, _) = in_degrees(low, unit), in_degrees(high, unit)
    return _with_unit(f"[{number(bottom, digits)}, {number(top, digits)}]", name)


def estimate(value: float | None, low: float | None, high: float | None, unit: str = "1") -> str:
    """A value with its interval: 0.299 [0.241, 0.358] m/s; without brackets where no interval is known."""
    if value is None or low is None or high is None:
        return quantity(value, unit)
    return f"{number(in_degrees(value, unit)[0])} {interval(low, high, unit)}"


def per_cent(share: float | None) -> str:
    """A share as a percentage: 64 %, 0.3 %, -30 %."""
    if share is None or not isfinite(share):
        return MISSING
    value = 100.0 * share
    return f"{value:.1f} %" if 0.05 <= abs(value) < 0.95 else f"{_whole(value)} %"


def per_cents(low: float | None, high: float | None) -> str:
    """The interval of a share, in whole per cents as `share` has it: [58, 72] %."""
    return MISSING if low is None or high is None else f"[{_whole(100.0 * low)}, {_whole(100.0 * high)}] %"


def share(total: float | None, low: float | None = None, high: float | None = None) -> str:
    """A share with its interval: 66 % [58, 72]; without brackets where no interval is known."""
    if total is None or low is None or high is None:
        return per_cent(total)
    return f"{per_cent(total)} {per_cents(low, high).removesuffix(' %')}"


def probability(value: float) -> str:
    """A probability that no rounding makes certain: 0.71, > 0.99, < 0.01."""
    return "> 0.99" if value > 0.99 else "< 0.01" if value < 0.01 else f"{value:.2f}"


def duration(seconds: float) -> str:
    """90 s, 12 min 5 s, 1 h 20 min."""
    whole = round(seconds)
    if whole < 120:
        return f"{seconds:.0f} s" if seconds >= 10 else f"{seconds:.1f} s"
    if whole < 7200:
        return f"{whole // 60} min {whole % 60} s".removesuffix(" 0 s")
    return f"{whole // 3600} h {whole % 3600 // 60} min"


def listed(words: Iterable[str], link: str = "and") -> str:
    """surge, sway and yaw; "" for none."""
    items = list(words)
    return items[0] if len(items) == 1 else f"{', '.join(items[:-1])} {link} {items[-1]}" if items else ""


def _with_unit(text: str, unit: str) -> str:
    return text if unit == "1" else f"{text} {unit}"


def _whole(value: float) -> str:
    """A whole number, never -0."""
    return str(round(value))
