"""What a simulation refuses: settings, parameters, channels and shapes, each by name and all at once."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest

from rovval.core.errors import BadInput, UsageProblem
from rovval.plant import Inputs, Plant, parse_settings


def test_settings_are_refused_by_name_and_all_at_once():
    plant = Plant(cases.merlin())
    with pytest.raises(UsageProblem) as refusal:
        parse_settings(plant, ["inflow_los:loss=0.3", "thruster_degraded:loss=1", "inflow_loss:los=1", "dvl_scale:scale=9", "dvl_scale:scale=x"])
    message = str(refusal.value)
    parts = ("no effect named 'inflow_los'", "thruster_degraded[HFP]", "inflow_loss has loss", "dvl_scale.scale = 9, allowed -0.7 to 1.2")
    for part in (*parts, "'x' is not a number"):
        assert part in message
    assert parse_settings(plant, ["thruster_degraded[HFP]:loss=0.4", "waves:cosine=0.2,period=5"])[plant.index["waves.period"]] == 5


def test_out_of_bounds_parameters_are_refused_by_name():
    plant = Plant(cases.merlin())
    beta = plant.null.copy()
    beta[plant.index["dvl_scale.scale"]] = 1.5
    beta[plant.index["gyro_bias.r"]] = np.nan
    with pytest.raises(UsageProblem, match=r"(?s)dvl_scale.scale = 1.5, .*gyro_bias.r = nan"):
        cases.run(plant, beta=beta)


def test_an_effect_without_its_channel_is_refused():
    plant = Plant(cases.merlin())
    with pytest.raises(UsageProblem, match="ground_effect needs altitude"):
        cases.run(plant, beta=parse_settings(plant, ["ground_effect:gain=100"]))


@pytest.mark.parametrize("voltage", [None, np.full(11, np.nan)])
def test_a_parameter_without_its_channel_is_refused(voltage):
    plant, still = Plant(cases.merlin()), np.zeros((1, 6))
    inputs = Inputs(0.1, np.zeros((11, 7)), False, voltage=voltage)
    beta = parse_settings(plant, ["voltage_sag:gain=1,rate=1e-5"])
    with pytest.raises(UsageProblem, match=r"voltage_sag\.gain needs voltage"):
        plant.simulate(inputs, np.zeros(1, int), 5, still, still, beta[None])
    plant.simulate(inputs, np.zeros(1, int), 5, still, still, parse_settings(plant, ["voltage_sag:rate=1e-5"])[None])


def test_shapes_that_do_not_fit_are_refused_together():
    plant = Plant(cases.merlin())
    with pytest.raises(BadInput, match=r"(?s)nu0 is .*8 thruster speeds for 7.*samples 0 to 50 of a log of 11"):
        plant.simulate(Inputs(0.1, np.zeros((11, 8)), False), np.zeros(1, int), 50, np.zeros((2, 6)), np.zeros((1, 6)), plant.null[None])


def test_a_parameter_given_twice_is_refused():
    """The last one used to win in silence."""
    plant = Plant(cases.merlin())
    for settings in (["inflow_loss:loss=0.1", "inflow_loss:loss=0.2"], ["inflow_loss:loss=0.1,loss=0.2"]):
        with pytest.raises(UsageProblem, match=r"inflow_loss.loss is given twice, 0.1 and 0.2"):
            parse_settings(plant, settings)
