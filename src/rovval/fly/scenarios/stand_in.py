"""A log for scenarios 4 and 5 where none was given, for any vehicle: the movement protocol flown with sensors. SYNTHETIC, and named so."""

from __future__ import annotations

from rovval.core.data import Run
from rovval.fly import fly
from rovval.fly.mission import Mission
from rovval.fly.scenarios.speed import scenario_rpm
from rovval.fly.scenarios.still_water import DEPTH_M
from rovval.vehicle.model import Vehicle

EFFECT = "inflow_loss:loss=0.3"  # what the simulator beside it does not know, as in the sample log of `rovval demo`


def stand_in(vehicle: Vehicle, rpm: float | None = None) -> Run:
    """The protocol of table 4.6 by platform fossen with `EFFECT`, the fastest thruster at ``rpm`` (default `scenario_rpm`), as its sensors see it."""
    leg = {"kind": "protocol", "rpm": scenario_rpm(vehicle, rpm)}
    plan = {"name": f"SYNTHETIC_{vehicle.name}_protocol", "start": {"depth_m": DEPTH_M}, "water": {"surface": False}, "sensors": {}, "leg": [leg]}
    return fly(Mission.model_validate(plan), vehicle, "fossen", (EFFECT,)).run(str(plan["name"]))
