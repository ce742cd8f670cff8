"""What flows through rovval is checked when it is made, says what is missing, and cannot be changed afterwards."""

from __future__ import annotations

from dataclasses import FrozenInstanceError

import numpy as np
import pytest
from report_cases import make_run, make_sim

from rovval.core.data import RawLog, Reason, Run, Series
from rovval.core.errors import BadInput, UsageProblem


def raw(**channels: Series) -> RawLog:
    return RawLog("x/dive.csv", "ab" * 32, "test", "", None, channels)


def test_what_is_missing_is_nan_in_its_values_and_false_in_its_mask():
    run = make_run(200, absent=("v",), holes={"u": slice(50, 60)})
    assert np.isnan(run.get("u")[50:60]).all() and not run.ok("u")[50:60].any() and run.ok("u").sum() == 190
    assert np.isnan(run.get("v")).all() and not run.ok("v").any() and not run.measured("v")
    np.testing.assert_array_equal(run.stack(("u", "v")), np.stack([run.get("u"), run.get("v")], axis=1))
    assert run.duration_s == pytest.approx(19.9) and len(run.t) == len(run) == 200


def test_no_array_and_no_field_can_be_changed_in_place():
    run, given = make_run(50), np.arange(5.0)
    series, sim = Series(np.arange(5.0), given, "row"), make_sim(run)
    for array in (run.get("u"), run.reasons["u"], series.t, series.values, sim.thrust, sim.free.nu, sim.windowed.stretch):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    with pytest.raises(FrozenInstanceError):
        run.dt = 1.0  # type: ignore[misc]
    with pytest.raises(TypeError):
        run.values["u"] = given  # type: ignore[index]
    given[0] = 9.0
    assert series.values[0] == 0.0, "a copy is kept, not the caller's array"


@pytest.mark.parametrize(
    ("t", "values", "words"),
    [
        ([0.0, 1.0], [1.0], "values at"),
        ([0.0, 0.0], [1.0, 2.0], "strictly increasing"),
        ([1.0, 0.0], [1.0, 2.0], "strictly increasing"),
        ([0.0, 1.0], [1.0, np.nan], "finite"),
    ],
)
def test_a_series_that_is_none_is_refused(t, values, words):
    with pytest.raises(BadInput, match=words):
        Series(np.array(t), np.array(values), "row")


def test_a_log_of_no_channel_or_of_an_unknown_one_is_refused():
    with pytest.raises(BadInput, match="no channel of profile 'test'"):
        raw()
    with pytest.raises(UsageProblem, match="unknown channel 'speed'"):
        raw(speed=Series(np.arange(3.0), np.arange(3.0), "row"))


def test_channels_of_unequal_length_or_without_a_mask_are_no_run():
    run = make_run(20)

    def like(values, reasons):
        return Run(run.id, "", "", "", "merlin", None, 0.1, values, reasons, {}, run.clock)

    fine = np.zeros(20, np.uint8)
    for values, reasons in (({"u": np.zeros(20)}, {"u": fine[:-1]}), ({"u": np.zeros(20)}, {"v": fine})):
        with pytest.raises(BadInput, match="unequal length or without mask"):
            like(values, reasons)
    assert np.isnan(like({"u": np.zeros(20)}, {"u": fine + Reason.GAP}).get("u")).all(), "under the mask no value is left to be read"
