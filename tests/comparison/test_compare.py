"""Comparing a run with simulations of it."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from diagnose_case import NOISE
from report_cases import make_run, make_sim, motion
from tumbling import bluerov2, tumbling

from rovval.comparison import compare
from rovval.comparison.error_growth import error_growth
from rovval.core.channels import AXES, VELOCITIES
from rovval.core.data import Reason, Run, SimResult, Trajectory
from rovval.core.errors import BadInput, SimulationStopped
from rovval.simulation import simulate


def identical(run: Run) -> SimResult:
    nu, eta = run.stack(VELOCITIES), run.stack(("x", "y", "z", "phi", "theta", "psi"))
    same = Trajectory(nu, eta, np.zeros(len(run), np.uint8), np.arange(len(run)) // 100)
    return replace(make_sim(run), free=same, windowed=same)


def test_a_simulation_equal_to_the_log_has_no_error() -> None:
    run = make_run(400)
    c = compare(run, identical(run))
    for table in (c.free, c.windowed, c.pose):
        assert all(e.rmse == e.iae == e.mae == 0 and e.skill == 1 for e in table.values())
    assert tuple(c.free) == AXES and tuple(c.pose) == ("z", "phi", "theta", "psi") and c.not_measured == ()


def test_error_is_simulated_minus_measured() -> None:
    run = make_run(400)
    sim = identical(run)
    c = compare(run, replace(sim, free=replace(sim.free, nu=sim.free.nu + np.array([0.1, -0.2, 0, 0, 0, 0]))))
    assert c.free["surge"].mean_error == pytest.approx(0.1) and c.free["sway"].mean_error == pytest.approx(-0.2)
    assert c.free["surge"].iae == pytest.approx(0.1 * 0.1 * 400) and c.windowed["surge"].rmse == 0


def test_not_logged_is_named_and_absent_never_zero() -> None:
    run = make_run(400, absent=("p", "q", "phi", "z"))
    c = compare(run, make_sim(run))
    assert c.not_measured == ("roll", "pitch") and set(c.pose) == {"theta", "psi"}
    assert "roll" not in c.free and "roll" not in c.windowed


def test_masked_rows_count_for_nothing() -> None:
    run = make_run(400, holes={"u": slice(100, 200)})
    e = compare(run, make_sim(run)).free["surge"]
    assert e.n == 300 and e.coverage == 0.75 and np.isfinite(e.rmse)


def test_rows_after_a_stop_are_not_compared() -> None:
    run = make_run(400)
    c = compare(run, make_sim(run, stop=100))
    assert c.free["yaw"].n == 100 and c.windowed["yaw"].n == 400
    sim = make_sim(run, stop=0)
    with pytest.raises(SimulationStopped, match="pitch beyond"):
        compare(run, replace(sim, windowed=sim.free))


def test_headings_are_compared_around_the_circle() -> None:
    run = make_run(400)
    sim = identical(run)
    turned = sim.windowed.eta + np.array([0, 0, 0, 0, 0, 2 * np.pi - 0.1])
    e = compare(run, replace(sim, windowed=replace(sim.windowed, eta=turned))).pose["psi"]
    assert e.mean_error == pytest.approx(-0.1) and e.rmse == pytest.approx(0.1)


def test_baselines_are_no_motion_and_stays_where_it_began() -> None:
    run = make_run(400)
    c = compare(run, make_sim(run))
    u, z = run.get("u"), run.get("z")
    assert c.free["surge"].baseline_rmse == pytest.approx(np.sqrt(np.mean(u**2)))
    began = np.repeat(z[::100], 100)
    assert c.pose["z"].baseline_rmse == pytest.approx(np.sqrt(np.mean((z - began) ** 2)))
    e = c.free["surge"]
    assert e.skill == pytest.approx(1 - (e.rmse / e.baseline_rmse) ** 2)


def test_pose_baseline_starts_at_the_first_row_that_was_measured() -> None:
    run = make_run(400, holes={"z": slice(100, 110)})
    assert compare(run, make_sim(run)).pose["z"].n == 390


def test_a_still_vehicle_has_no_skill_to_speak_of() -> None:
    run = make_run(200)
    values = {**run.values, "v": np.zeros(200)}
    c = compare(replace(run, values=values), make_sim(run))
    assert c.free["sway"].skill is None and "fit_percent" not in c.free["sway"].extra


def test_another_simulator_is_compared_on_the_same_rows() -> None:
    run = make_run(400)
    nu, _ = motion(400)
    theirs = nu[:, 0] + 0.5
    theirs[:100] = np.nan
    c = compare(run, make_sim(run), {"u": theirs, "yaw": nu[:, 5]}, "unity")
    assert c.other_name == "unity" and set(c.other) == {"surge", "yaw"}
    assert c.other_nu is not None and c.other_nu.shape == (400, 6)
    e = c.other["surge"]
    ours = compare(run, make_sim(run)).free["surge"]
    assert e.n == 300 and e.extra["ours_n"] == 300 and e.extra["ours_mae"] != ours.mae
    error = make_sim(run).free.nu[100:, 0] - run.get("u")[100:]
    assert e.extra["ours_mae"] == pytest.approx(np.abs(error).mean())
    whole = compare(run, make_sim(run), nu, "unity")
    assert whole.other["yaw"].extra["ours_mae"] == pytest.approx(compare(run, make_sim(run)).free["yaw"].mae)


@pytest.mark.parametrize(
    ("other", "words"),
    [({"speed": np.zeros(400)}, "has channels speed"), ({"u": np.zeros(3)}, r"\(3,\) values"), (np.zeros((400, 5)), "shape")],
)
def test_another_simulator_of_the_wrong_shape_is_refused(other: Any, words: str) -> None:
    run = make_run(400)
    with pytest.raises(BadInput, match=words):
        compare(run, make_sim(run), other, "unity")


def test_a_simulation_of_another_length_is_refused() -> None:
    with pytest.raises(BadInput, match="400 rows"):
        compare(make_run(400), make_sim(make_run(300)))


def test_a_run_without_velocities_is_compared_by_its_pose() -> None:
    run = make_run(200, absent=VELOCITIES)
    comparison = compare(run, make_sim(run))
    assert not comparison.free and not comparison.windowed and set(comparison.pose) >= {"z", "phi", "theta"}
    assert len(comparison.not_measured) == 6


def test_a_run_without_velocities_and_pose_is_refused() -> None:
    run = make_run(200, absent=(*VELOCITIES, "z", "phi", "theta", "psi"))
    with pytest.raises(BadInput, match="neither a velocity nor a pose"):
        compare(run, make_sim(run))


def test_error_grows_along_the_window() -> None:
    run = make_run(1050)
    h = error_growth(compare(run, make_sim(run)))["surge"]
    assert h.rms[0] < h.rms[20] < h.rms[-1] and h.seconds[-1] == pytest.approx(9.9) and h.n[0] == 11 and h.n[-1] == 10
    near, end = h.at(2.0), h.at(10.0)
    assert near and end and near[0] == pytest.approx(2.0) and end[0] == pytest.approx(9.9) and h.at(30.0) is None


def test_rows_outside_any_window_are_left_out() -> None:
    run = make_run(300)
    sim = make_sim(run)
    stretch = sim.windowed.stretch.copy()
    stretch[100:200] = -1
    reasons = np.where(stretch < 0, Reason.NOT_LOGGED, Reason.OK)
    c = compare(run, replace(sim, windowed=replace(sim.windowed, stretch=stretch, reasons=reasons)))
    assert c.windowed["surge"].n == 200 and c.free["surge"].n == 300
    assert error_growth(c)["surge"].n[0] == 2


@pytest.mark.parametrize(("every", "enough"), [(1, True), (9, True), (11, False)])
def test_a_comparison_of_less_than_a_tenth_of_the_rows_is_refused(every: int, enough: bool) -> None:
    """A log with one row in a hundred was compared at exit 0; rows that a stretch starts on have no error by construction."""
    run = make_run(1200)
    sim = make_sim(run)
    kept = (np.arange(len(run)) // 10) % every == 0
    reasons = np.where(kept, Reason.OK, Reason.STOPPED).astype(np.uint8)
    sparse = replace(sim, free=replace(sim.free, reasons=reasons), windowed=replace(sim.windowed, reasons=reasons))
    if enough:
        assert compare(run, sparse).free["surge"].n == kept.sum()
        return
    with pytest.raises(BadInput, match="less than 10 %"):
        compare(run, sparse)


def test_velocities_of_a_few_rows_are_no_comparison_however_much_of_the_pose_there_is() -> None:
    """Five rows of 1800 made "better than no motion on every axis", exit 0, since depth and attitude were there throughout."""
    run = make_run(1200, holes=dict.fromkeys(VELOCITIES, slice(60, None)))
    with pytest.raises(BadInput, match=r"\d\.\d % of its 1200 rows can be compared"):
        compare(run, identical(run))


def test_rows_that_every_stretch_starts_on_are_no_comparison() -> None:
    """Of a log at 1 Hz every row was the start of its own stretch: skill +1.00 on every axis."""
    run = make_run(1200)
    sim = make_sim(run)
    alone = replace(sim.free, stretch=np.arange(len(run)))
    with pytest.raises(BadInput, match=r"0\.0 % of its 1200 rows"):
        compare(run, replace(sim, free=alone, windowed=alone))


def test_attitude_of_a_vehicle_that_tumbles_is_compared_as_a_turn() -> None:
    """Roll and heading jump where the pitch passes 90 degrees, in the log and in the simulation at other samples."""
    run = tumbling()
    pose = compare(run, simulate(run, bluerov2())).pose
    assert max(pose[name].rmse for name in ("phi", "theta", "psi")) < 5 * NOISE["phi"]
    assert min(pose[name].baseline_rmse for name in ("phi", "theta", "psi")) > 0.3
