"""Row stamps as logged -> strictly increasing stamps and which rows they belong to; every row moved or dropped is a finding.

A row that is late and fits into a hole left for it was swapped: it is sorted in; so are whole blocks, where each fits to the sample between
those around it. A few rows whose stamps stand far from their
neighbours carry a bad stamp: dropped. Stamps that go back and run on through times already logged are a clock that was
stepped back: those rows keep their spacing and follow one period after the last row. A step forward cannot be told from a
pause of the recording and stays the gap that the stamps say.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rovval.core.counts import counted
from rovval.core.data import Array
from rovval.core.errors import BadInput, Finding
from rovval.ingest.table.text_table import first_few

SLIP_ROWS = 10  # rows: more than these behind or ahead are not a slip of one message
STEPS, STEP_SHARE = 3, 0.01  # a clock is stepped back now and then, hardly ever more often than both of these
DAY_S = 86400.0
Index = NDArray[np.int64]


def time_of_day(columns: list[Array]) -> Array:
    """Seconds of hour, minute, second and perhaps millisecond columns, carried on over midnight."""
    scale = (3600.0, 60.0, 1.0, 1e-3)
    seconds = np.sum([c * s for c, s in zip(columns, scale, strict=False)], axis=0)
    for column, top in zip(columns, (24, 60, 61, 1000), strict=False):
        seconds[(column < 0) | (column >= top)] = np.nan
    return over_midnight(seconds)


def over_midnight(seconds: Array) -> Array:
    """Seconds since midnight (n,), carried on over it; NaN stays."""
    out, known = np.array(seconds, dtype=float), np.isfinite(seconds)
    out[known] = np.unwrap(out[known], period=DAY_S)
    return out


def increasing_stamps(t: Array, lines: Index, where: str) -> tuple[Index, Array, tuple[Finding, ...]]:
    """Rows to keep in order, and their stamps (s). ``lines`` are the rows' numbers in the file.

    Raises `BadInput` when fewer than two stamps are left, or when most rows share a stamp with another.
    """
    rows = np.flatnonzero(np.isfinite(t))
    findings = []
    if len(rows) < len(t):
        lost = lines[~np.isfinite(t)]
        findings.append(Finding("bad_stamp", where, f"{counted(len(lost), 'row')} without a readable stamp ({first_few(lost.tolist())}); dropped"))
    t = np.array(t[rows], dtype=float)
    if len(t) and (np.diff(t) < 0).any():
        t, kept, found = _backwards(t, lines[rows], where)
        findings += found
        rows, t = rows[kept], t[kept]
    order = np.argsort(t, kind="stable")
    rows, t = rows[order], t[order]
    first = np.diff(t, prepend=-np.inf) > 0
    if len(t) > 2 and first.sum() < 0.5 * len(t):
        raise BadInput(f"{where}: {len(t)} rows share {first.sum()} stamps; they are too coarse", "export the stamps with milliseconds")
    if not first.all():
        same = lines[rows[~first]]
        findings.append(Finding("duplicate_stamp", where, f"{counted(len(same), 'repeated stamp')} ({first_few(same.tolist())}); the first row is kept"))
    if first.sum() < 2:
        raise BadInput(f"{where}: {first.sum()} rows with a readable stamp; a log needs at least 2", "is this the whole file?")
    return rows[first], t[first], tuple(findings)


def _backwards(t: Array, lines: Index, where: str) -> tuple[Array, NDArray[np.bool_], list[Finding]]:
    """Deal with each place where stamps go back: returns the stamps, which rows to keep, and what was done."""
    forward = np.diff(t)
    period = float(np.median(forward[forward > 0])) if (forward > 0).any() else 1.0
    if not _collides(t, period):
        late = lines[np.flatnonzero(t < np.maximum.accumulate(t))]
        return t, np.ones(len(t), bool), [Finding("swapped_row", where, f"{counted(len(late), 'row')} late ({first_few(late.tolist())}); sorted")]
    if _seamless(t, period):
        begin = lines[np.flatnonzero(forward < 0) + 1]
        detail = f"blocks of rows stand in another order than their stamps ({first_few(begin.tolist())}), which follow one another to the sample; sorted"
        return t, np.ones(len(t), bool), [Finding("swapped_block", where, detail)]
    keep = np.ones(len(t), bool)
    bad: list[int] = []
    late_rows: list[int] = []
    span = float(np.ptp(t))
    steps: list[tuple[int, float]] = []
    findings = []
    for k in np.flatnonzero(forward < 0):
        if not keep[k] or t[k + 1] >= (top := t[: k + 1][keep[: k + 1]].max()):
            continue
        ahead = np.flatnonzero(keep[: k + 1] & (t[: k + 1] >= t[k + 1]))
        reach = np.flatnonzero(t[k + 1 :] >= top)
        behind = int(reach[0]) if len(reach) else len(t) - k - 1
        if len(ahead) <= SLIP_ROWS and len(ahead) < behind:
            keep[ahead] = False
            bad += lines[ahead].tolist()
        elif behind <= SLIP_ROWS and _in_holes(t[: k + 1][keep[: k + 1]], t[k + 1 : k + 1 + behind], period):
            late_rows += lines[k + 1 : k + 1 + behind].tolist()
        elif behind <= SLIP_ROWS and (len(reach) == 0 or t[k + 1 + behind] - t[k] > (0.5 * behind + 1) * period):
            keep[k + 1 : k + 1 + behind] = False
            bad += lines[k + 1 : k + 1 + behind].tolist()
        else:
            by = top + period - t[k + 1]
            t[k + 1 :] += by
            steps.append((int(lines[k + 1]), float(by)))
    findings += _stepped(steps, len(t), period, span, where)
    if bad:
        findings.append(Finding("bad_stamp", where, f"{counted(len(bad), 'row')} stamped far from the neighbours ({first_few(bad)}); dropped"))
    if late_rows:
        findings.append(Finding("swapped_row", where, f"{counted(len(late_rows), 'row')} late ({first_few(late_rows)}); sorted"))
    return t, keep, findings


def _stepped(steps: list[tuple[int, float]], rows: int, period: float, span: float, where: str) -> list[Finding]:
    """A finding for each step back of the clock. Raises `BadInput` where they are so many and so large that it is no clock."""
    back = sum(by for _, by in steps)
    if len(steps) > max(STEPS, STEP_SHARE * rows) and back > span:
        raise BadInput(
            f"{where}: the stamps go back {counted(len(steps), 'time')} in {rows} rows ({first_few([line for line, _ in steps])}), by {back:.0f} s in all "
            f"where they span {span:.0f} s: this is no clock that was set back, the rows are in no order of time",
            "sort the rows by time, split logs that were joined, or is time another column than the profile says?",
        )
    told = "the clock goes back by {:.3f} s; the rows after it follow one period ({:.3f} s) later"
    return [Finding("clock_step", f"{where} line {line}", told.format(by, period)) for line, by in steps]


def _collides(t: Array, period: float) -> bool:
    """Whether sorting would interleave stretches that overlap in time, instead of putting rows back into their holes.

    A swap is near its place: a stretch of the file that has to move by more than a few rows is no swap.
    """
    order = np.argsort(t, kind="stable")
    stretch = np.cumsum(np.diff(t, prepend=t[0]) < 0)[order]
    close = np.diff(t[order]) < 0.6 * period
    far = np.abs(order - np.arange(len(t))).max() > SLIP_ROWS
    return bool(far or (close & (np.diff(stretch) != 0)).any())


def _seamless(t: Array, period: float) -> bool:
    """Whether, sorted, blocks of rows follow one another without overlap and without a gap, wherever one meets another.

    A clock that was set back and forth would have to land on its old beat to the sample, twice.
    """
    steps = np.diff(t)
    block = np.concatenate(([0], np.cumsum((steps < 0) | (steps > 1.5 * period))))
    order = np.argsort(t, kind="stable")
    apart, onwards = np.diff(t[order]), np.diff(block[order])
    apart, onwards = apart[onwards != 0], onwards[onwards != 0]
    moved = apart[onwards != 1]  # what follows in the file as well may follow after a pause
    return bool((steps < 0).sum() <= STEPS and len(moved) and (apart > 0.6 * period).all() and (moved < 1.5 * period).all())


def _in_holes(before: Array, late: Array, period: float) -> bool:
    ordered = np.sort(before)
    at = np.searchsorted(ordered, late)
    inside = (at > 0) & (at < len(ordered))
    at = np.clip(at, 1, len(ordered) - 1)
    return bool((inside & (ordered[at] - ordered[at - 1] > 1.5 * period)).all())
