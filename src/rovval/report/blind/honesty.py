"""The counts that targets are set for, and what the stated probabilities are worth, in words for page and terminal."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rovval.blind.scoring.outcomes import WORDS
from rovval.report.common.numbers import MISSING

Row = Mapping[str, Any]


def _share(number: Row) -> tuple[str, str]:
    """A share and its interval, per cent."""
    if number["value"] is None:
        return MISSING, MISSING
    return f"{100 * number['value']:.0f} %", f"{100 * number['low']:.0f} to {100 * number['high']:.0f} %"


def _number(value: float | None) -> str:
    return MISSING if value is None else f"{value:.3f}"


def counts(summed: Row) -> list[list[str]]:
    """Rows of words, share, interval, logs."""
    return [[WORDS[name], *_share(number), str(number["n"])] for name, number in summed["counts"].items()]


def bins(summed: Row) -> list[list[str]]:
    """Rows of the reliability table: bounds, logs, mean stated, share right, interval."""
    rows = summed["reliability"].get("bins", [])
    return [[f"{row['low']:g} to {row['high']:g}", str(row["n"]), f"{row['stated']:.2f}", *_share(row["right"])] for row in rows]


def scores(summed: Row) -> dict[str, str]:
    """The single numbers."""
    r = summed["reliability"]
    if not r["n"]:
        return {}
    slope = r["slope"]
    return {
        "Brier score": _number(r["brier"]),
        "expected calibration error": _number(r["calibration_error"]),
        "calibration slope": MISSING if slope is None else f"{slope['value']:.2f} ({slope['low']:.2f} to {slope['high']:.2f})",
        "log score": _number(r["log_score"]),
        "log score of a constant probability": _number(r["constant_log_score"]),
        "nearer to none lost, by a share of": _number(r["skill"]),
        "the same of healthy, causes and something else": _number((r.get("kinds_together") or {}).get("skill")),
    }


def lead(summed: Row) -> str:
    """Which logs are counted."""
    r = summed["reliability"]
    out = f"What each answer says first (a cause, healthy, something else, file), of {r['n']} logs with healthy ones and effects that the library lacks."
    return out + f" Left out: {r['not_visible']} with an effect that nobody could see, {r['without_probabilities']} whose answer states no probability."


def effects(summed: Row) -> list[list[str]]:
    """Rows by effect and vehicle; what the library lacks has no name to be found by."""
    return [
        [row["effect"], row["vehicle"], *map(str, (row["logs"], row["visible"], "lacking" if row["lacking"] else row["found"], row["other"], row["silent"]))]
        for row in summed["by_effect"]
    ]


def sums(summed: Row) -> dict[str, Any]:
    """All of it for the page."""
    return {"counts": counts(summed), "bins": bins(summed), "scores": scores(summed), "lead": lead(summed), "effects": effects(summed)}


def lines(summed: Row) -> list[str]:
    """All but the table by effect, as plain text."""
    found = [f"{what:<62}{share:>7}  {interval:<14}{n:>5}" for what, share, interval, n in counts(summed)]
    rows = [f"{stated:<14}{n:>5}{mean:>8}{right:>8}  {interval}" for stated, n, mean, right, interval in bins(summed)]
    head = f"{'stated':<14}{'logs':>5}{'mean':>8}{'right':>8}"
    return [*found, "", lead(summed), head, *rows, *(f"{name}: {value}" for name, value in scores(summed).items())]


def table(summed: Row) -> list[str]:
    """The table by effect as plain text."""
    head = ["effect", "vehicle", "logs", "visible", "found", "other", "silent"]
    return ["".join(f"{cell:<24}" if i < 2 else f"{cell:>9}" for i, cell in enumerate(row)).rstrip() for row in [head, *effects(summed)]]


def wrong(summed: Row) -> list[str]:
    """The wrong logs, each with what was said and the probability printed."""
    return [
        f"{row['set']}/{row['log']}  {row['kind']}: {', '.join(row['truth']) or 'nothing'}{'' if row['visible'] else ' (not visible)'} -> "
        f"{row['said']} at {MISSING if row['probability'] is None else format(row['probability'], '.2f')}"
        for row in summed["wrong"]
    ]
