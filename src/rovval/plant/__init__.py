"""The plant: the platforms' models of a vehicle with every effect of the library in them, run over a batch of lanes at once.

A lane is a stretch of a run with its own parameter vector. Its entries, the slots, are the parameters of every effect, axes and thrusters spelt out;
at their null values nothing is changed, to the last bit.

>>> plant = Plant(vehicle.load("merlin"))
>>> beta = parse_settings(plant, ["inflow_loss:loss=0.3"])
>>> motion = plant.simulate(inputs, start, steps, nu0, eta0, beta[None], extra, extra_gain)

How one simulation goes, file by file: `arguments` are checked and the log's `inputs` made ready; `lowering` takes the parameters (`slots`) to numbers
of the vehicle (mass, drag, gains ...) and of the effects' own functions; `sensors` and `sensor_delay` find the true first state behind the measured
one; `integration` runs the kernel over blocks of lanes; `sensors` write the log. `model` has it all in order.

The equations stand twice. `codegen.kernel` is what runs: typed Python of which `codegen` makes one compiled function for each kind of vehicle.
`reference` is the same in plain NumPy, matrix by matrix as the thesis has it (3.10 to 3.15); tests hold the two against each other.
`platforms` has one file a simulator whose equations these are: fossen, uuv, freefloating.
`geometry` says which thruster's jet reaches which.
"""

from __future__ import annotations

from rovval.plant.inputs import Inputs
from rovval.plant.model import Motion, Plant, parse_settings
from rovval.plant.slots import Slot

__all__ = ["Inputs", "Motion", "Plant", "Slot", "parse_settings"]
