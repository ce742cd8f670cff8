"""Questions that checks and alignment both ask of one channel: which samples are absurd, where does it stand still."""

from __future__ import annotations

import numpy as np

from rovval.core.channels import channel
from rovval.core.counts import counted
from rovval.core.data import Codes, RawLog, Reason, Series
from rovval.core.errors import Finding

STEPS_BRIDGED = 1.5  # of a slow channel's own period: its neighbours are joined, a lost sample is not made up
SLOWEST_BRIDGED_S = 2.0  # period (s): a slower channel passes over the motion of an ROV, whose time constants are 2 to 3 s


def longest_bridge(raw: RawLog, name: str) -> tuple[float, bool]:
    """Longest gap of a channel that is interpolated over (s), and whether it follows from the channel's own rate.

    The profile's limit, else the channel table's; where a channel is logged more slowly than the table's limit allows, one and a half of its
    periods, as long as these are no longer than `SLOWEST_BRIDGED_S`.
    """
    rule = raw.rules.get(name)
    if rule is not None and rule.longest_gap_s is not None:
        return rule.longest_gap_s, False
    table, t = channel(name).longest_gap_s, raw.channels[name].t
    period = float(np.median(np.diff(t))) if len(t) > 2 else 0.0
    own = STEPS_BRIDGED * period
    return (own, True) if own > table and period <= SLOWEST_BRIDGED_S * 1.01 else (table, False)


def still_runs(series: Series, longer_than_s: float) -> list[tuple[int, int]]:
    """Runs (first, last index) of equal values that last longer than ``longer_than_s`` (s)."""
    change = np.flatnonzero(np.diff(series.values) != 0.0)
    first = np.concatenate(([0], change + 1))
    last = np.concatenate((change, [len(series.values) - 1])) if len(series.values) else first[:0]
    first = first[: len(last)]
    long = series.t[last] - series.t[first] > longer_than_s
    return list(zip(first[long].tolist(), last[long].tolist(), strict=True))


def bad_samples(name: str, series: Series, stuck_s: float | None) -> tuple[Codes, tuple[Finding, ...]]:
    """Per sample 0 or the `Reason` to mask it: outside the channel's sane range, or in a still run where the profile says so."""
    row = channel(name)
    code = np.zeros(len(series.t), dtype=np.uint8)
    findings = []
    if stuck_s is not None:
        runs = still_runs(series, stuck_s)
        for first, last in runs:
            code[first : last + 1] = Reason.STUCK
        if runs:
            detail = f"{counted(len(runs), 'run')} of equal values longer than {stuck_s:g} s, from t = {series.t[runs[0][0]]:.1f} s; masked"
            findings.append(Finding("stuck", name, detail))
    outside, most = series.outside(row), series.mostly_outside(row)
    code[outside | most] = Reason.OUT_OF_RANGE
    if outside.any():
        low, high = series.values[outside].min(), series.values[outside].max()
        detail = (
            f"{outside.sum()} samples outside {row.low:g} to {row.high:g} {row.unit} ({low:.4g} to {high:.4g}), "
            f"from t = {series.t[outside][0]:.1f} s; "
            + (f"{100 * outside.mean():.0f} % of the channel, so all of it is masked: is its unit right in the profile?" if most else "masked")
        )
        findings.append(Finding("out_of_range", name, detail))
    return code, tuple(findings)
