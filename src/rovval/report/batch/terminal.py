"""What a batch did, in a few lines for a terminal."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rovval.report.common.numbers import duration
from rovval.report.common.terminal import fitted


def reasons(why: Mapping[str, int]) -> str:
    """Why there was something to do: 9 made by other code of rovval, 3 new. Empty where there was nothing."""
    return ", ".join(f"{count} {reason}" for reason, count in why.items())


def text(summary: Mapping[str, Any]) -> str:
    """The summary in a few lines."""
    counts = summary["counts"]
    lines = [
        f"{summary['pipeline']}: "
        + ", ".join(f"{n} {what.replace('_', ' ')}" for what, n in counts.items())
        + f" in {duration(summary['seconds'])}"
    ]
    lines += [f"  to do were   {reasons(summary['why'])}"] if summary["why"] else []
    lines += [f"  no log       {row['logs']}: {row['why']}" for row in summary["missing_sources"]]
    lines += [f"  quarantined  {row['log']}: {row['reason'].removeprefix(row['log'] + ': ')}" for row in summary["quarantined"]]
    lines += [f"  exceeded     {row['log']}: {row['limit']}" for row in summary["tolerances_exceeded"]]
    lines += [f"  left limits  {row['log']}: {row['stops'][0]}" for row in summary["left_sane_limits"]]
    lines += [f"  damaged      {what}" for what in summary.get("damaged", ())]
    lines += [f"  waiting      {row['log']}: {row['why']}" for row in summary["waiting"]]
    return fitted("\n".join(lines))
