"""Alignment: what is on the grid stays to the bit, what is not is resampled by a stated method, and what is missing says why."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rovval.alignment import align
from rovval.alignment.series import longest_bridge
from rovval.core.channels import Rule
from rovval.core.data import RawLog, Reason, Series
from rovval.core.errors import BadInput, UsageProblem
from rovval.core.frames import wrap


def log(rules=None, **channels):
    named = {k.replace("__", ":"): v for k, v in channels.items()}
    return RawLog("x/dive.csv", "ab" * 32, "test", "", None, {n: Series(t, v, "row") for n, (t, v) in named.items()}, rules=rules or {})


def grid(n, dt=0.1, start=0.0):
    return start + np.arange(n) * dt


@pytest.mark.parametrize("jitter", [0.0, 0.02])
def test_a_regular_log_is_unchanged_to_the_bit(jitter):
    rng = np.random.default_rng(3)
    t = grid(600) + rng.uniform(-jitter, jitter, 600)
    values = rng.normal(size=600)
    run = align(log(u=(t, values), psi=(t, values), z=(t, values), n__A=(t, values), n_cmd__A=(t, values)))
    assert len(run) == 600
    for name in ("u", "psi", "z", "n:A", "n_cmd:A"):
        assert run.resampled[name].method == "unchanged"
        assert np.array_equal(run.values[name], values), name
        assert run.ok(name).all()
    assert run.clock.matched == run.clock.samples == 3000


def test_the_grid_starts_on_any_clock_value_without_rounding_away_the_first_sample():
    for start in (0.0, 1234.567, 86399.95):
        run = align(log(z=(grid(50, start=start), np.arange(50.0))))
        assert np.array_equal(run.values["z"], np.arange(50.0))


def test_fast_channels_are_averaged_and_vibration_does_not_alias():
    """A 29.7 Hz vibration sampled at 100 Hz; taking single samples would alias it to 0.3 Hz with its whole size."""
    t = grid(6000, 0.01)
    truth = np.sin(2 * np.pi * 0.2 * t)
    run = align(log(u=(t, truth + 0.2 * np.sin(2 * np.pi * 29.7 * t))))
    inner = slice(1, -1)
    error = run.values["u"][inner] - np.sin(2 * np.pi * 0.2 * run.t[inner])
    assert run.resampled["u"].method == "mean"
    assert np.sqrt(np.mean(error**2)) < 0.03


def test_slow_channels_are_interpolated_between_near_neighbours_only():
    t = np.array([0.0, 0.3, 0.6, 2.0, 2.3])
    run = align(log(u=(t, 2.0 * t)))
    assert run.resampled["u"].method == "linear"
    inside = (run.t <= 0.6 + 1e-9) | (run.t >= 2.0 - 1e-9)
    assert np.allclose(run.values["u"][inside], 2.0 * run.t[inside])
    assert (run.reasons["u"][~inside] == Reason.GAP).all()
    assert np.isnan(run.values["u"][~inside]).all()


def test_nothing_is_extrapolated():
    run = align(log(u=(grid(100), np.ones(100)), z=(grid(40, start=2.0), np.ones(40))))
    assert (run.reasons["z"][:20] == Reason.BEFORE_FIRST).all()
    assert (run.reasons["z"][60:] == Reason.AFTER_LAST).all()
    assert run.ok("z")[20:60].all()


def test_a_command_is_held_and_not_longer_than_allowed():
    t, v = np.array([0.0, 0.43, 0.93, 3.0, 3.5]), np.array([1.0, 2.0, 3.0, 4.0, 5.0])
    run = align(log(u=(grid(36), np.zeros(36)), n_cmd__A=(t, v)))
    held = run.get("n_cmd:A")
    assert held[3] == 1.0 and held[5] == 2.0 and held[8] == 2.0
    assert (run.reasons["n_cmd:A"][10:30] == Reason.GAP).all() and held[30] == 4.0


@given(width=st.sampled_from([1100.0, 1899.7]), steps=st.lists(st.floats(0.004, 0.3), min_size=20, max_size=200), late=st.floats(0.0, 1e5))
@settings(max_examples=60, deadline=None)
def test_a_command_at_the_end_of_its_range_stays_there(width, steps, late):
    """By rounding its mean was 1099.9999999998 us, and a log with saturated thrusters was refused as beyond its table."""
    t = late + np.cumsum(np.array(steps))
    every = np.arange(t[0], t[-1] + 0.1, 0.1)
    held = align(log(u=(every, 0.0 * every), pwm__A=(t, np.where(np.arange(len(t)) % 3, width, 1500.0))))
    ok = held.ok("pwm:A")
    assert (np.minimum(1500.0, width) <= held.get("pwm:A")[ok]).all() and (held.get("pwm:A")[ok] <= np.maximum(1500.0, width)).all()


def test_a_command_between_grid_points_acts_as_long_as_it_did():
    """Held from the grid point before it, a command at 5 Hz of its own clock would act 0.05 s late on average."""
    rng = np.random.default_rng(7)
    t = np.cumsum(rng.uniform(0.15, 0.25, 400))
    v = rng.choice([-1.0, 0.0, 2.0], 400)
    sensor = np.arange(t[0], t[-1], 0.1)
    run = align(log({"n_cmd:B": Rule(resampling="hold")}, u=(sensor, sensor), n_cmd__A=(t, v), n_cmd__B=(t, v)))
    assert run.resampled["n_cmd:A"].method == "hold_mean" and run.resampled["n_cmd:B"].method == "hold"

    def shaft(at, tau=0.3):  # exact answer of a first-order lag to the commands as they came
        n, since, out = v[0], t[0], []
        for when in at:
            for k in np.flatnonzero((t > since) & (t <= when)):
                n, since = v[k - 1] + (n - v[k - 1]) * np.exp(-(t[k] - since) / tau), t[k]
            last = v[np.searchsorted(t, when, "right") - 1]
            n, since = last + (n - last) * np.exp(-(when - since) / tau), when
            out.append(n)
        return np.array(out)

    def driven(held, n, tau=0.3):
        out = []
        for u in held:
            out.append(n)
            n = u + (n - u) * np.exp(-0.1 / tau)
        return np.array(out)

    truth = shaft(run.t[:-3] + float(run.properties["grid_start_s"]))
    mean, last = (np.abs(driven(run.get(f"n_cmd:{x}")[:-3], truth[0]) - truth).mean() for x in "AB")
    assert mean < 0.01 and last > 5.0 * mean, (mean, last)


def test_measured_thruster_speed_is_not_held_late():
    """Feedback at 5 Hz, held, would be 0.1 s late on average: the very effect that a diagnosis looks for."""
    t = grid(200, 0.2)
    run = align(log(n__A=(t, t)))
    assert np.allclose(run.values["n:A"], run.t)


def test_heading_goes_the_short_way_over_north():
    t = grid(101, 0.25)
    truth = np.radians(350) + 0.3 * t
    run = align(log(psi=(t, wrap(truth))))
    assert run.resampled["psi"].method == "circular linear"
    assert np.abs(wrap(run.values["psi"] - (np.radians(350) + 0.3 * run.t))).max() < 1e-9


def test_fast_heading_is_averaged_on_the_circle():
    t = grid(1000, 0.01)
    run = align(log(psi=(t, wrap(np.pi + 0.05 * np.sin(40 * t)))))
    assert run.resampled["psi"].method == "circular mean"
    assert np.abs(wrap(run.values["psi"][1:-1] - np.pi)).max() < 0.06


def test_absurd_values_are_masked_and_not_bridged():
    values = np.ones(100)
    values[40:42] = 1e4
    run = align(log(u=(grid(100), values)))
    assert (run.reasons["u"][40:42] == Reason.OUT_OF_RANGE).all()
    assert run.ok("u").sum() == 98
    assert any(f.code == "out_of_range" and f.where == "u" for f in run.findings)


def test_a_stuck_channel_is_masked_only_where_the_profile_says_so():
    values = np.sin(grid(200))
    values[50:120] = values[50]
    assert align(log(u=(grid(200), values))).ok("u").all()
    run = align(log({"u": Rule(stuck_s=3.0)}, u=(grid(200), values)))
    assert (run.reasons["u"][50:120] == Reason.STUCK).all() and run.ok("u").sum() == 130


def test_methods_and_gaps_of_the_profile_and_of_the_caller():
    t = grid(50, 0.33)
    raw = log({"z": Rule(resampling="hold", longest_gap_s=0.2)}, z=(t, t), u=(t, t))
    run = align(raw)
    assert run.resampled["z"].method == "hold" and (run.reasons["z"] == Reason.GAP).any()
    other = align(raw, methods={"z": "linear", "u": "hold"})
    assert other.resampled["z"].method == "linear" and other.resampled["u"].method == "hold"
    assert other.id != run.id and align(raw).id == run.id


def test_what_cannot_be_aligned_is_refused():
    with pytest.raises(UsageProblem, match=r"unknown method 'spline'"):
        align(log(u=(grid(9), grid(9))), methods={"u": "spline"})
    with pytest.raises(UsageProblem, match="rate"):
        align(log(u=(grid(9), grid(9))), rate_hz=0.0)
    with pytest.raises(BadInput, match="less than two points"):
        align(log(u=(np.array([0.0, 0.01]), np.zeros(2))))
    with pytest.raises(BadInput, match="clock is broken"):
        align(log(u=(np.array([0.0, 1e9]), np.zeros(2))))


def test_an_offset_between_thrusters_and_navigation_is_estimated():
    rng = np.random.default_rng(1)
    n = 3000
    force = np.repeat(rng.uniform(-30, 30, n // 50), 50)
    t, u = grid(n), np.zeros(n)
    for k in range(1, n):
        u[k] = u[k - 1] + 0.1 * (force[k - 1] * abs(force[k - 1]) / 900 - u[k - 1])
    for late in (0.0, 0.6):
        run = align(log(n__A=(t, force), u=(t + late, u)))
        assert run.clock.offset_s == pytest.approx(late + 0.1, abs=0.15), run.clock


def test_no_offset_is_named_where_nothing_correlates():
    rng = np.random.default_rng(2)
    run = align(log(n__A=(grid(2000), rng.normal(size=2000)), u=(grid(2000), rng.normal(size=2000))))
    assert run.clock.offset_s is None and "no offset" in run.clock.note


@settings(max_examples=60, deadline=None)
@given(
    steps=st.lists(st.floats(0.005, 1.5), min_size=4, max_size=80),
    method=st.sampled_from(["mean", "hold", "hold_mean", "circular", "linear"]),
    bad=st.integers(0, 3),
)
def test_every_log_keeps_the_promises(steps, method, bad):
    """Any stamps, any method: values stay within the neighbours' range, gaps stay gaps, NaN and mask agree."""
    t = np.cumsum(np.array(steps))
    if t[-1] - t[0] < 0.2:
        return
    values = np.sin(t)
    values[:bad] = 1e3
    every = np.arange(t[0], t[-1] + 0.1, 0.1)  # the grid's own channel
    raw = log(u=(t, values), z=(every, every * 0))
    run = align(raw, methods={"u": method})
    bridged, _ = longest_bridge(raw, "u")
    ok = run.ok("u")
    assert np.isfinite(run.values["u"][ok]).all() and np.isnan(run.values["u"][~ok]).all()
    assert (np.abs(run.values["u"][ok]) <= 1.0 + 1e-9).all()
    at = float(run.properties["grid_start_s"]) + run.t
    before = np.searchsorted(t, at + 1e-6, "right") - 1
    for i in np.flatnonzero(ok):
        near = np.abs(t - at[i]).min()
        width = t[min(before[i] + 1, len(t) - 1)] - t[max(before[i], 0)]
        assert near <= 0.05 + 1e-6 or (method.startswith("hold") and at[i] > t[-1]) or width <= bridged + 1e-5


@pytest.mark.parametrize(("period", "coverage"), [(0.5, 1.0), (1.0, 1.0), (2.0, 1.0), (2.5, 0.05)])
def test_a_slow_channel_is_bridged_over_its_own_period(period, coverage):
    """A log at 1 Hz was compared on the one row in ten that holds a sample; at 0.4 Hz it says nothing about an ROV."""
    t = np.arange(0, 100, period)
    run = align(log(u=(t, np.sin(0.1 * t)), v=(grid(1000), grid(1000) * 0)))
    assert run.ok("u")[: int(t[-1] * 10)].mean() == pytest.approx(coverage, abs=0.02)
    assert run.resampled["u"].bridged_gap_s == (1.5 * period if 0.5 <= period <= 2.0 else 0.5)


def test_a_lost_sample_of_a_slow_channel_stays_a_gap():
    t = np.delete(np.arange(0, 100, 1.0), 50)
    run = align(log(u=(t, np.sin(0.1 * t)), v=(grid(1000), grid(1000) * 0)))
    assert not run.ok("u")[491:509].any() and run.ok("u")[:490].all()


def test_what_the_profile_says_of_gaps_is_kept_for_a_slow_channel():
    t = np.arange(0, 100, 1.0)
    raw = log({"u": Rule(longest_gap_s=0.7)}, u=(t, np.sin(0.1 * t)), v=(grid(1000), grid(1000) * 0))
    assert align(raw).ok("u").mean() < 0.11


@pytest.mark.parametrize(("rule", "held_to"), [(None, 2.6), (Rule(longest_gap_s=1.0), 3.0)])
def test_a_command_that_ends_early_is_held_as_long_as_the_profile_says_and_then_missing(rule, held_to):
    at = np.array([0.5, 0.9, 1.2, 1.6, 2.0])
    run = align(log({} if rule is None else {"pwm:A": rule}, pwm__A=(at, 1500.0 + 100.0 * at), u=(grid(60), np.ones(60))))
    inside = (run.t > 0.45) & (run.t < held_to + 0.05)
    assert np.array_equal(run.ok("pwm:A"), inside)
    assert run.values["pwm:A"][inside][-1] == 1700.0
    assert run.reasons["pwm:A"][0] == Reason.BEFORE_FIRST and run.reasons["pwm:A"][-1] == Reason.AFTER_LAST
