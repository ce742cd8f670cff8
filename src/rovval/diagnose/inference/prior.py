"""What a healthy simulator and healthy sensors may be off by, before anything is blamed: the prior that detection stands on.

Coefficients are off by the declared calibration slop (`--calibration-slop`, one standard deviation, relative). Trim, mounting and
sensors have tolerances of their own, stated here; each is what a careful installation of an ROV reaches (chosen; data sheets beside).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rovval.core.channels import AXES
from rovval.effects.lanes import reference_drag, reference_drag_force
from rovval.plant import Plant
from rovval.vehicle.model import square

TURNING = ("linear_drag", "quadratic_drag", "added_mass", "inertia_error")  # coefficients about one axis
LIST = 0.5  # power of the same for a list (opened sets: with 1 no list under an autopilot is found, with 0.5 four of four)

RELATIVE = ("added_mass", "quadratic_drag", "inertia_error", "thruster_degraded", "reverse_asymmetry", "rpm_scale")
ASTERN = 1.4  # of the slop: ahead and astern are two numbers of the file, each off by the slop, so apart by the root of two times it
MOUNTING = 0.3  # rad per unit of slop: 5 % slop goes with thrusters mounted to within a degree
TRIM = 0.02  # of the weight per unit of slop: 5 % slop goes with a vehicle trimmed to a thousandth of its weight,
TRIM_FORCE = 0.075  # or of the drag at 1 m/s ahead, whichever is more: a light vehicle is trimmed to what its drives hardly notice (chosen)
LEVEL = 0.25  # of the metacentric height per unit of slop: 5 % slop goes with a vehicle that floats as level as its AHRS shows, 0.7 degrees,
CENTRE, CENTRE_LEVEL = 0.1, 0.025  # or of the longest thruster arm, for height and level: centres are known to 0.5 % of it (chosen)
LEAST_LEVEL = 0.01  # m per unit of slop, for level: 0.2 kg of ballast moved by 3 cm moves the centre of an 11.5 kg vehicle by half a millimetre
CURVE = 4.0  # of the typical dead band per unit of slop: 5 % slop goes with a curve that is off by as much at small commands (chosen)
SPLIT = 0.1  # m/s, rad/s: drag is known as a whole at this speed; how much of it is linear is off by as much as that (chosen)
UNKNOWN = 0.5  # m/s, rad/s: the same for an axis without linear drag in the file, where nobody has measured it (chosen)
WITHIN = 3.5  # standard deviations of tolerance that healthy coefficients reach (tuning set: 3.3 of some hundred)
STRAINED = 5.0  # standard deviations from which a coefficient is off by more than slop of the stated size
WITHOUT = (  # faults of sensors that have no tolerance of their own
    "time_offset[depth].delay",  # half a sample of it moves a depth by less than its check is held to see
    "velocity_filter_lag.dead",  # the velocity log's time offset has it
)
SENSORS = {
    "attitude_bias": 0.01,  # rad: AHRS of the class give 0.2 to 0.5 degrees static (Xsens MTi data sheets)
    "gyro_bias": 0.002,  # rad/s: 0.1 degree a second, MEMS in-run bias with temperature
    "compass_deviation": 0.03,  # rad: 2 degrees after a field calibration
    "dvl_scale": 0.005,  # sound speed known to within half a per cent
    "dvl_misalignment": 0.01,  # rad: half a degree of mounting
    "dvl_lever_arm": 0.05,  # m: measured with a tape
    "time_offset": 0.05,  # s: half a sample at 10 Hz
    "velocity_filter_lag": 0.05,  # s: half a sample
    "clock_drift": 5e-5,  # s/s: a quartz clock, 50 ppm
}


def slop_prior(plant: Plant, slop: float) -> Prior:
    """Standard deviation by plant slot of what a healthy simulator and log may be off by; empty where ``slop`` is zero."""
    if slop <= 0:
        return Prior({})
    body, sd = plant.vehicle.body, dict[int, float]()
    height = abs(body.centre_of_gravity[2] - body.centre_of_buoyancy[2])
    arm = max(float(np.linalg.norm(t.position)) for t in plant.vehicle.thruster)
    linear, quadratic = reference_drag(plant.vehicle)
    body_linear = np.diag(square(body.linear_drag))
    for i, slot in enumerate(plant.slots):
        name = slot.parameter.name
        if slot.effect == "linear_drag":
            axis = AXES.index(slot.hypothesis.partition("[")[2].rstrip("]"))
            known = body_linear[axis] > 0
            sd[i] = slop * (1.0 + (SPLIT if known else UNKNOWN) * quadratic[axis] / linear[axis])
        elif slot.effect in RELATIVE:
            sd[i] = slop * (0.5 if slot.effect == "rpm_scale" else 1.0)
        elif slot.effect == "thruster_deadband":
            sd[i] = CURVE * slop * slot.parameter.typical
        elif slot.effect == "thruster_astern":
            sd[i] = ASTERN * slop
        elif slot.effect == "thruster_misaligned":
            sd[i] = MOUNTING * slop
        elif slot.effect == "buoyancy_error":
            sd[i] = slop * max(TRIM * plant.vehicle.weight, TRIM_FORCE * reference_drag_force(plant.vehicle))
        elif slot.effect == "cg_offset":
            sd[i] = slop * (max(height, CENTRE * arm) if name == "z" else max(LEVEL * height, CENTRE_LEVEL * arm, LEAST_LEVEL))
        elif slot.effect in SENSORS and slot.key not in WITHOUT:
            sd[i] = SENSORS[slot.effect]
    return Prior(sd)


@dataclass(frozen=True, slots=True)
class Prior:
    """Standard deviation of the departure of columns from where the model stands; columns not named do not move."""

    sd: Mapping[int, float]

    def widened(self, other: Prior) -> Prior:
        """Both sets free; a column in both takes the wider prior."""
        merged = dict(self.sd)
        for column, value in other.sd.items():
            merged[column] = max(value, merged.get(column, 0.0))
        return Prior(merged)


def loosened(prior: Prior, plant: Plant, gain: Mapping[str, float]) -> Prior:
    """The tolerances of what turns the vehicle about a steadied axis, and of how stiffly it rights itself, times 1 + loop gain; of a
    list, which is as steady as the moment that an autopilot gives against it, times less (`LIST`)."""
    sd = dict(prior.sd)
    for s in sd:
        slot = plant.slots[s]
        if slot.effect == "cg_offset":
            sd[s] *= (1.0 + max(gain.values())) ** (1.0 if slot.parameter.name == "z" else LIST)
        elif slot.effect in TURNING:
            sd[s] *= 1.0 + gain.get(slot.hypothesis.partition("[")[2].rstrip("]"), 0.0)
    return Prior(sd)
