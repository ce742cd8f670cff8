"""A stretch of a run: the same samples, on their own clock, and said; times beyond the log are refused."""

from __future__ import annotations

import numpy as np
import pytest

from rovval.alignment import align
from rovval.alignment.stretch import stretch_of
from rovval.core.data import RawLog, Run, Series
from rovval.core.errors import BadInput, UsageProblem

T0_NS = 1_700_000_000_000_000_000


def whole() -> Run:
    t = np.linspace(0.0, 30.0, 301)
    late = t[200:]
    channels = {"u": Series(t, 0.1 * t, "row"), "n:A": Series(late, np.ones(len(late)), "row")}
    return align(RawLog("x/dive.csv", "ab" * 32, "test", "", T0_NS, channels))


def test_a_stretch_is_the_same_samples_on_its_own_clock():
    run = whole()
    cut = stretch_of(run, 12.0, 25.0)
    assert np.array_equal(cut.values["u"], run.values["u"][120:251]) and cut.t[0] == 0.0 and cut.duration_s == 13.0
    assert cut.t0_ns == T0_NS + 12 * 10**9 and float(cut.properties["grid_start_s"]) == 12.0
    assert cut.id == f"{run.id}-from12to25s" and str(cut.findings[0]).startswith("stretch: log: from 12 to 25 s of 30 s; t = 0 is 12 s of the log")
    assert cut.resampled["n:A"].coverage == pytest.approx(51 / 131)


def test_one_end_alone_leaves_the_other():
    run = whole()
    assert len(stretch_of(run, 12.0)) == 181 and len(stretch_of(run, None, 12.0)) == 121
    assert stretch_of(run) is run
    assert not stretch_of(run, None, 12.0).measured("n:A")


@pytest.mark.parametrize(
    ("start_s", "end_s", "error", "words"),
    [
        (12.0, 31.0, BadInput, "beyond the log, which lasts from 0 to 30 s"),
        (-1.0, 12.0, BadInput, "beyond the log"),
        (40.0, 50.0, BadInput, "beyond the log"),
        (40.0, None, BadInput, "stretch from 40 s is beyond the log"),
        (12.0, 12.0, UsageProblem, "the end must come after the start"),
        (float("nan"), 12.0, UsageProblem, "the end must come after the start"),
        (12.01, 12.09, BadInput, "holds less than 2 samples of 0.1 s"),
    ],
)
def test_a_stretch_that_is_not_in_the_log_is_refused(start_s: float, end_s: float | None, error: type[Exception], words: str):
    with pytest.raises(error, match=words):
        stretch_of(whole(), start_s, end_s)


def test_a_stretch_without_any_value_is_refused():
    t = np.concatenate([np.arange(50), np.arange(200, 250)]) * 0.1
    with pytest.raises(BadInput, match="no channel holds a value in the stretch from 8 to 15 s"):
        stretch_of(align(RawLog("x.csv", "ab" * 32, "test", "", None, {"u": Series(t, 0.1 * t, "row")})), 8.0, 15.0)
