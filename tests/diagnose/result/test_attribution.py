"""Where the gap lies: regimes that hold more of it than their time, each quantity named once an axis."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnose_case import merlin, own

from rovval.diagnose.result.attribution import Slice, slices, worst
from rovval.diagnose.windows.multiple_shooting import cut_run
from rovval.diagnose.windows.windows import Windows, axis_channels

RNG = np.random.default_rng


def test_slices_of_one_quantity_are_named_once_an_axis():
    def slice_(axis: str, regime: str, share: float) -> Slice:
        return Slice(axis, regime, share, 0.2, share / 0.2, 1.5, 4.0, 9)

    found = [slice_("yaw", "u < -0.3 m/s", 0.6), slice_("yaw", "|u| > 0.3 m/s", 0.7), slice_("sway", "|u| > 0.3 m/s", 0.5), slice_("yaw", "depth > 3 m", 0.4)]
    named = [(s.axis, s.regime) for s in worst(found, {"yaw": 1.0, "sway": 0.5})]
    assert named == [("yaw", "|u| > 0.3 m/s"), ("yaw", "depth > 3 m"), ("sway", "|u| > 0.3 m/s")]


@pytest.fixture(scope="module")
def part() -> Windows:
    return cut_run(own((), 4, 240.0), merlin(), "fossen", 10.0)


def test_a_gap_planted_in_a_regime_is_found_with_its_share(part):
    """Nine tenths of the surge gap where u is in its strong forward range, the rest spread evenly elsewhere."""
    channel, rng = axis_channels(part)["surge"], RNG(12)
    u = part.y[..., channel]
    strong = u > float(f"{np.quantile(np.abs(u), 0.8):.2g}")
    error = np.zeros_like(part.y)
    error[..., channel] = rng.choice([-1.0, 1.0], u.shape) * np.where(strong, np.sqrt(0.9 / strong.sum()), np.sqrt(0.1 / (~strong).sum()))
    best = worst(slices(part, error, part.ok, 0), {"surge": 1.0})[0]
    assert best.axis == "surge"
    assert best.regime.startswith("u > ")
    assert best.share == pytest.approx(0.9, abs=0.05)
    assert best.low > 1.5
    assert best.low <= best.lift <= best.high


def test_an_even_gap_has_no_worst_place(part):
    error = RNG(13).normal(size=part.y.shape)
    assert not worst(slices(part, error, part.ok, 0), dict.fromkeys(axis_channels(part), 1 / 6))


def test_idle_thrusters_and_all_regimes_have_names(part):
    names = {s.regime for s in slices(part, RNG(15).normal(size=part.y.shape), part.ok, 0)}
    assert {"HFP turning forward", "HFP turning backward"} <= names
    assert any(n.startswith("heading") for n in names)


def test_a_part_of_the_time_is_named_by_its_times(part):
    """Once, the windows after an onset at 80 s were "the run", and what lies before 133 s of 240 was its first third."""
    late = replace(part, start=part.start[8:], nu0=part.nu0[8:], eta0=part.eta0[8:], y=part.y[8:], ok=part.ok[8:])
    times = {s.regime for s in slices(late, RNG(15).normal(size=late.y.shape), late.ok, 0) if s.regime.startswith("time ")}
    ends = [[float(word) for word in name.split() if word.isdigit()] for name in times]
    assert len(times) == 3 and min(e[0] for e in ends) == pytest.approx(part.start[8] * part.run.dt, abs=0.5)
    assert max(e[1] for e in ends) == pytest.approx((part.start[-1] + part.steps + 1) * part.run.dt, abs=0.5)
