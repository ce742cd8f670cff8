"""Measured speed of each thruster against its command: a unit, a sign or the want of one shows without any dynamics."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array, RawLog, Series
from rovval.core.errors import Finding
from rovval.core.units import mistaken_units

CORRELATION, RATIO = 0.9, 2.0  # of speed and set-point: a governor that lags or droops stays within
LEAST_SAMPLES = 50
BOTH_WAYS = 0.05  # share of a command on its rarer side from which on a thruster turns both ways
FOLLOWS = 0.6  # correlation of the sizes of speed and command from which on the speed is that of this thruster
NEUTRAL_US = 1500.0  # us
DEADBAND_US = 30.0  # us about neutral in which an ESC does not turn: 25 of a T200's, rounded up


def against_commands(raw: RawLog) -> tuple[Finding, ...]:
    """A finding for each thruster whose speed is a multiple of its set-point, runs against it, or has no sign where its command has one."""
    found: list[Finding] = []
    for name, speed in raw.channels.items():
        family, _, thruster = name.partition(":")
        if family != "n" or len(speed.t) < LEAST_SAMPLES:
            continue
        for command in ("n_cmd", "pwm"):
            wanted = raw.channels.get(f"{command}:{thruster}")
            if wanted is None or len(wanted.t) < LEAST_SAMPLES:
                continue
            other = f"{command}:{thruster}"
            unsigned = _unsigned(name, speed, other, _at(wanted, speed.t) - (NEUTRAL_US if command == "pwm" else 0.0))
            found += unsigned or (_proportional(name, speed, other, wanted) if command == "n_cmd" else [])
    return tuple(found)


def _at(series: Series, t: Array) -> Array:
    """The command in force at ``t``: the last one."""
    return np.asarray(series.values[np.clip(np.searchsorted(series.t, t, "right") - 1, 0, None)])


def _unsigned(name: str, speed: Series, other: str, command: Array) -> list[Finding]:
    dead = DEADBAND_US if other.startswith("pwm") else 0.0
    ahead, astern = float((command > dead).mean()), float((command < -dead).mean())
    one_way = bool((speed.values >= 0.0).all() or (speed.values <= 0.0).all())
    if not one_way or not speed.values.any() or min(ahead, astern) < BOTH_WAYS:
        return []
    if np.corrcoef(np.abs(speed.values), np.abs(command))[0, 1] < FOLLOWS:
        return []
    detail = (
        f"the speed never changes its sign, while its command goes both ways: "
        f"it is logged without sign; give the channel sign_from = {other.partition(':')[0]!r} in the profile"
    )
    return [Finding("unsigned", f"{name}, {other}", detail)]


def _proportional(name: str, speed: Series, other: str, wanted: Series) -> list[Finding]:
    a, b = speed.values, np.interp(speed.t, wanted.t, wanted.values)
    aa, ab, bb = (float((x * y).sum()) for x, y in ((a, a), (a, b), (b, b)))
    if abs(ab) < CORRELATION * np.sqrt(aa * bb) or ab == 0.0:
        return []
    if ab < 0:
        return [Finding("sign", f"{name}, {other}", "the thruster turns against its set-point: one of the signs is wrong")]
    if 1 / RATIO < ab / bb < RATIO:
        return []
    units = mistaken_units(ab / bb)
    detail = f"the thruster turns {ab / bb:.2g} times its set-point: one of the units is wrong" + (f" (the ratio of {units})" if units else "")
    return [Finding("scale", f"{name}, {other}", detail)]
