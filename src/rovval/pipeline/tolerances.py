"""Stated tolerances: ``surge=0.1`` (rmse of the free run), ``surge.iae=12``, ``window.surge.rms=0.05``, all in SI; of a pipeline also
``trend.surge=3``: so many standard deviations above what the vehicle's dives before it let expect.

Every metric of `rovval list metric` may be one. A limit is the most that is allowed, and the least of a metric that is larger the better the simulation is
(``surge.vaf=90``).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rovval.core.errors import UsageProblem, all_at_once

if TYPE_CHECKING:
    from rovval.comparison.metrics import Metric

AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")
RMS = "rms"  # of restarted windows, as their documents name it
TREND = "trend."


@dataclass(frozen=True, slots=True)
class Tolerance:
    """One limit: where (free run or restarted windows), which axis, which number of the comparison, and its limit in SI."""

    windowed: bool
    axis: str
    metric: str
    limit: float

    def __str__(self) -> str:
        return f"{'window.' if self.windowed else ''}{self.axis}.{self.metric}"


def parse(texts: Sequence[str]) -> tuple[Tolerance, ...]:
    """Limits of one run, of the command line or of a pipeline file; every wrong one is named at once."""
    found, problems = [], []
    for text in texts:
        tolerance = _one(text)
        found.append(tolerance) if isinstance(tolerance, Tolerance) else problems.append(tolerance)
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
    name, equals, value = text.partition("=")
    windowed = name.startswith("window.")
    axis, _, metric = name.removeprefix("window.").partition(".")
    metric = metric or ("rms" if windowed else "rmse")
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
        elif _more_is_better(t) and value < t.limit:
            sentences.append(f"{t}: {value:.4g} {_unit(t, comparison)} is below the limit {t.limit:g}")
        elif not _more_is_better(t) and abs(value) > t.limit:
            sentences.append(f"{t}: {abs(value):.4g} {_unit(t, comparison)} is above the limit {t.limit:g}")
    return tuple(sentences)


def _known(windowed: bool) -> tuple[str, ...]:
    from rovval.comparison import metrics

    return (*((RMS,) if windowed else ()), *metrics.names())


def _metric(tolerance: Tolerance) -> Metric:
    from rovval.comparison import metrics

    return metrics.get("rmse" if tolerance.metric == RMS else tolerance.metric)


def _more_is_better(tolerance: Tolerance) -> bool:
    return _metric(tolerance).perfect > 0.0


def _unit(tolerance: Tolerance, comparison: Mapping[str, Any]) -> str:
    unit = str(comparison["axes"].get(tolerance.axis, {}).get("unit", ""))
    return _metric(tolerance).unit_of(unit)
