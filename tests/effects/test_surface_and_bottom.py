"""What the surface and the bottom do to a vehicle that meets them, by Archimedes and by its own weight."""

from __future__ import annotations

import numpy as np
import pytest

from rovval import vehicle
from rovval.plant import Inputs, Plant, parse_settings
from rovval.vehicle.model import Vehicle


def drift(rov: Vehicle, settings: list[str], seconds: float, depth: float, velocity: tuple[float, ...] = (0.0,) * 6) -> tuple[np.ndarray, np.ndarray]:
    """Velocity and pose (n, 6) of a vehicle that is let go with its thrusters still."""
    plant, steps = Plant(rov, substeps=4), round(10 * seconds)
    speed = np.zeros((steps + 1, len(rov.thruster)))
    out = plant.simulate(Inputs(0.1, speed, False), np.zeros(1, int), steps, np.array([velocity]), np.array([[0, 0, depth, 0, 0, 0.7]]),
                         parse_settings(plant, settings)[None])  # fmt: skip
    assert out.stopped[0] == -1, out.why
    return out.nu[0], out.eta[0]


def trimmed(name: str, times: float) -> Vehicle:
    """A vehicle of the library with its volume so many times its own."""
    rov = vehicle.load(name)
    return rov.model_copy(update={"body": rov.body.model_copy(update={"volume": times * rov.body.mass / rov.water.density})})


@pytest.mark.parametrize("name", ["merlin", "bluerov2_heavy", pytest.param("minerva", marks=pytest.mark.slow)])
def test_a_light_vehicle_floats_with_its_weight_of_water_displaced(name):
    """Without the surface it rises for ever; with it, it comes to rest where the part under water displaces its mass (Archimedes)."""
    light = trimmed(name, 1.25)
    _, flown = drift(light, [], 60, 5.0)
    assert flown[-1, 2] < -5.0
    nu, pose = drift(light, ["free_surface:share=1"], 120, 5.0)
    assert np.abs(nu[-1]).max() < 0.02
    assert pose[-1, 2] == pytest.approx((1 / 1.25 - 0.5) * light.body.size[2], abs=0.01)


def test_a_level_of_the_surface_shifts_all_depths():
    light = trimmed("bluerov2_heavy", 1.25)
    _, here = drift(light, ["free_surface:share=1"], 20, 1.0)
    _, there = drift(light, ["free_surface:share=1,level=30"], 20, 31.0)
    np.testing.assert_allclose(there[:, 2] - 30.0, here[:, 2], atol=1e-9)


@pytest.mark.parametrize("name", ["merlin", "bluerov2_heavy", pytest.param("minerva", marks=pytest.mark.slow)])
def test_a_heavy_vehicle_comes_to_lie_on_the_bottom(name):
    """It sinks in by its net weight over the stiffness, no further, and friction stops it."""
    heavy = trimmed(name, 0.95)
    nu, pose = drift(heavy, ["seabed:firmness=1,depth=8"], 90, 5.0, (0.3, 0.0, 0.0, 0.0, 0.0, 0.0))
    sunk = 0.05 * (1 - heavy.buoyancy / heavy.weight)
    assert np.abs(nu[-1]).max() < 1e-3
    assert pose[-1, 2] == pytest.approx(8.0 - 0.5 * heavy.body.size[2] + sunk, abs=1e-3)
    assert np.hypot(*(pose[-1, :2] - pose[-300, :2])) < 0.01


def test_the_bottom_never_pulls_and_gives_no_energy():
    """Thrown at the bottom a neutral vehicle leaves it slower than it came, and is pushed up alone."""
    neutral = trimmed("bluerov2_heavy", 1.0)
    nu, pose = drift(neutral, ["seabed:firmness=1,depth=5.75"], 20, 5.5, (0.2, 0.1, 0.8, 0.0, 0.0, 0.0))
    assert pose[:, 2].max() > 5.75 - 0.127
    speed = np.linalg.norm(nu[:, :3], axis=1)
    assert (np.diff(speed[pose[:, 2] < 5.75 - 0.127]) < 1e-9).all(), "it grows nowhere off the bottom"
    assert speed[-1] < 0.5 * speed[0]


def test_away_from_both_nothing_changes_to_the_last_bit():
    rov, start = vehicle.load("merlin"), (0.5, -0.2, 0.1, 0.0, 0.05, 0.1)
    nu, pose = drift(rov, [], 10, 20.0, start)
    nu_there, pose_there = drift(rov, ["free_surface:share=1", "seabed:firmness=1,depth=40"], 10, 20.0, start)
    np.testing.assert_array_equal(nu, nu_there)
    np.testing.assert_array_equal(pose, pose_there)
