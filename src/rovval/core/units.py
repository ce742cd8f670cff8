"""Multipliers into SI, the only place where a unit is converted: ``value * SI["deg"]``."""

from __future__ import annotations

from math import pi

from rovval.core.errors import UsageProblem

SI: dict[str, float] = {
    "1": 1.0,
    "s": 1.0,
    "ms": 1e-3,
    "us": 1e-6,
    "ns": 1e-9,
    "h": 3600.0,
    "min": 60.0,
    "day": 86400.0,
    "m": 1.0,
    "cm": 1e-2,
    "mm": 1e-3,
    "km": 1e3,
    "ft": 0.3048,  # international foot, exact
    "m/s": 1.0,
    "cm/s": 1e-2,
    "mm/s": 1e-3,
    "km/h": 1.0 / 3.6,
    "knot": 1852.0 / 3600.0,  # exact by definition of the nautical mile
    "m/s2": 1.0,
    "mg": 9.80665e-3,  # thousandth of standard gravity (CGPM 1901), as autopilots log accelerations
    "g": 9.80665,
    "rad": 1.0,
    "deg": pi / 180.0,
    "cdeg": pi / 18000.0,
    "mrad": 1e-3,
    "rad/s": 1.0,
    "mrad/s": 1e-3,
    "deg/s": pi / 180.0,
    "rad/s2": 1.0,
    "deg/s2": pi / 180.0,
    "rev/s": 1.0,  # thruster speed is in rev/s inside
    "rpm": 1.0 / 60.0,
    "radps_shaft": 1.0 / (2.0 * pi),  # a shaft speed logged in rad/s
    "pwm_us": 1.0,  # pulse width stays in microseconds
    "fraction": 1.0,
    "percent": 0.01,
    "V": 1.0,
    "mV": 1e-3,
    "A": 1.0,
    "N": 1.0,
    "kgf": 9.80665,  # standard gravity, CGPM 1901
    "degree_latitude": 1.0,  # latitude and longitude stay in degrees until they become x, y
}

TIME_UNITS = ("s", "ms", "us", "ns", "min", "h", "day")
DEGREES = 180.0 / pi
DEGREE_UNITS = {"rad": "deg", "rad/s": "deg/s"}


# Ratios that one unit taken for another leaves, and which two these are.
MISTAKEN = (
    (180.0 / pi, "degrees and radians"),
    (60.0, "rpm and rev/s"),
    (30.0 / pi, "rpm and rad/s"),
    (2.0 * pi, "rad/s and rev/s"),
    (3600.0 / 1852.0, "knots and m/s"),
    (1.0 / 0.3048, "feet and metres"),
    (3.6, "km/h and m/s"),
    (100.0, "cm and m"),
    (1000.0, "mm and m"),
)


def mistaken_units(ratio: float, within: float = 0.04) -> str:
    """The two units that a ratio (or its inverse) of two measurements of one thing is that of, to a share of ``within``; "" where it is none."""
    size = max(abs(ratio), 1.0 / abs(ratio)) if ratio else 0.0
    off, words = min((abs(size / r - 1.0), words) for r, words in MISTAKEN)
    return words if off <= within else ""


def to_si(unit: str) -> float:
    """Multiplier of ``unit`` into SI; refuses a unit that is not in the table."""
    try:
        return SI[unit]
    except KeyError:
        raise UsageProblem(f"unknown unit {unit!r}", f"use one of: {', '.join(sorted(SI))}") from None


def in_degrees(value: float, unit: str) -> tuple[float, str]:
    """The value as people read it: radians become degrees, all else stays."""
    return (value * DEGREES, DEGREE_UNITS[unit]) if unit in DEGREE_UNITS else (value, unit)


def integral_unit(unit: str) -> str:
    """Unit of the integral over time of something in ``unit``: m for m/s, m*s for m."""
    return unit.removesuffix("/s") if unit.endswith("/s") else f"{unit}*s"
