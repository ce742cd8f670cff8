"""Scenario 1 (thesis 4.2, tables 4.1 and 4.2): with all thrusters at zero rpm, thrust and velocity stay zero.

The thesis finds (6.2) that velocities are "almost zero" and that the vehicle "sinks to the seabed gradually over time with out
tip over": one that is trimmed a little heavy or light drifts up or down, and only that is allowed here.
"""

from __future__ import annotations

import numpy as np

from rovval.core.channels import AXES, VELOCITIES
from rovval.fly.scenarios import Check, Outcome
from rovval.fly.scenarios.still_water import swim
from rovval.vehicle.model import Vehicle

SECONDS = 60.0
ALMOST_ZERO = 1e-3  # m/s and rad/s: the noise of the thesis's own ROS simulator (6.2)
UPRIGHT_RAD = np.radians(5.0)  # chosen: far below a tip-over
SLOW_SINKING = 0.15  # m/s, chosen: "gradually"


def stability(vehicle: Vehicle, model: str) -> Outcome:
    """Let the vehicle lie still for a minute."""
    sim = swim(vehicle, np.zeros((round(SECONDS * 10) + 1, len(vehicle.thrusters))), model, "scenario-1")
    nu, tilt = np.abs(sim.free.nu).max(axis=0), np.abs(sim.free.eta[:, 3:5]).max()
    thrust = float(np.abs(sim.thrust).max())
    trim = (vehicle.weight - vehicle.buoyancy) / vehicle.weight
    way = "sinks" if trim > 0 else "rises"
    others = [i for i in range(6) if AXES[i] != "heave"]
    worst = max(others, key=lambda i: nu[i])
    checks = (
        Check("thrust is zero", f"largest {thrust:.3g} N", thrust == 0.0),
        Check(
            f"surge, sway, roll, pitch, yaw velocities below {ALMOST_ZERO:g} m/s or rad/s",
            f"largest {nu[worst]:.2g} ({AXES[worst]})",
            bool(nu[others].max() < ALMOST_ZERO),
        ),
        Check(
            f"heave only by its trim ({100 * trim:+.2f} % of its weight), slower than {SLOW_SINKING:g} m/s",
            f"{way} at up to {nu[2]:.3f} m/s",
            bool(nu[2] < SLOW_SINKING),
        ),
        Check("does not tip over", f"largest roll or pitch {np.degrees(tilt):.3f} deg", bool(tilt < UPRIGHT_RAD)),
    )
    largest = {f"max_abs_{name}": float(value) for name, value in zip(VELOCITIES, nu, strict=True)}
    return Outcome(
        1, "stability at zero rpm", vehicle.name, model, checks, document={"seconds": SECONDS, "thrust_n": thrust, **largest}
    )
