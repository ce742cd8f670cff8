"""The search: effects of both plants are found."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from diagnose_case import bluerov2, foreign, merlin, own

from rovval.diagnose import diagnose
from rovval.diagnose.pipeline import searched
from rovval.diagnose.problem.prior import tolerance_prior
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.vehicle import load


@pytest.mark.slow
def test_a_list_that_an_autopilot_holds_is_found(tmp_path: Path):
    """It makes roll and pitch count little, and other coefficients within tolerance show more than the list itself."""
    document = diagnose([bluerov2(tmp_path, "list.csv", 12, 200.0, 0.03, ("cg_offset", "", -1.6))], load("bluerov2_heavy")).document()
    assert [c["effect"] for c in document["causes"]] == ["cg_offset"], document["sentence"]


def test_a_channel_that_never_changes_is_no_measurement():
    run = own((), 5, 100.0)
    stuck = replace(run, values={**run.values, "u": np.full(len(run), 0.5)})
    document = diagnose([stuck], merlin()).document()
    assert "u" not in document["gap"]["axes"] and any("all along" in row["detail"] for row in document["log"])
    assert document["verdict"] == "no_gap", document["sentence"]


BRIEF = "in 15 windows a shear of another form reads as a current that varies along the log, at 0.91"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("planted", "name", "seconds"),
    [
        ((("density_gradient", "", -0.8),), "density_gradient", 160.0),
        ((("thruster_deadband", "", 2.3),), "thruster_deadband", 160.0),
        ((("crossflow_loss", "", 1.5),), "crossflow_loss", 160.0),
        ((("current_shear", "", 1.2),), "current_shear", 300.0),
        pytest.param((("current_shear", "", 1.2),), "current_shear", 160.0, marks=pytest.mark.xfail(strict=True, reason=BRIEF)),
    ],
)  # fmt: skip
def test_what_is_large_or_has_its_datum_in_the_log_is_found(tmp_path: Path, planted, name, seconds):
    """A loss or a dead band beyond what is usual, and a change with depth about a depth that the log goes through; independent plant."""
    document = diagnose([foreign(tmp_path, planted, 41, seconds, 0.03)], merlin()).document()
    assert name in document["causes"][0]["group"][:2], document["sentence"]


@pytest.mark.slow
def test_propellers_that_are_all_of_one_hand_are_found_where_the_file_has_them_in_pairs(tmp_path: Path):
    document = diagnose([bluerov2(tmp_path, "hand.csv", 12, 160.0, 0.03, ("propeller_torque", "", 1.5))], load("bluerov2_heavy")).document()
    (cause,) = document["causes"]
    assert cause["effect"] == "propeller_torque" and cause["parameters"]["common"]["value"] < -0.02, document["sentence"]


@pytest.mark.slow
def test_a_depth_sensor_that_is_late_is_named_and_has_no_tolerance(tmp_path: Path):
    """Half a sample of delay is nothing that a check of the depth is held to see, so it has no tolerance; a longer one shows in that check alone."""
    run = foreign(tmp_path, (("time_offset", "depth", 1.5),), 12, 200.0, 0.02)
    parts, _ = cut([run], merlin(), "fossen", 10.0)
    late = {parts[0].plant.slots[s].key for s in tolerance_prior(parts[0].plant, 0.05).sd if parts[0].plant.slots[s].effect == "time_offset"}
    assert late == {"time_offset.tau", "time_offset[velocity].delay", "time_offset[attitude].delay"}
    (cause,) = diagnose([run], merlin()).document()["causes"]
    assert cause["effect"] == "time_offset[depth]" and cause["parameters"]["delay"]["low"] < 0.6 < cause["parameters"]["delay"]["high"]


@pytest.mark.parametrize(
    ("planted", "seed", "effect", "parameter", "true"),
    [
        pytest.param(("time_offset", "attitude", 2.0), 13, "time_offset[attitude]", "delay", 0.8, marks=pytest.mark.slow),
        pytest.param(("time_offset", "attitude", -1.5), 13, "time_offset[attitude]", "delay", -0.6, marks=pytest.mark.slow),
        pytest.param(("payload_change", "", -1.5), 14, "payload_change", "mass", None, marks=pytest.mark.slow),
    ],
    ids=["late", "early", "set down"],
)
def test_a_late_sensor_and_a_load_that_is_set_down_are_found_in_their_size(
    planted: tuple[str, str, float], seed: int, effect: str, parameter: str, true: float | None, tmp_path: Path
):
    """From the independent plant: delays that are a good part of a roll's period, and a mass that leaves with its load."""
    run = foreign(tmp_path, (planted,), seed, 200.0, 0.02)
    cause = diagnose([run], merlin()).document()["causes"][0]
    found = cause["parameters"][parameter]
    assert cause["effect"] == effect
    assert found["low"] < true < found["high"] if true else found["high"] < 0.0


@pytest.mark.slow
def test_commands_that_come_most_of_a_second_late_are_found_though_no_slope_shows_it():
    """Thrusters that answer as much later are the same thing."""
    document = diagnose([own(("time_offset:tau=0.8",), 5, 160.0)], merlin()).document()
    (cause,) = document["causes"]
    late = cause["parameters"]["tau" if cause["effect"] == "time_offset" else "dead"]
    assert cause["effect"] in ("time_offset", "thrust_lag") and late["low"] < 0.8 < late["high"]


@pytest.mark.slow
def test_velocities_in_knots_are_a_scale():
    run = own((), 5, 160.0)
    knots = replace(run, values={**run.values, **{c: 1.944 * run.get(c) for c in "uvw"}})
    (cause,) = diagnose([knots], merlin()).document()["causes"]
    assert cause["effect"] == "dvl_scale" and cause["parameters"]["scale"]["value"] == pytest.approx(0.944, abs=0.06)


def test_a_search_whose_causes_leave_held_out_windows_as_they_were_ends(tmp_path: Path):
    """A line that snags, while the library has no line: the first cause leaves all of held-out windows, the second one more than the first."""
    parts, _ = cut([foreign(tmp_path, (("tether_snag", "", 1.5),), 5, 160.0, 0.03)], merlin(), "fossen", 10.0)
    found = searched(parts, ("tether_snag", "tether_tension", "tether_drag"), 0.05, lambda _text, _share: None).selection
    assert len(found.steps) == 2
    assert found.models[0].causes == () and max(len(m.causes) for m in found.models) == 2
