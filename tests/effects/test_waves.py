"""Waves: each train is an Airy wave, and all are alike."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import plant_cases as cases
import pytest

from rovval.core.data import Array
from rovval.effects import load
from rovval.effects.library import waves
from rovval.plant import Inputs, Plant, parse_settings

FURTHER = [name.partition("_")[2] for name in load("waves").names_of("further period")]


@pytest.mark.parametrize("i", FURTHER)
@pytest.mark.parametrize("size", ["cosine", "sine"])
def test_a_further_train_is_a_wave_like_the_first(i: str, size: str):
    """Deep, moving, and with no other train about."""
    plant = Plant(cases.merlin())
    alike = f"waves:{size}=0.8,period=7,direction=0.6", f"waves:{size}_{i}=0.8,period_{i}=7,direction=0.6"
    beta = np.array([parse_settings(plant, [setting]) for setting in alike])
    nu, eta = np.zeros((2, 6)), np.zeros((2, 6))
    nu[:, 0], nu[:, 2], eta[:, 2] = 0.4, 0.1, 6.0
    out = plant.simulate(Inputs(0.1, np.zeros((101, 7)), False), np.array([0, 0]), 100, nu, eta, beta)
    np.testing.assert_allclose(out.nu[0], out.nu[1], rtol=0, atol=1e-12)
    assert np.abs(np.diff(out.nu[0, :, 2])).max() > 1e-3


def rows(**values: float) -> dict[str, Array]:
    """Rows of the kernel of waves with these parameters, the others null."""
    lanes: Any = SimpleNamespace(vehicle=cases.merlin())
    return waves.rows(lanes, {p.name: np.array([values.get(p.name, p.null)]) for p in load("waves").parameters})


def water(of: dict[str, Array], at: Array, velocity: Array) -> Array:
    """(9,) velocity of the water at a place and time (4,), its change along a path of a ``velocity`` (3,), and at a fixed point."""
    (x, y, z, t), (vn, ve, vd) = at, velocity
    found = np.zeros(9)
    for train in waves.COMPONENTS:
        own = {row: of[row + train] for row in ("a", "b", "omega", "k")}
        one = waves.water(of["north"], of["east"], **own, x=x, y=y, z=np.array([z]), t=t, vn=vn, ve=ve, vd=vd)
        found += np.concatenate([np.ravel(value) for value in one])
    return found


def test_a_regular_wave_is_that_of_the_textbook():
    """Faltinsen 1990, table 2.1, deep water: omega a e^(-kz) cos(kx - omega t) along, and omega a e^(-kz) sin(kx - omega t) upwards."""
    omega = 2.0 * np.pi / 7.0
    k = omega**2 / 9.81
    found = water(rows(cosine=0.5, period=7.0), np.array([3.0, 5.0, 4.0, 1.3]), np.zeros(3))
    speed, arg = omega * 0.5 * np.exp(-4.0 * k), 3.0 * k - 1.3 * omega
    assert found[:3] == pytest.approx([speed * np.cos(arg), 0.0, -speed * np.sin(arg)], rel=1e-3, abs=1e-12)


def test_a_sea_has_neither_sources_nor_eddies_and_its_changes_are_those_of_its_velocity():
    rng, h = np.random.default_rng(3), 1e-5
    of = rows(**{p.name: float(rng.uniform(4.0, 12.0) if "period" in p.name else rng.normal()) for p in load("waves").parameters})
    at, velocity = np.array([2.0, -3.0, 6.0, 4.0]), np.array([0.5, -0.2, 0.3])

    def slope(way: Array) -> Array:
        change: Array = (water(of, at + h * way, velocity)[:3] - water(of, at - h * way, velocity)[:3]) / (2.0 * h)
        return change

    by_x, by_y, by_z, by_t = (slope(way) for way in np.eye(4))
    assert by_x[0] + by_y[1] + by_z[2] == pytest.approx(0.0, abs=1e-6)
    assert [by_x[1] - by_y[0], by_x[2] - by_z[0], by_y[2] - by_z[1]] == pytest.approx([0.0] * 3, abs=1e-6)
    found = water(of, at, velocity)
    assert found[3:6] == pytest.approx(slope(np.array([*velocity, 1.0])), abs=1e-6)
    assert found[6:] == pytest.approx(by_t, abs=1e-6)
