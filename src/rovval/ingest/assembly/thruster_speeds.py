"""What telemetry of shaft speeds is known to get wrong: a sign that is not logged, and single values that no shaft can reach."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.core.channels import members
from rovval.core.data import Array, Flags, Series
from rovval.core.errors import BadInput, Finding, all_at_once
from rovval.ingest.profile import Profile

NEUTRAL_US = 1500.0  # us: pulse width of no thrust, by convention of RC servos (ArduSub's SERVOn_TRIM)
SPIKE_SAMPLES = 2  # a fault of telemetry spoils one message, or two
SPIKE_S = 0.5  # s: a shaft of some 0.1 s of lag may go to a speed and come back in more than this
SPIKE_TIMES, ANY_TIMES = 3.0, 10.0  # times what the thruster turns at in all but `MOST_SPIKES` of the log: within `SPIKE_S`, however slow the log
MOST_SPIKES = 0.05  # share of a channel: more than this is how the thruster was driven


def signed_by_command(profile: Profile, series: Mapping[str, Series]) -> tuple[dict[str, Series], list[Finding]]:
    """Speeds whose sign is not logged (``sign_from`` in the profile), with that of the thruster's command; and a finding of it.

    The command holds until the next one; where it asks for no thrust, or has not begun, the shaft coasts with the sign that it had.

    Raises:
        BadInput: names every thruster whose command is not in the log.
    """
    out, done, gone = dict(series), [], []
    for name in series:
        source = profile.source_of(name)
        family = source.sign_from if source else None
        if family is None:
            continue
        command = series.get(f"{family}:{name.partition(':')[2]}")
        if command is None:
            gone.append(f"{name} takes its sign from {family}:{name.partition(':')[2]}, which this log does not hold")
            continue
        out[name] = replace(series[name], values=np.abs(series[name].values) * _signs(command, family, series[name].t))
        done.append(name)
    if gone:
        raise BadInput(all_at_once(gone, "thruster speeds without sign"), "map the command in the profile, or give a log that holds it")
    detail = "speed logged without sign; it has the sign of its command, which a shaft follows some 0.1 s later"
    return out, [Finding("sign_from_command", ", ".join(done), detail)] if done else []


def _signs(command: Series, family: str, t: Array) -> Array:
    """Sign of the last command that was not neutral, at ``t`` (n,); of the first one before that; 1 where there is none."""
    sign = np.sign(command.values - (NEUTRAL_US if family == "pwm" else 0.0))
    driving = np.flatnonzero(sign)
    if not len(driving):
        return np.ones(len(t))
    at = np.clip(np.searchsorted(command.t[driving], t, "right") - 1, 0, None)
    return np.asarray(sign[driving][at])


def without_spikes(series: Mapping[str, Series]) -> tuple[dict[str, Series], list[Finding]]:
    """Speeds without single values that no shaft reaches and leaves so quickly (9999 rpm), and a finding of each thruster's."""
    out, found = dict(series), []
    for name in (f"n:{m}" for m in members(tuple(series), "n")):
        s = series[name]
        spike = _spikes(s)
        if not spike.any():
            continue
        detail = (
            f"{spike.sum()} values of up to {np.abs(s.values[spike]).max() * 60:.4g} rpm, no more than {SPIKE_SAMPLES} in a row, where the thruster "
            f"otherwise turns at up to {np.abs(s.values[~spike]).max() * 60:.4g} rpm, from t = {s.t[spike][0]:.1f} s; dropped"
        )
        found.append(Finding("speed_spike", name, detail))
        out[name] = Series(s.t[~spike], s.values[~spike], s.stamp)
    return out, found


def _spikes(series: Series) -> Flags:
    """Short runs of values far above what the thruster turns at otherwise (n,)."""
    size, t = np.abs(series.values), series.t
    usual = float(np.quantile(size, 1.0 - MOST_SPIKES))
    spike = np.zeros(len(size), dtype=bool)
    if usual == 0.0:
        return spike
    high = np.concatenate(([False], size > SPIKE_TIMES * usual, [False])).astype(np.int8)
    edges = np.flatnonzero(np.diff(high))
    for first, end in zip(edges[::2], edges[1::2], strict=True):
        seconds = t[min(end, len(t) - 1)] - t[max(first - 1, 0)]
        if end - first <= SPIKE_SAMPLES and (seconds <= SPIKE_S or size[first:end].min() > ANY_TIMES * usual):
            spike[first:end] = True
    return spike
