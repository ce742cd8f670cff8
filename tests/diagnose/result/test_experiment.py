"""What to fly next: manoeuvres that a vehicle can fly, as schedules of thruster speeds."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import posed

from rovval.diagnose.result.experiment import Experiment, best
from rovval.diagnose.result.manoeuvres import Helm, bank
from rovval.vehicle import load
from rovval.vehicle.model import Vehicle, allocation


@pytest.fixture(params=["merlin", "bluerov2_heavy"])
def helm(request: pytest.FixtureRequest) -> Helm:
    vehicle = load(request.param)
    return Helm(vehicle, np.linspace(10.0, 20.0, len(vehicle.thrusters)))


def wrench(vehicle: Vehicle, speed: tuple[float, ...]) -> np.ndarray:
    """Force and moment (6,) of thruster speeds in rev/s, at rest in the water."""
    n = np.array(speed)
    gain = np.where(n >= 0, [t.k_pos for t in vehicle.thruster], [t.k_neg for t in vehicle.thruster])
    return allocation(vehicle) @ (gain * (60.0 * n) * np.abs(60.0 * n))


@pytest.mark.parametrize("share", [0.4, -0.8])
def test_a_push_is_a_force_on_its_axis_alone(helm: Helm, share: float):
    for at, axis in enumerate(("surge", "sway", "heave")):
        force = wrench(helm.vehicle, helm.push(axis, share))
        assert np.sign(force[at]) == np.sign(share)
        assert np.abs(np.delete(force, at)).max() < 1e-6 * abs(force[at])


def test_no_thruster_is_asked_for_more_than_the_log_shows(helm: Helm):
    for manoeuvre in bank(helm):
        for leg in manoeuvre.legs:
            assert leg.seconds > 0 and np.all(np.abs(leg.speed) <= helm.most_speed * (1 + 1e-9)), manoeuvre.name


def test_manoeuvres_have_names_of_their_own_and_last_a_minute_or_more(helm: Helm):
    found = bank(helm)
    assert len({m.name for m in found}) == len(found)
    assert all(60.0 <= sum(leg.seconds for leg in m.legs) <= 300.0 for m in found)


def test_the_schedule_is_told_in_rpm_leg_after_leg(helm: Helm):
    experiment = Experiment(bank(helm)[0], ("inflow_loss", "quadratic_drag[surge]"), 3.0)
    schedule = experiment.schedule(helm.vehicle.thrusters)
    assert schedule.unit == "rpm" and [leg.t_s for leg in schedule.schedule] == [0.0, 20.0, 30.0, 50.0, 60.0, 80.0]
    first = schedule.schedule[0].thrusters
    assert list(first.values()) == pytest.approx([60.0 * s for s in experiment.manoeuvre.legs[0].speed], abs=0.05)
    assert set(first) == set(helm.vehicle.thrusters) and not any(schedule.schedule[1].thrusters.values())
    assert experiment.summary().separates == ("inflow_loss", "quadratic_drag[surge]")


def test_a_member_of_a_group_is_flown_without_what_the_log_does_not_hold():
    """The sag of a supply has a loss by the logged voltage beside a steady one: a log without voltage can still be told by the latter."""
    problem, _ = posed(("rpm_scale:scale=0.1",))
    beta = problem.origin.copy()
    beta[[slot.key for slot in problem.plant.slots].index("rpm_scale.scale")] = 0.1
    found = best(problem, beta, ("rpm_scale", "voltage_sag"), np.full(len(problem.plant.vehicle.thrusters), 10.0))
    assert found is not None and found.separates == ("rpm_scale", "voltage_sag")
