"""`calibrate`: what a file has wrong comes back with intervals that hold; what logs do not show stays near the file; nothing moves twice."""

from __future__ import annotations

import functools
from html import unescape

import numpy as np
import pytest
from diagnose_case import merlin, own

from rovval.core.data import Run
from rovval.core.errors import BadInput
from rovval.fit.calibration import Calibration, calibrate
from rovval.fit.calibration.unknowns import applied, unknowns
from rovval.plant import Plant, parse_settings
from rovval.report.fit import html, text
from rovval.simulation import carried_effects, simulate
from rovval.simulation.fitted_commands import beyond_fitted, fitted
from rovval.simulation.fitted_tolerances import fitted_tolerances
from rovval.vehicle import load, parse
from rovval.vehicle.audit import audit
from rovval.vehicle.model import Vehicle, inertia
from rovval.vehicle.write import to_toml

WRONG = {"thrust.gain": -0.5, "quadratic_drag[surge]": 0.6, "linear_drag[yaw]": 0.7, "thrust.height": 0.1, "thrust.ahead": 0.08, "trim.buoyancy": 30.0}
CHANNELS = ("u", "v", "w", "p", "q", "r", "phi", "theta", "z")


def true_vehicle() -> Vehicle:
    """Merlin as it is in the water, where its file is wrong in six numbers."""
    asked = tuple(one for one in unknowns(merlin(), CHANNELS) if one.key in WRONG)
    return applied(merlin(), asked, np.array([WRONG[one.key] for one in asked]))


@functools.cache
def dive(seed: int, seconds: float = 180.0) -> Run:
    return own.__wrapped__((), seed, seconds, v=true_vehicle())  # uncached: a vehicle is no key


@functools.cache
def done() -> Calibration:
    return calibrate([dive(1)], merlin())


def test_what_the_file_has_wrong_comes_back():
    found = {row.unknown.key: row for row in done().rows}
    drag, gain = found["quadratic_drag[surge]"], found["thrust.gain"]
    assert drag.value / gain.value == pytest.approx(np.exp(0.6 + 0.5), rel=0.1)  # of forces the ratio shows best
    assert found["thrust.height"].value == pytest.approx(0.1, abs=0.03)
    assert found["thrust.ahead"].value == pytest.approx(0.08, abs=0.02)
    assert found["trim.buoyancy"].value == pytest.approx(30.0, abs=5.0)


@pytest.mark.parametrize("factor", [-9.0, 0.0, 3.0, 9.0, 60.0])
@pytest.mark.parametrize("drag", [-3.0, 0.0, 2.0])
def test_a_tether_drags_no_more_than_the_library_holds_wherever_the_search_goes(factor: float, drag: float):
    """Of a light vehicle a search went where the library has no tether any more, and `rovval fit` ended with that refusal."""
    chosen = [one for one in unknowns(load("bluerov2_heavy"), CHANNELS) if one.key in ("tether.drag", "quadratic_drag[surge]")]
    found = applied(load("bluerov2_heavy"), chosen, np.array([drag, factor]))
    plant = Plant(found)
    beta = parse_settings(plant, carried_effects(found))
    assert 0.0 < beta[plant.index["tether_drag.coefficient"]] <= plant.slots[plant.index["tether_drag.coefficient"]].parameter.high


def test_a_tether_that_the_file_carries_is_where_the_factor_is_counted_from():
    carried = load("bluerov2_heavy").model_copy(update={"effects": {"tether_drag": {"coefficient": 40.0}}})
    [one] = [one for one in unknowns(carried, CHANNELS) if one.key == "tether.drag"]
    drag = [applied(carried, (one,), np.array([x])).effects["tether_drag"]["coefficient"] for x in (0.0, np.log(2.0), 60.0)]
    assert drag[0] == pytest.approx(40.0, rel=1e-12)
    assert 70.0 < drag[1] < 80.0  # twice of it, less what the bound takes
    assert drag[2] == pytest.approx(next(s for s in Plant(carried).slots if s.key == "tether_drag.coefficient").parameter.high)


def test_the_calibrated_vehicle_predicts_a_dive_that_it_has_not_seen():
    other = dive(3)
    before, after = (simulate(other, vehicle).free.nu for vehicle in (merlin(), done().vehicle))
    error = [np.nanmean(np.abs(nu - other.stack(("u", "v", "w", "p", "q", "r"))), axis=0) for nu in (before, after)]
    assert (error[1][[0, 1, 2, 5]] < 0.5 * error[0][[0, 1, 2, 5]]).all()


@pytest.mark.slow
def test_a_second_calibration_changes_nothing():
    again = calibrate([dive(1)], parse(to_toml(done().vehicle), "calibrated"))
    moved = {row.unknown.key: abs(np.log(row.value) if row.unknown.kind == "factor" else row.value) / row.unknown.sd for row in again.rows}
    assert max(moved.values()) < 0.05, moved
    assert fitted(again.vehicle) == fitted(done().vehicle), "nor what it was driven with"


def test_the_written_vehicle_knows_how_far_it_was_driven_in_its_logs():
    written = parse(to_toml(done().vehicle), "calibrated")
    speed = 60.0 * dive(1).stack(tuple(f"n:{name}" for name in merlin().thrusters))
    for name, ahead, astern in zip(merlin().thrusters, np.nanmax(speed, axis=0), np.nanmin(speed, axis=0), strict=True):
        assert fitted(written)[f"command.ahead[{name}]"] == pytest.approx(max(ahead, 0.0), abs=0.1)
        assert fitted(written)[f"command.astern[{name}]"] == pytest.approx(max(-astern, 0.0), abs=0.1)
    assert beyond_fitted(dive(1), written) == ()


def test_what_the_logs_do_not_show_is_said_to_be_held_by_its_prior():
    held = {row.unknown.key for row in done().rows if not row.shown}
    assert held
    assert all(key in text(done().document()) for key in held)
    page = unescape(html(done().document())).partition("Held by their prior")[2].partition("</section>")[0]
    assert all(row.unknown.manoeuvre in page for row in done().rows if not row.shown)


def test_what_a_healthy_one_may_have_is_told_and_remembered():
    told = done().document()["tolerances"]
    assert {key: row["sd"] for key, row in told.items()} == fitted_tolerances(parse(to_toml(done().vehicle), "calibrated"))
    page = html(done().document()).partition("What a healthy one may have")[2].partition("</section>")[0]
    assert "inflow_loss.loss" in page and all(key in unescape(page) for key in told)


def test_correlations_are_those_of_a_covariance():
    found = np.array(done().matrix)
    assert found.shape == (len(done().rows),) * 2
    assert np.allclose(np.diag(found), 1.0)
    assert np.linalg.eigvalsh(found).min() > 0
    close = {frozenset((done().rows[i].unknown.key, done().rows[j].unknown.key)) for i, j in zip(*np.nonzero(np.abs(np.tril(found, -1)) >= 0.7), strict=True)}
    assert close == {frozenset(pair[:2]) for pair in done().correlations}


@pytest.mark.slow
def test_every_log_that_cannot_be_used_is_told():
    short = dive(4, 15.0)
    found = calibrate([dive(1, 60.0), short], merlin())
    assert len(found.left_out) == 1
    assert short.id in found.left_out[0]


def test_none_at_all_is_refused():
    with pytest.raises(BadInput, match="windows of 10 s"):
        calibrate([dive(4, 15.0)], merlin())


@pytest.mark.parametrize("along", ["x", "y", "z"])
@pytest.mark.parametrize("factor", [-6.0, -0.5, 0.5, 6.0])
def test_mass_may_be_spread_otherwise_and_is_that_of_a_body_still(along: str, factor: float):
    """A moment of inertia had been scaled by itself, and a calibration on tank runs wrote a vehicle that rovval then refused to read."""
    flat = load("bluerov2_heavy")
    flat = flat.model_copy(update={"body": flat.body.model_copy(update={"Ixz": 0.02})})
    [one] = [one for one in unknowns(flat, CHANNELS) if one.key == f"mass.spread.{along}"]
    assert audit(applied(flat, (one,), np.array([factor]))) == ()
    moved = np.diag(inertia(applied(flat, (one,), np.array([factor])).body)) / np.diag(inertia(flat.body))
    mine = "xyz".index(along)
    assert moved[mine] == pytest.approx(1.0), "it does not lie off its own axis"
    assert ((np.delete(moved, mine) - 1.0) * factor > 0).all()


def test_drag_that_a_file_leaves_out_is_there_with_a_first_guess():
    body = merlin().body.model_copy(update={"linear_drag": (0.0,) * 6})
    bare = merlin().model_copy(update={"body": body})
    filled = applied(bare, (), np.zeros(0)).body
    assert (np.array(filled.linear_drag) > 0).all()
    assert filled.quadratic_drag == tuple(bare.body.quadratic_drag)
