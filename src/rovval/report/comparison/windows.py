"""The restarted windows in words: as long as was asked for, or as the log allows."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Comparison


def longest_s(c: Comparison) -> float:
    """Length of the longest window (s): the one asked for, or less where no unbroken stretch of log and simulation is as long."""
    rows = int(np.bincount(c.sim.windowed.stretch[c.sim.windowed.stretch >= 0], minlength=1).max())
    whole = rows * c.run.dt > c.sim.window_s - 1.5 * c.run.dt
    return c.sim.window_s if whole or not rows else (rows - 1) * c.run.dt


def label(c: Comparison) -> str:
    """windows of 10 s; windows of at most 4.9 s; one window of 4.9 s."""
    length, asked = longest_s(c), c.sim.window_s
    if length == asked:
        return f"windows of {asked:g} s"
    many = len(np.unique(c.sim.windowed.stretch[c.sim.windowed.stretch >= 0])) > 1
    return f"{'windows of at most' if many else 'one window of'} {length:.3g} s"


def shortened(c: Comparison) -> str:
    """What was done where windows of the length asked for do not fit; empty where they do."""
    length, asked = longest_s(c), c.sim.window_s
    if length == asked:
        return ""
    if c.run.duration_s < asked:
        return f"This log is shorter than a window of {asked:g} s: it is simulated in {label(c)}, restarted from the measured state."
    return f"No unbroken stretch is as long as a window of {asked:g} s: it is simulated in {label(c)}."
