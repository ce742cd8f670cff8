"""The plant: two platform models of a vehicle with every effect of the library in them, run over a batch of lanes at once.

>>> plant = Plant(vehicle.load("merlin"))
>>> beta = parse_settings(plant, ["inflow_loss:loss=0.3"])
>>> motion = plant.simulate(inputs, start, steps, nu0, eta0, beta[None], extra, extra_gain)
"""

from __future__ import annotations

from rovval.plant.inputs import Inputs
from rovval.plant.model import Motion, Plant, parse_settings
from rovval.plant.slots import Slot

__all__ = ["Inputs", "Motion", "Plant", "Slot", "parse_settings"]
