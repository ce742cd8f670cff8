"""What keeps a diagnosis honest: slop that settles by re-simulation, strain, generic forces, axes that an autopilot steadies."""

from __future__ import annotations

import functools
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from diagnose_case import bare, merlin, own

from rovval import vehicle
from rovval.core.channels import AXES
from rovval.core.data import Run
from rovval.diagnose import diagnose
from rovval.diagnose.decision import verdict
from rovval.diagnose.decision.benefit import UNMOVED, Way, as_filed, beside_slop, harms, skilled, stand
from rovval.diagnose.decision.questions import crowd
from rovval.diagnose.decision.weigh import Weighed
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.inference.hypothesis_fit import confirm
from rovval.diagnose.inference.laplace import evidence
from rovval.diagnose.inference.map_fit import healthy_point, settle
from rovval.diagnose.inference.prior import loosened, slop_prior
from rovval.diagnose.inference.problem import Problem, corrected_residuals, pose
from rovval.diagnose.inference.shrinkage import shrinkage
from rovval.diagnose.residuals.normal_equations import Products
from rovval.diagnose.search.baseline import relief, without_own
from rovval.diagnose.search.confusion import FORM, MOST_FORM, form_share
from rovval.diagnose.search.discrepancy import Forces, forces
from rovval.diagnose.windows.closed_loop import discount, gains, loop_gain
from rovval.diagnose.windows.shooting import cut, cut_all
from rovval.plant import Plant
from rovval.report.diagnosis.json import document as written
from rovval.vehicle.model import allocation


@functools.cache
def problem(*effects: str) -> Problem:
    parts, _ = cut_all([own(effects, 5, 100.0)], merlin(), "fossen", 10.0)
    return pose(parts, columns_of(hypotheses(parts)[0]), 0.05)


def slot(p: Problem, key: str) -> int:
    return next(i for i, s in enumerate(p.plant.slots) if s.key == key)


def test_a_coefficient_within_tolerance_settles_where_it_is():
    p = problem("thruster_degraded[HFP]:loss=0.05", "linear_drag[surge]:scale=-0.06")
    point = settle(p, p.origin, ())
    assert point.beta[slot(p, "thruster_degraded[HFP].loss")] == pytest.approx(0.05, abs=0.02)
    assert np.abs(point.sigmas()).max() < 2.5
    assert forces(p, point).evidence() < 0, "nothing systematic is left of a vehicle that is only slop away"


def test_an_effect_that_slop_must_imitate_strains_it():
    p = problem("thruster_degraded[HFP]:loss=0.5")
    point = settle(p, p.origin, ())
    strained = p.plant.slots[point.columns[int(np.abs(point.sigmas()).argmax())]].key
    assert strained == "thruster_degraded[HFP].loss" and np.abs(point.sigmas()).max() > 7.0


def test_settling_the_true_effect_is_worth_more_than_slop_alone_and_no_step_makes_it_worse():
    p = problem("inflow_loss:loss=0.3")
    alone = settle(p, p.origin, ())
    own_slot = slot(p, "inflow_loss.loss")
    start = alone.beta.copy()
    start[own_slot] = 0.1
    found = settle(p, start, (own_slot,))
    ones = np.ones((1, p.blocks))
    assert found.beta[own_slot] == pytest.approx(0.3, abs=0.05)
    assert evidence(p, found, ones)[0] > evidence(p, alone, ones)[0] + 50
    assert settle(p, found.beta, (own_slot,)).cost() <= found.cost() * (1 + 1e-9)


def test_evidence_is_linear_in_copies_of_the_log_but_for_the_prior():
    p = problem("inflow_loss:loss=0.3")
    point = settle(p, p.origin, ())
    one, two = evidence(p, point, np.stack([np.ones(p.blocks), 2 * np.ones(p.blocks)]))
    assert two > one, "twice the data says the same louder"


RELATIVES = {  # withheld with the effect: the same law, or one that is it at some value of its parameters
    "current_constant:north=0.15": ("current_constant", "current_varying", "current_shear", "tether_tension", "tether_snag"),
    "thruster_degraded[HFP]:loss=0.5": (
        "thruster_degraded",
        "thruster_fault_onset",
        "thruster_reversed",
        "thruster_interaction",
    ),
}


@pytest.mark.parametrize(
    ("planted", "axes"), [("current_constant:north=0.15", {"surge", "sway"}), ("thruster_degraded[HFP]:loss=0.5", {"yaw"})]
)
def test_a_withheld_effect_is_unknown_and_said_where(planted: str, axes: set[str]):
    document = written(diagnose([own((planted,), 5, 160.0)], merlin(), without=RELATIVES[planted]))
    assert document["verdict"] == "unknown" and document["causes"] == []
    assert document["left"]["axes"][0] in axes and "no effect of the library" in document["left"]["text"]


def test_a_tolerance_is_no_diagnosis():
    parts, _ = cut_all([own((), 5, 100.0)], merlin(), "fossen", 10.0)
    names = {h.name.partition("[")[0] for h in hypotheses(parts)[0]}
    assert "thruster_astern" not in names and "thruster_degraded" in names
    assert any(parts[0].plant.slots[s].effect == "thruster_astern" for s in slop_prior(parts[0].plant, 0.05).sd)


def test_few_windows_leave_more_to_the_form_of_an_equation():
    shares = [form_share(m) for m in (3, 6, 12, 30, 300)]
    assert shares == sorted(shares, reverse=True) and shares[0] == MOST_FORM and shares[-1] == pytest.approx(FORM, rel=1e-3)


def steadied(gain: float) -> Run:
    """A BlueROV2 that rolls in the swell while its thrusters give ``gain`` times the righting moment against it."""
    v = vehicle.load("bluerov2_heavy")
    n = 1200
    t = 0.1 * np.arange(n)
    roll = 0.1 * np.sin(0.9 * t) * np.cos(0.13 * t)
    righting = v.weight * 0.01
    unit = np.linalg.pinv(allocation(v)) @ np.array([0.0, 0.0, 0.0, -righting, 0.0, 0.0])
    thrust = gain * roll[:, None] * unit
    speed = np.sign(thrust) * np.sqrt(
        np.abs(thrust) / np.where(thrust >= 0, [x.k_pos for x in v.thruster], [x.k_neg for x in v.thruster])
    )
    values = {c: np.zeros(n) for c in ("u", "v", "w", "q", "r", "x", "y", "z", "theta", "psi")}
    values |= {"phi": roll, "p": np.gradient(roll, 0.1)} | {f"n:{x.name}": speed[:, i] / 60.0 for i, x in enumerate(v.thruster)}
    return bare(values, v, f"steadied {gain}")


@pytest.mark.parametrize("gain", [0.0, 2.0, 6.0])
def test_the_gain_of_an_autopilot_is_read_off_the_thrusters(gain: float):
    part = cut(steadied(gain), vehicle.load("bluerov2_heavy"), "fossen", 10.0)
    assert loop_gain(part, "phi", "p", 3) == pytest.approx(gain, rel=0.05, abs=0.01)
    assert loop_gain(part, "theta", "q", 4) == 0.0
    found = discount((part,), gains((part,)))
    assert found[part.channels.index("phi")] == pytest.approx((1 + gain) ** 2, rel=0.1)
    assert (np.delete(found, [part.channels.index(c) for c in ("phi", "p")]) == 1.0).all()


def test_only_what_turns_about_a_steadied_axis_is_loosened():
    plant = Plant(vehicle.load("bluerov2_heavy"), "fossen")
    tight = slop_prior(plant, 0.05)
    loose = loosened(tight, plant, {"roll": 3.0, "pitch": 0.0})
    wider = {plant.slots[s].key for s in tight.sd if loose.sd[s] > tight.sd[s]}
    assert wider == {f"{e}[roll].scale" for e in ("linear_drag", "quadratic_drag", "added_mass", "inertia_error")} | {
        f"cg_offset.{x}" for x in "xyz"
    }
    by_key = {plant.slots[s].key: loose.sd[s] / tight.sd[s] for s in tight.sd}
    assert by_key["cg_offset.z"] == pytest.approx(4.0) and by_key["cg_offset.x"] == by_key["cg_offset.y"] == pytest.approx(2.0)
    assert replace(tight).sd == slop_prior(plant, 0.05).sd, "nothing was changed in place"


def test_harm_is_told_from_what_is_closed_in_all():
    before = {"surge": 10.0, "yaw": 1.0}
    assert harms(Way(before, {"surge": 2.0, "yaw": 4.0}, True, True))
    assert not harms(Way(before, {"surge": 2.0, "yaw": 2.0}, True, True))
    assert not harms(Way(before, before | {"yaw": 1.0 + 0.5 * UNMOVED * 11.0}, True, True))  # rounding, as of a compass


@pytest.mark.parametrize(
    ("names", "many"),
    [
        (("linear_drag[surge]", "quadratic_drag[surge]", "linear_drag[sway]"), True), (("linear_drag[surge]", "linear_drag[sway]"), False),
        (("thruster_degraded[HFP]", "thruster_misaligned[HFS]", "thruster_reversed[HAP]"), True),
        (("linear_drag[surge]", "thruster_degraded[HFP]", "linear_drag[sway]"), False), (("waves", "current_constant", "dvl_scale"), False),
    ],
)  # fmt: skip
def test_three_causes_of_one_kind_are_a_crowd(names: tuple[str, ...], many: bool):
    named: Any = [SimpleNamespace(hypothesis=Hypothesis(name, name, (), (), ())) for name in names]
    assert crowd(named) == many


def test_a_drag_that_spoils_its_own_axis_is_none():
    """Whatever it closes elsewhere, beside other causes or through coupling."""
    way = Way({"surge": 1.0, "yaw": 10.0}, {"surge": 2.0, "yaw": 1.0}, True, True)
    assert harms(way, ["surge"]) and not stand([way], False, ["yaw", "surge"])
    assert not harms(way) and not harms(way, ["yaw"]) and stand([way], False, ["yaw"])


def test_beside_a_cause_coefficients_may_be_as_slop_lets_them_be():
    p = problem("buoyancy_error:force=60", "quadratic_drag[surge]:scale=0.2")
    final, healthy = confirm(p, p.origin, (slot(p, "buoyancy_error.force"),)), healthy_point(p)
    filed, eased = as_filed(p, final, corrected_residuals(p)), beside_slop(p, final, healthy, corrected_residuals(p))
    assert filed.sure and eased.sure and filed.skill and eased.skill
    assert eased.left["surge"] < 0.8 * filed.left["surge"]
    assert eased.left["heave"] == pytest.approx(filed.left["heave"], rel=0.2)


def test_what_closes_one_axis_surely_and_the_whole_perhaps_is_not_sure(monkeypatch: pytest.MonkeyPatch):
    p = problem("buoyancy_error:force=60")
    final, before = confirm(p, p.origin, (slot(p, "buoyancy_error.force"),)), corrected_residuals(p)
    told = shrinkage(p, final, before, 0)
    monkeypatch.setattr("rovval.diagnose.decision.benefit.shrinkage", lambda *_: told | {"low": -0.01})
    assert told["axes_interval"]["heave"]["low"] > 0.0 and not as_filed(p, final, before).sure


def test_one_force_alone_is_worth_what_it_is_with_the_others_held():
    """Against the evidence of that force alone, worked out with the whole matrix; on the axes asked for."""
    rng = np.random.default_rng(0)
    axes = ("surge", "sway", "surge", "yaw", "roll", "heave")
    X = rng.normal(size=(30, 12, 4 + len(axes)))
    r = rng.normal(size=(30, 12)) + 0.8 * X[..., 6]
    data = Products(np.einsum("wni,wnj->wij", X, X), np.einsum("wni,wn->wi", X, r), (r**2).sum(axis=1), tuple(range(X.shape[-1])))
    beside = Forces(tuple((axis, str(i)) for i, axis in enumerate(axes)), data, np.full(4, 2.0), rng.normal(size=4), 1.7)
    one_by_one = {axis: max(beside.evidence([axis], str(i)) for i, a in enumerate(axes) if a == axis) for axis in axes}
    assert beside.alone(["surge"]) == pytest.approx(one_by_one["surge"]) == pytest.approx(beside.alone())
    assert beside.alone(["sway", "yaw"]) == pytest.approx(max(one_by_one["sway"], one_by_one["yaw"], 0.0))
    assert beside.alone() > beside.evidence(), "many that gain nothing cost more than the one gains"


def test_a_few_forces_are_worth_what_they_are_one_after_another():
    """Two of six at work; each of equal prior size, against the evidence of just those two, worked out with the whole matrix."""
    rng = np.random.default_rng(0)
    axes = ("surge", "sway", "surge", "yaw", "roll", "heave")
    X = rng.normal(size=(30, 12, 4 + len(axes)))
    r = rng.normal(size=(30, 12)) + 0.8 * X[..., 6] + 0.9 * X[..., 7]
    data = Products(np.einsum("wni,wnj->wij", X, X), np.einsum("wni,wn->wi", X, r), (r**2).sum(axis=1), tuple(range(X.shape[-1])))
    beside = Forces(tuple((axis, str(i)) for i, axis in enumerate(axes)), data, np.full(4, 2.0), rng.normal(size=4), 1.7)
    pair = max(beside._evidence([2, 3], share) for share in (0.01, 0.1, 1.0)) - beside._evidence([], 1.0)
    assert beside.alone(most=2) == pytest.approx(pair)
    assert beside.alone() < beside.alone(most=2) <= beside.alone(most=4) < beside.alone(most=2) + 8.0, "the others are noise"


def test_a_force_that_the_cause_itself_could_be_is_not_held_against_it():
    """A coefficient that tolerance keeps in place leaves the force to others; as a cause it is free, and the force is the same thing."""
    rng = np.random.default_rng(1)
    X = rng.normal(size=(30, 12, 2))
    X[..., 1] = X[..., 0] + 0.1 * X[..., 1]
    r = rng.normal(size=(30, 12)) + 0.5 * X[..., 0]
    data = Products(np.einsum("wni,wnj->wij", X, X), np.einsum("wni,wn->wi", X, r), (r**2).sum(axis=1), (7, 8))
    beside = Forces((("surge", "u"),), data, np.full(1, 1e3), np.zeros(1), 1.0)
    assert beside.alone(causes=(3,)) == beside.alone() > 20.0
    assert beside.alone(causes=(7,)) == 0.0


@pytest.mark.parametrize(("own", "counts"), [(0.95, True), (0.995, False)])
def test_a_force_that_a_coefficient_undoes_is_no_force_of_its_own(own: float, counts: bool):
    """As drag undoes a force that varies with speed: whatever little the two do against each other, however well it fits."""
    rng = np.random.default_rng(1)
    X = rng.normal(size=(30, 12, 2))
    X[..., 1] = own * X[..., 0] + np.sqrt(1.0 - own**2) * X[..., 1]
    r = rng.normal(size=(30, 12)) + 20.0 * (X[..., 1] - own * X[..., 0])
    data = Products(np.einsum("wni,wnj->wij", X, X), np.einsum("wni,wn->wi", X, r), (r**2).sum(axis=1), (0, 1))
    beside = Forces((("surge", "u"),), data, np.full(1, 1e-3), np.zeros(1), 1.0)
    assert beside.evidence() > 100.0
    assert beside.alone() == (pytest.approx(beside.evidence()) if counts else 0.0)


@pytest.mark.parametrize(("strain", "stands"), [(4.1, True), (5.7, False)])
def test_what_stands_without_an_unsteady_cause_leaves_the_file_within_its_tolerance(monkeypatch: pytest.MonkeyPatch, strain: float, stands: bool):
    """Else what went had taken up the strain, and something else is there."""
    named = [SimpleNamespace(hypothesis=SimpleNamespace(name=name)) for name in ("crossflow_loss", "voltage_sag")]
    selection: Any = SimpleNamespace(named=named, final=object())
    asked: Any = Weighed(400.0, 100.0, 0.0, 4.0, True, False, False, False, ("voltage_sag",), None)  # type: ignore[arg-type]
    monkeypatch.setattr("rovval.diagnose.decision.verdict._only", lambda *_: selection)
    monkeypatch.setattr("rovval.diagnose.decision.verdict.weigh", lambda *_: replace(asked, strain=strain, unsteady=()))
    _, again = verdict._steady(None, selection, asked, None, [])  # type: ignore[arg-type]
    assert again.least_bad is not stands and again.remains and again.unsteady == ("voltage_sag",)


def test_a_coefficient_does_not_hide_behind_its_own_tolerance():
    """Healthy drag may be what the cause is a departure of: without its own tolerance the others leave the gap open."""
    p = problem("quadratic_drag[surge]:scale=0.4")
    own, healthy = (slot(p, "quadratic_drag[surge].scale"),), healthy_point(p)
    others, final = without_own(p, healthy, own), confirm(p, p.origin, own)
    assert healthy.beta[own[0]] != p.origin[own[0]] and others.beta[own[0]] == p.origin[own[0]]
    assert relief(p, final, others, 0)[1] > relief(p, final, healthy, 0)[1] - 0.01 and relief(p, final, others, 0)[1] > 0.0


def test_an_axis_on_which_the_simulator_errs_as_much_as_the_vehicle_moves_shows_nothing():
    p = problem()
    was, left = dict.fromkeys(AXES, 2e6), dict.fromkeys(AXES, 8e5)
    still = Way(was, left, True, skilled(p, was, left))
    assert not still.skill and not stand([still], seen=False) and stand([still], seen=True)
