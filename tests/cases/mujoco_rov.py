"""A BlueROV2-like vehicle in MuJoCo, flown by hand: logs of another simulator, whose faults are known.

Nothing of its motion is rovval's: MuJoCo integrates a body of nine parts, each an ellipsoid of its own in the water (blunt and slender drag, viscous torque,
lift and the moment of virtual mass), where rovval has one body with linear and quadratic drag by axis. The vehicle is off its published file
(`bluerov2_heavy`) in everything: drag, added mass, thrust, its curve and its loss in the flow, height of the thrusters, trim, latency.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rovval import load
from rovval import vehicle as library
from rovval.core.data import Run

Array = NDArray[np.float64]

STEP_S, SAMPLE_S, SECONDS = 0.005, 0.1, 120.0
MASS, INERTIA, GRAVITY = 11.5, (0.22, 0.24, 0.30), 9.82  # kg, kg m2, m/s2: dry
PARTS = (  # type, half sizes (m), place (m, forward-port-up) and turn (degrees) of the hull's parts
    ("cylinder", ".055 .16", "0 0 .02", "0 90 0"), ("cylinder", ".045 .13", "0 0 -.06", "0 90 0"),
    ("box", ".12 .05 .025", ".1 .11 .09", "0 0 0"), ("box", ".12 .05 .025", ".1 -.11 .09", "0 0 0"),
    ("box", ".1 .05 .025", "-.11 .11 .09", "0 0 0"), ("box", ".1 .05 .025", "-.11 -.11 .09", "0 0 0"),
    ("box", ".22 .006 .11", "0 .165 0", "0 0 0"), ("box", ".22 .006 .11", "0 -.165 0", "0 0 0"), ("box", ".17 .16 .006", "0 0 -.11", "0 0 0"),
)  # fmt: skip
CHANNELS = ("u", "v", "w", "p", "q", "r", "phi", "theta", "psi", "x", "y", "z")
NOISE = (0.008,) * 3 + (0.004,) * 3 + (0.003,) * 3 + (0.008,) * 3  # m/s, rad/s, rad, m
TURNED = np.diag([1.0, -1.0, -1.0])  # forward-port-up to forward-starboard-down
WORLD = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])  # east-north-up to north-east-down

PROFILE = """name = "mujoco_rov"
description = "a vehicle in MuJoCo"
format = "csv_log"
vehicle = "bluerov2_heavy"
frame = "fsd"
world = "ned"
[time]
kind = "elapsed"
columns = ["t"]
unit = "s"
[channels]
""" + "\n".join(
    f'{c} = {{ column = "{c}", unit = "{unit}" }}' for c, unit in zip(CHANNELS, ("m/s",) * 3 + ("rad/s",) * 3 + ("rad",) * 3 + ("m",) * 3, strict=True)
) + '\n"pwm:T*" = { column = "pwm_T*", unit = "pwm_us" }\n'  # fmt: skip


@dataclass(frozen=True, slots=True)
class Fault:
    """What is wrong: ``gain`` of single thrusters by number, of all (``thrust``) and of thrust astern; ``dead`` band (N) of the thrusters and their ``lag``
    (s); ``buoyancy`` (N) and ``centre`` of gravity (m) beyond the vehicle's; a ``plate`` across the bow; ``water`` that moves (m/s, east-north-up); a
    ``weight`` (N) from the middle of the log on; of the log: velocities ``late`` (s), ``turned`` (rad) and ``scaled``, a bias of ``roll`` (rad) and of the
    rate of ``yaw`` (rad/s)."""

    gain: Mapping[int, float] = field(default_factory=dict)
    thrust: float = 1.0
    astern: float = 1.0
    dead: float = 0.0
    lag: float | None = None
    buoyancy: float = 0.0
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0)
    plate: bool = False
    water: tuple[float, float, float] = (0.0, 0.0, 0.0)
    weight: float = 0.0
    late: float = 0.0
    turned: float = 0.0
    scaled: float = 1.0
    roll: float = 0.0
    yaw: float = 0.0


class Rov:
    """One vehicle, drawn by its ``seed``."""

    def __init__(self, seed: int) -> None:
        self.seed, draw = seed, np.random.default_rng([seed, 0])
        file = library.load("bluerov2_heavy")
        self.place = np.array([t.position for t in file.thruster]) @ TURNED
        self.way = np.array([t.direction for t in file.thruster]) @ TURNED
        self.place[:4, 2] = -draw.uniform(-0.02, 0.05)
        self.gain = draw.uniform(26.0, 44.0) * (1.0 + draw.normal(0.0, 0.04, 8))  # N ahead at full command
        self.lag, self.loss, self.latency = draw.uniform(0.06, 0.14), draw.uniform(0.1, 0.3), draw.uniform(0.0, 0.06)
        self.net, self.centre = draw.uniform(-3.0, 3.0), np.array([draw.normal(0.0, 0.003), draw.normal(0.0, 0.002), draw.uniform(0.012, 0.03)])
        self.added = (draw.uniform(6.0, 10.0), draw.uniform(0.12, 0.25))  # kg, kg m2 with the water that goes along
        self.parts = "".join(
            f'<geom type="{kind}" size="{size}" pos="{at}" euler="{turn}" mass="0" fluidshape="ellipsoid" contype="0" conaffinity="0" fluidcoef="'
            f'{draw.uniform(1.2, 2.4):.3f} {draw.uniform(0.4, 0.9):.3f} {draw.uniform(2.0, 5.0):.3f} {draw.uniform(0.2, 0.8):.3f} 0"/>'
            for kind, size, at, turn in PARTS
        )
        reach = np.hstack([self.way, np.cross(self.place, self.way)])
        mixed = reach[:, [0, 1, 2, 5, 4, 3]] * [1.0, -1.0, -1.0, -1.0, 1.0, 1.0]  # surge sway heave yaw pitch roll, as a pilot has them
        flat = np.arange(8) < 4
        self.mixer = np.sign(np.where(np.abs(mixed) > 0.03, mixed, 0.0)) * np.where(flat[:, None], [1, 1, 0, 1, 0, 0], [0, 0, 1, 0, 1, 1])

    def sticks(self, rng: np.random.Generator, n: int) -> Array:
        """A pilot's sticks (n, 6): now these, now those, each held for one to five seconds."""
        wanted, at = np.zeros((n, 6)), 0
        while at < n:
            held = int(rng.uniform(12, 45))
            on = rng.random(6) < [0.6, 0.4, 0.45, 0.4, 0.1, 0.08]
            wanted[at : at + held] = np.where(on, rng.uniform(0.25, 0.85, 6) * rng.choice([-1, 1], 6) * [1, 1, 1, 0.5, 0.07, 0.07], 0.0)
            at += held
        moved = wanted.copy()
        for i in range(1, n):
            moved[i] = moved[i - 1] + 0.35 * (wanted[i] - moved[i - 1])
        return moved

    def thrust(self, pwm: Array) -> Array:
        """Thrust (8,) N that pulse widths (8,) us ask for: a dead band, a power of the rest, and astern three quarters of ahead."""
        command = (pwm - 1500.0) / 400.0
        size = np.maximum(np.abs(command) - 0.06, 0.0) / 0.94
        return np.asarray(np.sign(command) * size**1.75 * np.where(command < 0.0, 0.76, 1.0) * self.gain)

    def fly(self, path: Path, number: int, fault: Fault | None = None) -> None:
        """Fly for two minutes with a ``fault`` and write the log; ``number`` draws what the pilot does, noise and small forces of the water."""
        import mujoco

        fault, rng = fault or Fault(), np.random.default_rng([self.seed, 1, number])
        plate = '<geom type="box" size=".004 .12 .08" pos=".24 0 -.02" mass="0" fluidshape="ellipsoid" fluidcoef="2 .3 2 0 0" contype="0" conaffinity="0"/>'
        model = mujoco.MjModel.from_xml_string(
            f'<mujoco><compiler angle="degree"/><option density="1000" viscosity=".001" timestep="{STEP_S}" integrator="implicitfast" '
            f'gravity="0 0 -{GRAVITY}"/><worldbody><body name="rov" pos="0 0 -3"><joint type="free"/><inertial pos="0 0 0" mass="{MASS}" '
            f'diaginertia="{" ".join(map(str, INERTIA))}"/>{self.parts}{plate if fault.plate else ""}</body></worldbody></mujoco>'
        )
        body = model.body("rov").id
        model.dof_armature[:3], model.dof_armature[3:6] = self.added
        model.body_ipos[body], model.body_sameframe[body], model.body_simple[body] = fault.centre, 0, 0
        model.opt.wind[:] = fault.water
        data, heading, n = mujoco.MjData(model), rng.uniform(-3.0, 3.0), round(SECONDS / SAMPLE_S)
        data.qpos[3:7] = [math.cos(heading / 2), 0.0, 0.0, math.sin(heading / 2)]
        mujoco.mj_forward(model, data)
        pwm = np.clip(1500.0 + 400.0 * self.sticks(rng, n) @ self.mixer.T, 1100.0, 1900.0).round()
        gain = np.array([fault.gain.get(i + 1, 1.0) for i in range(8)]) * fault.thrust
        moment, force, push, log = np.cross(self.place, self.way), np.zeros(8), np.zeros(3), np.zeros((n, 18))
        lag, velocity = fault.lag or self.lag, np.zeros(6)
        for k in range(n):
            asked = self.thrust(pwm[k]) * gain
            asked = np.where(asked < 0.0, asked * fault.astern, asked)
            asked = np.where(np.abs(asked) < fault.dead, 0.0, asked)
            weight = fault.weight if k >= n // 2 else 0.0
            for step in range(round(SAMPLE_S / STEP_S)):
                turn = data.xmat[body].reshape(3, 3)
                mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, body, velocity, 1)
                if step == 0:
                    log[k] = [*data.xpos[body], *turn.ravel(), *velocity[3:], *velocity[:3]]
                force += (asked - force) * STEP_S / lag
                through = velocity[3:] - turn.T @ model.opt.wind
                flow = ((through + np.cross(velocity[:3], self.place)) * self.way).sum(axis=1)
                acting = force * (1.0 - self.loss * flow * np.sign(force))
                push += -push * STEP_S / 3.0 + 0.12 * math.sqrt(2.0 * STEP_S / 3.0) * rng.standard_normal(3)
                lift = np.array([0.0, 0.0, MASS * GRAVITY + self.net + fault.buoyancy])
                total = turn @ (acting @ self.way + push) + lift - [0.0, 0.0, weight]
                about = turn @ (acting @ moment) + np.cross(turn @ self.centre, lift) - np.cross(turn @ [0.1, 0.0, -0.1], [0.0, 0.0, weight])
                data.xfrc_applied[body, :3] = total
                data.xfrc_applied[body, 3:] = about - np.cross(data.xipos[body] - data.xpos[body], total)
                mujoco.mj_step(model, data)
        _write(path, self.sensed(log, fault, rng), pwm)

    def sensed(self, log: Array, fault: Fault, rng: np.random.Generator) -> Array:
        """The log's channels (n, 12) by `CHANNELS`, with latency, noise and the faults of sensors."""
        turn = np.einsum("ij,njk,kl->nil", WORLD, log[:, 3:12].reshape(-1, 3, 3), TURNED)
        roll, pitch, heading = np.arctan2(turn[:, 2, 1], turn[:, 2, 2]), -np.arcsin(turn[:, 2, 0]), np.arctan2(turn[:, 1, 0], turn[:, 0, 0])
        angles = np.unwrap(np.stack([roll, pitch, heading], axis=1), axis=0)
        t = np.arange(len(log)) * SAMPLE_S

        def behind(x: Array, by: float) -> Array:
            return np.stack([np.interp(t - by, t, column) for column in x.T], axis=1)

        c, s = math.cos(fault.turned), math.sin(fault.turned)
        seen = behind(log[:, 12:15] @ TURNED, self.latency + fault.late) @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) * fault.scaled
        rates = behind(log[:, 15:18] @ TURNED, self.latency) + np.array([0.0, 0.0, fault.yaw])
        found = np.hstack([seen, rates, behind(angles, self.latency) + np.array([fault.roll, 0.0, 0.0]), behind(log[:, :3] @ WORLD.T, self.latency)])
        found += np.array(NOISE) * rng.standard_normal(found.shape)
        found[:, 8] = (found[:, 8] + np.pi) % (2.0 * np.pi) - np.pi
        return found


def read(path: Path) -> Run:
    """A log as rovval reads it, by the profile beside it."""
    return load(path, profile=path.parent / "mujoco_rov.toml")


def _write(path: Path, seen: Array, pwm: Array) -> None:
    head = ",".join(("t", *CHANNELS, *(f"pwm_T{i}" for i in range(1, 9))))
    rows: Any = np.hstack([np.arange(len(seen))[:, None] * SAMPLE_S, seen, pwm])
    np.savetxt(path, rows, fmt=["%.1f"] + ["%.5f"] * len(CHANNELS) + ["%.0f"] * 8, delimiter=",", header=head, comments="")
