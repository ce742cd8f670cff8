"""Vehicles, inputs and parameter draws that the tests of the plant share."""

from __future__ import annotations

import functools

import numpy as np

from rovval import vehicle
from rovval.plant import Inputs, Plant
from rovval.vehicle.model import Body, Thruster, Vehicle, Water


@functools.cache
def merlin():
    return vehicle.load("merlin")


def changed(v: Vehicle, **body) -> Vehicle:
    """The vehicle with other body numbers, not audited."""
    return v.model_copy(update={"body": v.body.model_copy(update=body)})


def random_vehicle(rng: np.random.Generator, thrusters: int = 5) -> Vehicle:
    """Dense matrices, an inertia that a body can have, thrusters anywhere with an advance-ratio law."""
    mass = rng.uniform(10, 500)
    points = rng.normal(size=(20, 3)) * rng.uniform(0.1, 0.6, 3)
    cog = points.mean(axis=0)
    inertia = mass / 20 * (np.einsum("ni,ni->", points, points) * np.eye(3) - points.T @ points)
    root = rng.normal(size=(6, 6)) * 0.3
    scale = np.sqrt(np.array([mass, mass, mass, *np.diag(inertia)]) * rng.uniform(0.1, 1, 6))
    added = (root @ root.T + np.eye(6)) * np.outer(scale, scale)
    drag = np.diag(rng.uniform(1, 3, 6)) + rng.normal(size=(6, 6)) * 0.05
    size = np.array([50.0, 50, 50, 10, 10, 10])
    rows = []
    for i in range(thrusters):
        direction = rng.normal(size=3)
        rows.append(
            Thruster(
                name=f"A{i}", position=tuple(rng.normal(size=3) * 0.4), direction=tuple(direction / np.linalg.norm(direction)),
                k_pos=rng.uniform(1e-6, 5e-6), k_neg=rng.uniform(1e-6, 5e-6), diameter=rng.uniform(0.05, 0.3),
                advance_pos=tuple(rng.normal(size=3) * 0.5), advance_neg=tuple(rng.normal(size=3) * 0.5), handedness=(-1) ** i,
            )
        )  # fmt: skip
    body = Body(
        mass=mass, Ixx=inertia[0, 0], Iyy=inertia[1, 1], Izz=inertia[2, 2], Ixy=-inertia[0, 1], Ixz=-inertia[0, 2], Iyz=-inertia[1, 2],
        added_mass=tuple(map(tuple, added)), linear_drag=tuple(map(tuple, drag * size)), quadratic_drag=tuple(map(tuple, drag * size * 3)),
        volume=mass / 1000 * rng.uniform(0.95, 1.05), centre_of_gravity=tuple(cog), centre_of_buoyancy=tuple(cog - [0, 0, 0.05]),
    )  # fmt: skip
    return Vehicle(name="random", body=body, water=Water(density=1025.0, gravity=9.81), thruster=tuple(rows))


def random_inputs(rng: np.random.Generator, plant: Plant, samples: int = 400, hold: bool = False) -> Inputs:
    """Steps of thruster speed of a size that suits the vehicle, and every other channel."""
    k = len(plant.vehicle.thruster)
    gain = plant.thrust(np.ones((1, k)))[0].mean()
    full = np.sqrt(plant.vehicle.weight * 0.1 / k / gain)
    speed = np.repeat(rng.normal(size=(samples // 10 + 1, k)), 10, axis=0)[:samples] * full
    return Inputs(
        dt=0.1, speed=speed, hold=hold, altitude=rng.uniform(0.2, 3, samples), wall_distance=rng.uniform(0.2, 3, samples),
        voltage=rng.uniform(14, 17, samples), tether_length=rng.uniform(0, 100, samples), turned=np.linspace(-7, 7, samples),
        extra=rng.normal(size=(3, samples, 6)) * plant.vehicle.weight * 0.01,
    )  # fmt: skip


def random_states(rng: np.random.Generator, lanes: int):
    """Measured first velocities and poses, pitch kept off 90 degrees only because Euler angles compare badly there."""
    nu, eta = rng.normal(size=(lanes, 6)) * 0.2, rng.normal(size=(lanes, 6)) * [5, 5, 2, 0.4, 0.4, 2]
    eta[:, 2] += 10
    return nu, eta


def random_beta(rng: np.random.Generator, plant: Plant, extra_lanes: int):
    """One lane per hypothesis with its parameters drawn from the prior, then lanes with eight parameters each."""
    lanes = [list(c) for c in plant.hypotheses.values()]
    lanes += [list(rng.choice(len(plant.slots), 8, replace=False)) for _ in range(extra_lanes)]
    beta = np.tile(plant.null, (len(lanes), 1))
    for b, columns in enumerate(lanes):
        for c in columns:
            p = plant.slots[c].parameter
            value = rng.uniform(0, 40) if p.name == "onset" else p.null + rng.normal() * p.typical
            beta[b, c] = np.clip(value, p.low, p.high)
    return beta


def run(plant: Plant, speed=None, *, seconds=1.0, dt=0.1, nu=None, eta=None, beta=None, hold=True):
    """One lane from rest (or from ``nu``, ``eta``) with constant thruster speeds."""
    steps = round(seconds / dt)
    k = len(plant.vehicle.thruster)
    speeds = np.tile(np.zeros(k) if speed is None else speed, (steps + 1, 1))
    first = [np.zeros((1, 6)) if x is None else np.atleast_2d(np.asarray(x, float)) for x in (nu, eta)]
    b = plant.null if beta is None else beta
    return plant.simulate(Inputs(dt, speeds, hold), np.zeros(1, int), steps, first[0], first[1], b[None])
