"""Conditioning: samples at a sensor's stop and values held between pings are no measurements; healthy logs are left as they are."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import merlin, own, with_values

from rovval.core.data import Run
from rovval.diagnose import diagnose
from rovval.diagnose.windows.conditioning import condition, ping_period, saturated
from rovval.report.diagnosis.json import document as written


def held(run: Run, every: int, step: float = 0.0) -> Run:
    """The run with its velocities new at every ``every``-th sample only, in steps of ``step`` m/s."""
    rows = np.arange(len(run)) // every * every
    new = {c: run.get(c)[rows] for c in "uvw"}
    return with_values(run, **{c: np.round(x / step) * step if step else x for c, x in new.items()})


def test_a_healthy_log_is_left_as_it_is():
    run = own((), 5, 100.0)
    assert condition(run) == (run, ())
    coarse = with_values(run, **{c: np.round(run.get(c), 2) for c in "uvwpqr"})
    assert condition(coarse)[1] == (), "written in steps, and at rest now and then, is not held"


@pytest.mark.parametrize("noise", [0.0, 1.0])
def test_a_steady_speed_is_no_stop(noise: float):
    t = np.arange(3000) * 0.1
    speed = 0.8 * np.tanh(5.0 * np.sin(0.05 * t)) + noise * 0.004 * np.random.default_rng(0).normal(size=len(t))
    assert not saturated(np.round(speed, 4), 1e-3).any()


def test_a_rate_that_clips_is_masked_where_it_does_and_said():
    run = own((), 5, 100.0)
    r, limit = run.get("r"), 0.6 * np.nanmax(run.get("r"))
    clipped = np.minimum(r, limit)
    mended, (finding,) = condition(with_values(run, r=clipped))
    assert (np.isnan(mended.get("r")) == (clipped == limit)).all() and np.isnan(mended.get("r")).any()
    assert finding.code == "saturated" and finding.where == "r" and f"{limit:.4g}" in finding.detail
    assert np.array_equal(mended.get("u"), run.get("u"))


def test_a_rate_that_clips_both_ways_for_most_of_the_time_is_seen():
    t = np.arange(3000) * 0.1
    clipped = np.clip(0.3 * np.sin(0.3 * t) + 0.0013 * np.random.default_rng(0).normal(size=len(t)), -0.08, 0.064)
    assert (saturated(clipped, 1e-3) == ((clipped == -0.08) | (clipped == 0.064))).all()


@pytest.mark.parametrize(("every", "most"), [(2, 1.0), (5, 0.5), (8, 0.5)])
def test_held_velocities_are_drawn_between_pings(every: int, most: float):
    """The error by holding falls to half; of pings only two samples apart, which are hardly held, it does not grow."""
    run = own((), 5, 100.0)
    mended, (finding,) = condition(held(run, every))
    at = np.arange(0, len(run) - every, every)
    assert finding.code == "held" and finding.where == "u, v, w"
    assert np.array_equal(mended.get("u")[at], run.get("u")[at]), "a ping is what it was"
    assert mended.resampled["u"].period_s == pytest.approx(0.1 * every)
    truth = own((), 5, 100.0, noise=0.0).get("u")
    assert np.abs(mended.get("u") - truth).mean() < most * np.abs(held(run, every).get("u") - truth).mean()


def test_commands_that_repeat_and_a_vehicle_at_rest_are_no_pings():
    rng = np.random.default_rng(1)
    resting = np.round(0.004 * rng.normal(size=(2000, 3)), 2)
    assert ping_period(resting) == (1, 0)


@pytest.mark.slow
@pytest.mark.parametrize(("effects", "verdict"), [((), "no_gap"), (("thruster_degraded[HFP]:loss=0.5",), "explained")])
def test_held_velocities_are_no_filter_and_hide_no_cause(effects: tuple[str, ...], verdict: str):
    document = written(diagnose([held(own(effects, 5, 160.0), 8, 0.02)], merlin()))
    assert document["sentence"].endswith("Of the log: u, v, w hold their values between pings, a new one every 0.8 s, and were drawn between these.")
    assert [row["finding"] for row in document["log"]] == ["held"]
    assert document["verdict"] == verdict
    assert [c["effect"] for c in document["causes"]] == [e.partition(":")[0] for e in effects]
