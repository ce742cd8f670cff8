"""What the pilot of the sample dive commands: movements of the thesis's protocol (4.4), shorter and mixed, with rest between."""

from __future__ import annotations

import numpy as np

from rovval.core.channels import AXES
from rovval.core.data import RATE_HZ, Array
from rovval.vehicle.model import Vehicle, allocation

RAMP_S = 1.5  # chosen: a hand on a stick
TOP_RPM = 150.0  # chosen: about 0.6 m/s ahead, a brisk survey for a work-class vehicle
# (seconds, what each axis asks for as a share of the top speed); the order mixes axes so that no two always come together
LEGS: tuple[tuple[float, dict[str, float]], ...] = (
    (5.0, {}),
    (22.0, {"surge": 1.0}),
    (8.0, {}),
    (12.0, {"yaw": 0.5}),
    (15.0, {"surge": 0.6, "heave": 0.5}),
    (5.0, {}),
    (12.0, {"sway": 0.8}),
    (12.0, {"surge": -0.8}),
    (6.0, {"heave": -0.7}),
    (12.0, {"surge": 1.0, "yaw": -0.25}),
    (6.0, {}),
    (12.0, {"sway": -0.8, "heave": 0.3}),
    (20.0, {"surge": 0.8, "heave": -0.4}),
    (10.0, {"yaw": -0.5}),
    (18.0, {"surge": 0.5}),
    (5.0, {}),
)


def speeds(vehicle: Vehicle) -> Array:
    """Commanded thruster speeds (n, k), rpm at 10 Hz."""
    pushes = np.linalg.pinv(allocation(vehicle))
    wanted = np.vstack([np.tile(_wrench(leg), (round(seconds * RATE_HZ), 1)) for seconds, leg in LEGS])
    width = round(RAMP_S * RATE_HZ)
    padded = np.vstack([np.repeat(wanted[:1], width - 1, axis=0), wanted])
    smooth = np.stack([np.convolve(column, np.full(width, 1.0 / width), mode="valid") for column in padded.T], axis=1)
    share = smooth @ pushes.T
    gains = np.array([[t.k_pos, t.k_neg] for t in vehicle.thruster])
    gain = np.where(share > 0, gains[:, 0], gains[:, 1])
    rpm = np.sign(share) * np.sqrt(np.abs(share) / gain)
    return np.asarray(TOP_RPM * rpm / np.abs(rpm).max())


def _wrench(leg: dict[str, float]) -> Array:
    return np.array([leg.get(axis, 0.0) * (1.0 if axis != "yaw" else 0.4) for axis in AXES])
