"""The audit: each number that no vehicle has is one problem, by itself, and a sound vehicle has none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from plant_cases import changed

from rovval.core.channels import AXES
from rovval.vehicle import load, parse
from rovval.vehicle.audit import audit, uncontrolled_axes, unsourced
from rovval.vehicle.model import PulseTable
from rovval.vehicle.write import to_toml

MERLIN, BLUEROV2 = load("merlin"), load("bluerov2_heavy")
HALF = np.diag([1468.0, 1468.0, 1468.0, 122.0, 223.0, 213.0])
HALF[0, 1] = 300.0  # and nothing at [1, 0]
CURL = np.diag([150.0, 200.0, 200.0, 100.0, 100.0, 50.0])
CURL[0, 1] = CURL[1, 0] = 400.0  # symmetric, but larger than the diagonal: some motions are driven


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ({"Ixx": -5.0}, "inertia tensor is not positive definite"),
        ({"Izz": 99999.0}, "breaks the triangle rule"),
        ({"added_mass": tuple(map(tuple, HALF))}, "added_mass is not symmetric"),
        ({"added_mass": (-100.0, 1468.0, 1468.0, 122.0, 223.0, 213.0)}, "added_mass has a negative diagonal"),
        ({"quadratic_drag": (1500.0, 2000.0, 2000.0, -500.0, 500.0, 500.0)}, "quadratic_drag is negative on roll"),
        ({"linear_drag": tuple(map(tuple, CURL)), "quadratic_drag": (0.0,) * 6}, "damping feeds energy in"),
        ({"linear_drag": (0.0, 200.0, 200.0, 100.0, 100.0, 50.0), "quadratic_drag": (0.0,) + (500.0,) * 5}, "no damping at all on surge"),
        ({"volume": 2.86e-3}, "is volume in m3?"),
        ({"centre_of_buoyancy": (0.0, 0.0, 0.1)}, "would float upside down"),
    ],
)  # fmt: skip
def test_a_body_that_cannot_be_is_one_problem(body: dict[str, Any], words: str):
    (problem,) = audit(changed(MERLIN, **body))
    assert words in problem


def test_thrusters_of_one_name_or_with_a_direction_that_is_none_are_problems():
    first, second, *others = MERLIN.thruster
    (problem,) = audit(MERLIN.model_copy(update={"thruster": (first, second.model_copy(update={"name": first.name}), *others)}))
    assert problem == f"thruster names repeat: {first.name}"
    (problem,) = audit(MERLIN.model_copy(update={"thruster": (first.model_copy(update={"direction": (0.0, 1.0, 1.0)}), second, *others)}))
    assert "VFP: direction has length 1.4142" in problem


def test_commands_that_do_not_fit_the_thrusters_are_problems():
    assert BLUEROV2.mixer is not None and BLUEROV2.pulse_table is not None
    mixer = BLUEROV2.mixer.model_copy(update={"factors": {"surge": (1.0, 1.0), "rudder": (0.0,) * 8}})
    table = PulseTable.model_construct(**BLUEROV2.pulse_table.model_dump() | {"pwm_us": BLUEROV2.pulse_table.pwm_us[::-1]})
    found = audit(BLUEROV2.model_copy(update={"mixer": mixer, "pulse_table": table}))
    assert len(found) == 3
    for problem, words in zip(found, ("'surge' has 2 factors for 8 thrusters", "unknown stick 'rudder'", "pwm_us must increase"), strict=True):
        assert words in problem


def negated(rows: dict[str, tuple[float, ...]]) -> dict[str, tuple[float, ...]]:
    return {stick: tuple(-f for f in row) for stick, row in rows.items()}


def test_a_stick_that_drives_a_thruster_against_itself_is_a_problem():
    assert BLUEROV2.mixer is not None
    sway = BLUEROV2.mixer.factors["sway"]
    factors = BLUEROV2.mixer.factors | {"sway": (-sway[0], *sway[1:])}
    (problem,) = audit(BLUEROV2.model_copy(update={"mixer": BLUEROV2.mixer.model_copy(update={"factors": factors, "frame": None})}))
    assert problem.startswith("mixer: stick 'sway' drives T1 against it: factor -1, but 1 N of its positive thrust gives 0.707 N of sway")


def test_a_vehicle_turned_over_as_a_whole_is_told_from_its_frame():
    """Directions and factors both negated steer the same way, with the strong and the weak side of every thruster swapped."""
    assert BLUEROV2.mixer is not None
    thrusters = tuple(t.model_copy(update={"direction": tuple(-x for x in t.direction)}) for t in BLUEROV2.thruster)
    mixer = BLUEROV2.mixer.model_copy(update={"factors": negated(BLUEROV2.mixer.factors)})
    found = audit(BLUEROV2.model_copy(update={"thruster": thrusters, "mixer": mixer}))
    assert len(found) == 6 and all("ArduSub's frame vectored_6dof has" in problem for problem in found)
    (problem,) = audit(BLUEROV2.model_copy(update={"mixer": BLUEROV2.mixer.model_copy(update={"frame": "vectored_7dof"})}))
    assert problem == "mixer: unknown frame 'vectored_7dof', known: vectored, vectored_6dof"


def test_gains_with_their_strong_side_where_the_table_has_its_weak_one_are_a_problem():
    first, *others = BLUEROV2.thruster
    swapped = first.model_copy(update={"k_pos": first.k_neg, "k_neg": first.k_pos})
    (problem,) = audit(BLUEROV2.model_copy(update={"thruster": (swapped, *others)}))
    assert problem.startswith("thruster T1: k_pos and k_neg have their strong side where pulse_table has its weak one")


def test_a_pulse_table_without_speeds_is_sound():
    assert BLUEROV2.pulse_table is not None
    bare = BLUEROV2.model_copy(update={"pulse_table": BLUEROV2.pulse_table.model_copy(update={"rpm": None})})
    assert audit(bare) == () and parse(to_toml(bare), "bare") == bare


def test_a_number_without_a_source_is_named():
    bare = MERLIN.model_copy(update={"sources": {k: v for k, v in MERLIN.sources.items() if k not in ("volume", "thruster.rpm_max")}})
    assert unsourced(bare) == ("volume", "thruster.rpm_max")


def test_axes_that_no_thruster_reaches_are_named():
    upright = tuple(t for t in MERLIN.thruster if t.direction[2])
    assert set(uncontrolled_axes(MERLIN.model_copy(update={"thruster": upright}))) >= {"surge", "sway", "yaw"}
    assert uncontrolled_axes(BLUEROV2) == () and set(AXES) >= set(uncontrolled_axes(MERLIN))
