"""Scenario 1 (thesis 4.2, tables 4.1 and 4.2): with all thrusters at zero rpm, thrust and velocity stay zero.

The thesis finds (6.2) that velocities are "almost zero" and that the vehicle "sinks to the seabed gradually over time with out
tip over": one that is trimmed a little heavy or light drifts up or down, and only that is allowed here, as fast as its drag lets it. Lying still and
upright does not show whether anything keeps it so: it is let go tilted, too, and has to right itself.
"""

from __future__ import annotations

import numpy as np

from rovval.core.channels import AXES, VELOCITIES
from rovval.fly.loop.controllers import axis_of
from rovval.fly.scenarios import Check, Outcome
from rovval.fly.scenarios.speed import COUNTS
from rovval.fly.scenarios.still_water import DEPTH_M, swim
from rovval.plant import Plant
from rovval.vehicle.model import Vehicle

SECONDS = 60.0
TILT_RAD = np.radians(10.0)  # in roll and in pitch, at the beginning of the second part (chosen: well below a tip-over)
TILTED_S = 180.0  # chosen: Merlin, the most weakly damped, swings for two minutes
RIGHTED = 0.5  # of the tilt that it began with, in the last tenth of that time (chosen: without a righting moment all of it is left)
UPRIGHT_RAD = np.radians(5.0)  # chosen: far below a tip-over
TRIMMED = 0.02  # of the weight: what ballast of some hundred grams trims to (chosen; the library's vehicles lie between 1.8 % light and 0.03 % heavy)
SETTLES = 1.05  # of the speed at which drag holds the trim's force: what else pulls down would be faster (chosen: room for a platform's own steps)


def stability(vehicle: Vehicle, model: str) -> Outcome:
    """Let the vehicle lie still for a minute; then, tilted and 5 m deeper, for three."""
    sim = swim(vehicle, np.zeros((round(SECONDS * 10) + 1, len(vehicle.thrusters))), model, "scenario-1")
    nu, tilt = np.abs(sim.free.nu).max(axis=0), np.abs(sim.free.eta[:, 3:5]).max()
    thrust = float(np.abs(sim.thrust).max())
    trim = (vehicle.weight - vehicle.buoyancy) / vehicle.weight
    settles = axis_of(Plant(vehicle, model).simulated, "heave").speed(abs(vehicle.weight - vehicle.buoyancy))
    fastest = sim.free.nu[np.abs(sim.free.nu[:, 2]).argmax(), 2]
    way = "sinks" if fastest > 0 else "rises"
    others = [i for i in range(6) if AXES[i] != "heave"]
    worst = max(others, key=lambda i: nu[i])
    checks = (
        Check("thrust is zero", f"largest {thrust:.3g} N", thrust == 0.0),
        Check(
            f"surge, sway, roll, pitch, yaw velocities below {COUNTS:g} m/s or rad/s",
            f"largest {nu[worst]:.2g} ({AXES[worst]})",
            bool(nu[others].max() < COUNTS),
        ),
        Check(
            f"heave only by its trim ({100 * trim:+.2f} % of its weight), which its drag holds at {settles:.3f} m/s",
            f"{way} at up to {nu[2]:.3f} m/s",
            bool(nu[2] < COUNTS or (fastest * trim > 0 and nu[2] <= SETTLES * settles)),
        ),
        Check(f"trimmed within {100 * TRIMMED:g} % of its weight", f"{100 * trim:+.2f} %", bool(abs(trim) <= TRIMMED)),
        Check("does not tip over", f"largest roll or pitch {np.degrees(tilt):.3f} deg", bool(tilt < UPRIGHT_RAD)),
    )
    tilted = _tilted(vehicle, model)
    largest = {f"max_abs_{name}": float(value) for name, value in zip(VELOCITIES, nu, strict=True)}
    return Outcome(
        1, "stability at zero rpm", vehicle.name, model, (*checks, tilted[0]),
        document={"seconds": SECONDS, "thrust_n": thrust, **largest, "tilt_began_deg": float(np.degrees(TILT_RAD)), "tilt_left_deg": tilted[1]}, motion=sim,
    )  # fmt: skip


def _tilted(vehicle: Vehicle, model: str) -> tuple[Check, float]:
    """Whether a vehicle that is let go tilted rights itself, and the tilt in deg that is left."""
    still = np.zeros((round(TILTED_S * 10) + 1, len(vehicle.thrusters)))
    sim = swim(vehicle, still, model, "scenario-1-tilted", (0.0, 0.0, DEPTH_M + 5.0, TILT_RAD, TILT_RAD, 0.0))
    last = np.abs(sim.free.eta[-round(TILTED_S) :, 3:5])
    left = float(np.degrees(last.max()))
    seen = f"{np.degrees(TILT_RAD):g} deg of roll and pitch become {left:.2g} deg in {TILTED_S:g} s"
    return Check("rights itself when it is let go tilted", seen, bool(left < RIGHTED * np.degrees(TILT_RAD))), left
