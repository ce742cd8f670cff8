"""A test scenario to be read in a terminal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rovval.fly.scenarios import Outcome
from rovval.report.common.terminal import fitted
from rovval.report.comparison import terminal

SIGNS = {True: "pass", False: "FAIL", None: "-"}


def text(outcome: Outcome) -> str:
    """Each expectation and whether it holds, then what was compared or which channels the log holds."""
    head = f"Scenario {outcome.number}: {outcome.title} ({outcome.vehicle}{', ' + outcome.model if outcome.model else ''})"
    lines = [f"  {SIGNS[c.holds]:<4}  {c.expected}: {c.seen}" for c in outcome.checks]
    lines += [terminal.text(outcome.comparison)] if outcome.comparison else []
    lines += _channels(outcome.document.get("channels") or ())
    return fitted("\n".join([head, *lines, "passed" if outcome.passed else "NOT passed"]))


def _channels(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """The range of each channel that was measured."""
    lines = [f"  {r['channel']:<12} {r['unit']:<6} {r['low']:>12.5g} {r['high']:>12.5g}  {100 * r['coverage']:.1f}%" for r in rows if r["n"]]
    return ["  channel      unit        lowest      highest  coverage", *lines] if rows else []
