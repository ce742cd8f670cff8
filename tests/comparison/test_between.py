"""B minus A of two motions: the numbers are those of a difference that was put in, and a tie is called one."""

from __future__ import annotations

import numpy as np
import pytest

from rovval.comparison.between import RESOLUTION, Track, between
from rovval.core.errors import BadInput
from rovval.report import between as report

DT, N = 0.1, 601
T = np.arange(N) * DT


def track(name: str, surge: float = 0.0, heading: float = 0.0) -> Track:
    """One metre a second ahead, swaying a little; ``surge`` (m/s) faster and turned by ``heading`` (rad)."""
    nu, eta = np.zeros((N, 6)), np.zeros((N, 6))
    nu[:, 0], nu[:, 1] = 1.0 + surge, 0.2 * np.sin(T)
    eta[:, 0], eta[:, 5] = T * (1.0 + surge), 3.1 + heading
    return Track(name, DT, nu, eta)


def test_a_difference_that_was_put_in_is_what_is_printed():
    d = between(track("A"), track("B", surge=-0.05))
    surge = d.velocities["surge"]
    assert (surge.mean, surge.rms, surge.largest) == pytest.approx((-0.05, 0.05, -0.05))
    assert surge.iae == pytest.approx(0.05 * N * DT) and surge.share == pytest.approx(0.05) and not surge.tie
    assert d.velocities["sway"].tie and not d.tie
    assert d.pose["x"].largest == pytest.approx(-3.0)


def test_heading_is_subtracted_round_the_circle():
    assert between(track("A"), track("B", heading=0.2)).pose["psi"].mean == pytest.approx(0.2)


def test_the_same_motion_is_a_tie_and_one_within_the_integration_s_accuracy_too():
    assert between(track("A"), track("B")).tie
    assert between(track("A"), track("B", surge=0.4 * RESOLUTION)).velocities["surge"].tie
    assert not between(track("A"), track("B", surge=3.0 * RESOLUTION)).velocities["surge"].tie
    assert "tie" in report.said(between(track("A"), track("B")))


def test_the_claim_of_the_thesis_is_checked_and_not_assumed():
    within, beyond = (report.said(between(track("fossen"), track("uuv", surge=s))) for s in (-0.05, -0.2))
    assert "holds on every axis" in within and "beyond: no axis" in within
    assert "does not hold" in beyond and "surge (20 %)" in beyond


def test_the_page_draws_both_motions_of_every_axis_and_what_lies_between_them():
    """Under one name, too, and with an axis that one of them does not have."""
    d = between(track("fossen"), track("fossen", surge=0.1))
    page = report.html(d, "a log")
    assert page.count("<svg") == 14 and "A: fossen" in page and "B: fossen" in page and report.said(d) in page
    blind = track("B")
    blind = Track("B", DT, np.where(np.arange(6) == 1, np.nan, blind.nu), np.full((N, 6), np.nan))
    page = report.html(between(track("A"), blind), "a log")
    assert page.count("<svg") == 10 and "Pose, B minus A" not in page


def test_an_axis_that_stands_still_in_a_has_no_per_cent():
    still = Track("A", DT, np.zeros((N, 6)), np.zeros((N, 6)))
    assert between(still, track("B")).velocities["surge"].share is None


def test_motions_of_different_samples_are_refused():
    a = track("A")
    with pytest.raises(BadInput, match="601 samples"):
        between(a, Track("B", DT, a.nu[:-1], a.eta[:-1]))
    with pytest.raises(BadInput, match="no channel"):
        between(a, Track("B", DT, np.full((N, 6), np.nan), np.full((N, 6), np.nan)))


def test_samples_that_one_of_them_lacks_are_left_out():
    a = track("A")
    nu = np.array(a.nu)
    nu[:100] = np.nan
    assert between(a, Track("B", DT, nu, a.eta)).velocities["surge"].n == N - 100
