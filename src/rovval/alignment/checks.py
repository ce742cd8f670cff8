"""What a reader of any result should know about a log: every finding at once, none raised."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from rovval.alignment.attitude_unit import attitude_in_radians
from rovval.alignment.kinematics import level_pose_against_velocities, pose_against_velocities
from rovval.alignment.series import bad_samples, longest_bridge, still_runs
from rovval.alignment.thruster_commands import against_commands
from rovval.core.channels import HELD, channel
from rovval.core.counts import counted
from rovval.core.data import RawLog, Series
from rovval.core.errors import Finding, merged

STUCK_S = 3.0  # a living sensor does not repeat itself to the last digit for so long, unless the vehicle rests
SENSORS = ("u", "v", "w", "p", "q", "r", "x", "y", "z", "phi", "theta", "psi", "udot", "vdot", "wdot", "altitude")
COMMANDS = ("n", "n_cmd", "pwm", "stick")


def check(raw: RawLog) -> tuple[Finding, ...]:
    """Gaps, stuck channels, absurd values, changes of rate, and kinematic identities with the wrong sign or scale."""
    found: list[Finding] = []
    for name, series in raw.channels.items():
        found += _gaps(raw, name, series)
        found += _stuck(raw, name, series)
        found += bad_samples(name, series, None)[1]
        found += _rate(name, series)
        found += _commands_absent(raw, name, series)
    return (
        *merged(found), *pose_against_velocities(raw), *level_pose_against_velocities(raw), *attitude_in_radians(raw),
        *merged(list(against_commands(raw))),
    )


def _gaps(raw: RawLog, name: str, series: Series) -> list[Finding]:
    limit, own = longest_bridge(raw, name)
    steps = np.diff(series.t)
    slow = [_slow(name, float(np.median(steps)), limit)] if own else []
    wide = np.flatnonzero(steps > limit + 1e-6)
    if not len(wide):
        return slow
    longest = wide[np.argmax(steps[wide])]
    found = f"{len(wide)} gaps longer than {limit:g} s, {steps[wide].sum():.1f} s in all; the longest" if len(wide) > 1 else "a gap of"
    return [*slow, Finding("gap", name, f"{found} {steps[longest]:.2f} s from t = {series.t[longest]:.1f} s; not bridged")]


def _slow(name: str, period_s: float, limit_s: float) -> Finding:
    """What a reader must know of a channel that is bridged over its own period instead of the channel table's limit."""
    detail = (
        f"logged every {period_s:.3g} s, so that up to {limit_s:.3g} s are interpolated over instead of {channel(name).longest_gap_s:g} s; "
        f"motion quicker than {2 * period_s:.3g} s does not show in it"
    )
    return Finding("slow_channel", name, detail)


def _commands_absent(raw: RawLog, name: str, series: Series) -> list[Finding]:
    """A stream of commands that begins after or ends before what the sensors logged: without it there is nothing to simulate by."""
    if name.partition(":")[0] not in COMMANDS:
        return []
    first, last = min(float(s.t[0]) for s in raw.channels.values()), max(float(s.t[-1]) for s in raw.channels.values())
    rule, table = raw.rules.get(name), channel(name)
    held = rule.longest_gap_s if rule and rule.longest_gap_s and (rule.resampling or table.resampling) in HELD else 0.0
    late, early = float(series.t[0]) - first, last - float(series.t[-1])
    said = [f"begins {late:.1f} s after the log"] if late > table.longest_gap_s else []
    if early > table.longest_gap_s:
        keeps = f" (its last value is held for {min(held, early):.1f} s, longest_gap_s of the profile)" if held else ""
        said.append(f"ends {early:.1f} s before it{keeps}" if said else f"ends {early:.1f} s before the log{keeps}")
    return [Finding("short", name, " and ".join(said) + "; missing there, so nothing is simulated")] if said else []


def _stuck(raw: RawLog, name: str, series: Series) -> list[Finding]:
    rule = raw.rules.get(name)
    if name.partition(":")[0] not in SENSORS or (rule is not None and rule.stuck_s is not None):
        return []
    if np.ptp(series.values) == 0.0:
        return [Finding("constant", name, f"holds {series.values[0]:.6g} {channel(name).unit} throughout")] if len(series.t) > 1 else []
    runs = still_runs(series, STUCK_S)
    if not runs or _coarse(series, runs):
        return []
    first, last = max(runs, key=lambda run: series.t[run[1]] - series.t[run[0]])
    detail = (
        f"{counted(len(runs), 'run')} of equal values longer than {STUCK_S:g} s; the longest {series.t[last] - series.t[first]:.1f} s "
        f"from t = {series.t[first]:.1f} s; not masked (declare stuck_s in the profile to mask)"
    )
    return [Finding("stuck", name, detail)]


def _coarse(series: Series, runs: list[tuple[int, int]]) -> bool:
    """Whether the channel repeats itself outside its long runs as well, as a sensor of coarse steps does."""
    outside = np.ones(len(series.t) - 1, dtype=bool)
    for first, last in runs:
        outside[max(first - 1, 0) : last + 1] = False
    repeats = np.diff(series.values) == 0.0
    return bool(outside.sum() < 10 or repeats[outside].mean() > 0.3)


def _rate(name: str, series: Series) -> list[Finding]:
    """A rate that changes by half and stays so, between tenths of the log."""
    if len(series.t) < 200:
        return []
    periods = [float(np.median(part)) for part in np.array_split(np.diff(series.t), 10)]
    changes = [(i, a, b) for i, (a, b) in enumerate(pairwise(periods)) if max(a, b) > 1.5 * min(a, b)]
    if not changes:
        return []
    i, a, b = changes[0]
    at = series.t[(i + 1) * len(series.t) // 10]
    return [Finding("rate_change", name, f"from {1 / a:.3g} to {1 / b:.3g} Hz near t = {at:.0f} s")]
