"""Which names are right for what was planted, and which numbers."""

from __future__ import annotations

import re

import pytest
from blind_case import cause, planted

from rovval import vehicle
from rovval.blind.planted.catalogue import catalogue, names
from rovval.blind.scoring import ground_truth
from rovval.diagnose.result.diagnosis import Cause
from rovval.plant import Plant

MERLIN = vehicle.LIBRARY / "merlin.toml"


ALIASES = [
    (planted("inertia_error", "surge", relative=0.2), cause("payload_change"), True),
    (planted("inertia_error", "yaw", relative=0.2), cause("added_mass[yaw]"), True),
    (planted("inertia_error", "yaw", relative=0.2), cause("added_mass[roll]"), False),
    (planted("added_mass", "pitch"), cause("inertia_error[pitch]"), True),
    (planted("added_mass", "surge"), cause("inertia_error[surge]"), False),
    (planted("thruster_degraded", "HFP", loss=0.5), cause("thruster_fault_onset[HFP]", onset=4.0), True),
    (planted("thruster_degraded", "HFP", loss=0.5), cause("thruster_fault_onset[HFP]", onset=0.0), True),
    (planted("thruster_degraded", "HFP", loss=0.5), cause("thruster_fault_onset[HFP]", onset=90.0), False),
    (planted("thruster_degraded", "HFP", loss=0.5), cause("thruster_fault_onset[HFS]", onset=4.0), False),
    (planted("thruster_fault_onset", "HFP", loss=0.5), cause("thruster_degraded[HFP]"), False),
    (planted("thruster_degraded", "HFP", loss=1.0), cause("thruster_reversed[HFP]", fraction=0.48), False),
    (planted("thruster_interaction", "HFP", loss=0.6), cause("thruster_interaction[HFP]"), True),
    (planted("thruster_interaction", "HFP", loss=0.6), cause("thruster_interaction[VFP]"), False),
    (planted("thruster_interaction", "HFP", loss=0.6), cause("thruster_degraded[HFP]"), False),
    (planted("time_offset", "velocity", delay_s=0.4), cause("time_offset[velocity]"), True),
    (planted("time_offset", "velocity", delay_s=0.4), cause("time_offset"), False),
    (planted("time_offset", "velocity", delay_s=0.4), cause("velocity_filter_lag"), False),
    (planted("time_offset", "thruster_feedback", delay_s=0.4), cause("time_offset"), True),
    (planted("time_offset", "thruster_feedback", delay_s=0.4), cause("time_offset[velocity]"), False),
    (planted("time_offset", "attitude", delay_s=0.4), cause("time_offset[attitude]"), True),
    (planted("time_offset", "attitude", delay_s=0.4), cause("time_offset"), False),
    (planted("time_offset", "attitude", delay_s=0.4), cause("velocity_filter_lag"), False),
    (planted("time_offset", "depth", delay_s=0.4), cause("time_offset[depth]"), True),
    (planted("velocity_filter_lag", None), cause("time_offset"), False),
    (planted("current_constant", None), cause("current_varying"), False),
    (planted("added_mass", "sway"), cause("added_mass[translation]"), True),
    (planted("quadratic_drag", "yaw", coefficient=1.0), cause("quadratic_drag[rotation]"), True),
    (planted("quadratic_drag", "yaw", coefficient=1.0), cause("quadratic_drag[translation]"), False),
    (planted("quadratic_drag", "yaw", coefficient=1.0), cause("linear_drag[rotation]"), False),
    (planted("added_mass", "translation"), cause("added_mass[heave]"), True),
    (planted("added_mass", "translation"), cause("added_mass[translation]"), True),
    (planted("added_mass", "translation"), cause("added_mass[rotation]"), False),
    (planted("sticky_thruster", "HFP"), cause("thruster_sticking[HFP]"), True),
    (planted("sticky_thruster", "HFP"), cause("thruster_sticking[HFS]"), False),
    (planted("water_leak", None), cause("buoyancy_drift"), True),
    (planted("manipulator", None), cause("moving_tool"), True),
    (planted("dry_friction", None), cause("dragged_load"), True),
    ({"name": "sliding_battery", "place": "foreign", "target": None}, cause("shifting_ballast"), True),  # of the second plant
    ({"name": "ventilation", "place": "foreign", "target": None}, cause("ventilation"), True),
]


@pytest.mark.parametrize(("effect", "said", "same"), ALIASES, ids=[f"{e['name']}-{c['effect']}-{s}" for e, c, s in ALIASES])
def test_aliases_are_few(effect, said, same):
    assert ground_truth.accepts(effect, Cause.model_validate(said)) is same


def test_every_planted_name_is_a_hypothesis_of_the_library():

    known = set(Plant(vehicle.load("merlin")).hypotheses)
    for name in names(foreign=False):
        targets = catalogue()[name].targets
        for target in ("HFP",) if targets == ("thruster",) else targets or (None,):
            assert ground_truth.name(planted(name, target)) in known


@pytest.mark.parametrize(("target", "speeds"), [("surge", "u"), ("rotation", "pqr")])
def test_drag_goes_with_the_speeds_of_its_axes(target: str, speeds: str) -> None:
    """Plant b plants it on one axis and on several at once."""
    pattern = ground_truth.goes_with(planted("quadratic_drag", target))
    assert pattern is not None
    assert [c for c in "uvwpqr" if re.search(pattern, f"|{c}|")] == list(speeds)
