"""A twisted tether."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnose_case import LIBRARY, logged, merlin, own, with_values

from rovval.blind.plant.spec import Planted
from rovval.blind.second.flight import fly
from rovval.core.errors import UsageProblem
from rovval.diagnose import diagnose
from rovval.plant import Inputs, Plant, parse_settings
from rovval.plant.stepping import Stepper
from rovval.simulation.actuation import recorded_actuation


def test_the_turns_of_a_log_are_counted_and_begin_at_its_start():
    run = own((), 5, 100.0)
    yaw = 1.0 + np.linspace(0.0, -15.0, len(run))
    logged = with_values(run, psi=np.mod(yaw + np.pi, 2.0 * np.pi) - np.pi)
    turned = recorded_actuation(logged, merlin()).inputs.turned
    assert turned == pytest.approx(yaw - yaw[0])


def test_it_turns_the_vehicle_back_by_stiffness_times_turns():
    """Against a constant moment of that size."""
    plant, n = Plant(merlin()), 20
    still, eta, nu = np.zeros((n, len(plant.vehicle.thrusters))), np.zeros((1, 6)), np.zeros((1, 6))
    moment = np.zeros((1, n, 6))
    moment[..., 5] = -3.0 * 6.0
    beta = parse_settings(plant, ["tether_torsion:stiffness=3"])[None]
    wound = plant.simulate(Inputs(0.1, still, False, turned=np.full(n, 6.0)), np.zeros(1, int), n - 1, nu, eta, beta)
    pushed = plant.simulate(Inputs(0.1, still, False, extra=moment), np.zeros(1, int), n - 1, nu, eta, plant.null[None], np.zeros(1, int))
    assert wound.nu == pytest.approx(pushed.nu, abs=1e-9) and wound.nu[0, -1, 5] < 0.0


def test_a_closed_loop_counts_its_own_turns():
    plant, steps = Plant(merlin(), substeps=2), 600
    speed = np.zeros((1, len(plant.vehicle.thrusters)))
    nu = np.array([[0.0, 0.0, 0.0, 0.0, 0.0, 1.0]])
    stepper = Stepper(plant, parse_settings(plant, ["tether_torsion:stiffness=5"])[None], nu, np.zeros((1, 6)), 0.1)
    rate = []
    for _ in range(steps):
        stepper.step(speed)
        rate.append(float(stepper.nu[0, 5]))
    turned = np.concatenate([[0.0], np.cumsum(rate)]) * 0.1
    assert min(rate) < -0.01, "it swings back"
    whole = plant.simulate(
        Inputs(0.1, np.zeros((steps + 1, speed.shape[1])), False, turned=turned), np.zeros(1, int), steps, nu, np.zeros((1, 6)),
        parse_settings(plant, ["tether_torsion:stiffness=5"])[None],
    )  # fmt: skip
    assert np.array(rate) == pytest.approx(whole.nu[0, 1:, 5], abs=0.03)


@pytest.mark.slow
def test_another_plant_s_twisted_tether_is_named_with_its_stiffness(tmp_path: Path):
    flight = fly(LIBRARY / "merlin.toml", "pirouette", [Planted("twisted_tether", None, 1.0)], 7000, 200.0)
    [cause] = diagnose([logged(flight, tmp_path / "second.csv")], merlin()).causes
    assert cause.effect == "tether_torsion" and cause.probability > 0.9
    assert cause.parameters["stiffness"].value == pytest.approx(flight.truth["effects"][0]["values"]["stiffness"], rel=0.1)


@pytest.mark.slow
def test_a_steady_moment_is_not_told_as_this():
    """Thrusters that point a little askew, or a propeller's torque."""
    causes = diagnose([own(("propeller_torque:common=0.05",), 3, 300.0)], merlin()).causes
    assert "tether_torsion" not in {c.effect for c in causes}


def test_without_a_heading_it_is_refused():
    with pytest.raises(UsageProblem, match="needs psi"):
        own(("tether_torsion:stiffness=8",), 3, 20.0)
