"""Stated tolerances: ``surge=0.1`` (rmse of the free run), ``surge.iae=12``, ``window.surge.rms=0.05``, all in SI; of a pipeline also
``trend.surge=3``: so many standard deviations above what the vehicle's dives before it let expect.

Every metric of `rovval list metric` may be one. A limit is the most that is allowed, and the least of a metric that is larger the better the simulation is
(``surge.vaf=90``).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from rovval.core.errors import UsageProblem, all_at_once

if TYPE_CHECKING:
    from rovval.comparison.tolerance import Tolerance

AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")
TREND = "trend."


def parse(texts: Sequence[str]) -> tuple[Tolerance, ...]:
    """Limits of one run, of the command line or of a pipeline file; every wrong one is named at once."""
    found, problems = list["Tolerance"](), list[str]()
    for text in texts:
        tolerance = _one(text)
        problems.append(tolerance) if isinstance(tolerance, str) else found.append(tolerance)
    if problems:
        raise UsageProblem(
            all_at_once(problems, "tolerance"), "write AXIS=VALUE, AXIS.METRIC=VALUE or window.AXIS.METRIC=VALUE"
        )
    return tuple(found)


def parse_trends(texts: Sequence[str]) -> dict[str, float]:
    """The limits of a pipeline file that hold over dives, in standard deviations by axis; every wrong one is named at once."""
    pairs = [text.removeprefix(TREND).partition("=") for text in texts if text.startswith(TREND)]
    if wrong := [f"{TREND}{axis}={value}" for axis, _, value in pairs if axis not in AXES or not _positive(value)]:
        raise UsageProblem(all_at_once([f"{text!r}" for text in wrong], "tolerance"), f"write trend.AXIS=SIGMAS, AXIS one of {', '.join(AXES)}")
    return {axis: float(value) for axis, _, value in pairs}


def of_one_run(texts: Sequence[str]) -> tuple[str, ...]:
    """The limits that can be held against a run by itself."""
    return tuple(text for text in texts if not text.startswith(TREND))


def _positive(value: str) -> bool:
    try:
        return 0 < float(value) < float("inf")
    except ValueError:
        return False


def _one(text: str) -> Tolerance | str:
    from rovval.comparison.tolerance import RMS, Tolerance

    name, equals, value = text.partition("=")
    windowed = name.startswith("window.")
    axis, _, metric = name.removeprefix("window.").partition(".")
    metric = metric or (RMS if windowed else "rmse")
    known = _known(windowed)
    if axis not in AXES:
        return f"{text!r}: axis {axis!r} is none of {', '.join(AXES)}"
    if metric not in known:
        return f"{text!r}: metric {metric!r} is none of {', '.join(known)}"
    try:
        limit = float(value)
    except ValueError:
        limit = float("nan")
    if not equals or not 0 <= limit < float("inf"):
        return f"{text!r}: the limit {value!r} is not a number from 0 up"
    return Tolerance(windowed, axis, metric, limit)


def exceeded(tolerances: Sequence[Tolerance], comparison: Mapping[str, Any]) -> tuple[str, ...]:
    """One sentence for each limit that the comparison's JSON does not keep. An axis that was not measured keeps none."""
    sentences = []
    for t in tolerances:
        axes = comparison.get("window", {}).get("axes", {}) if t.windowed else comparison["axes"]
        row = axes.get(t.axis)
        value = None if row is None else row.get(t.metric)
        if value is None:
            sentences.append(f"{t}: limit {t.limit:g}, but {t.axis} was not measured in this run")
        elif not t.keeps(value):
            size, side = (value, "below") if t.more_is_better else (abs(value), "above")
            unit = t.of.unit_of(str(comparison["axes"].get(t.axis, {}).get("unit", "")))
            sentences.append(f"{t}: {size:.4g} {unit} is {side} the limit {t.limit:g}")
    return tuple(sentences)


def _known(windowed: bool) -> tuple[str, ...]:
    from rovval.comparison import metrics
    from rovval.comparison.tolerance import RMS

    return (*((RMS,) if windowed else ()), *metrics.names())
