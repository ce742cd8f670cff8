"""The tether as a chain of lumped masses with slack, in the same water as the vehicle.

Nodes carry half of the line on each side; segments pull only when stretched; drag is normal and tangential (Morison, cylinder).
The stiffness is chosen soft enough for an explicit solver: the line's stretch stays at some per cent at working loads. A short line that
drags as much as wanted would be as thick as a barrel: the nodes carry drag and mass of a longer one of ordinary thickness, in bights.
"""

from __future__ import annotations

import math

import numpy as np

from rovval.blind.plant.effect import Effect, Kinematics, Planting
from rovval.blind.plant.rotation import to_body, to_world
from rovval.blind.plant.spec import Array

SEGMENTS = 5
NORMAL = 1.2  # drag coefficient of a cylinder across the flow
TANGENTIAL = 0.02
THICK = {True: 0.03, False: 0.0076}  # m, line of a work-class vehicle (chosen) and of a small one (Blue Robotics, Fathom ROV tether)
PULSE = 30.0  # rad/s, natural frequency of a node on its segments (chosen, see above)


def paid_out(anchor: Array, place: Array, before: float) -> float:
    """Tether length (m) under automatic pay-out: six per cent slack, never hauled in, at least what was out before."""
    return max(before, 1.06 * float(np.linalg.norm(place - anchor)) + 1.0)


def fairlead(plan: Planting) -> tuple[float, float, float]:
    """Where the tether is tied: stern, a little above the middle (m, body)."""
    return -0.9 * plan.scale.length, 0.0, -0.25 * plan.scale.length


class TetherDrag(Effect):
    """Drag of the tether that the vehicle tows and sweeps, through a lumped-mass line to the anchor."""

    name = "tether_drag"
    unit = "the whole line, broadside at working speed, drags 2.5 times the working force; its end feels a share"

    def setup(self, plan: Planting) -> None:
        """Length in bights for the wanted drag; masses; anchor."""
        sc, nominal, st = plan.scale, plan.nominal, plan.setting
        self.anchor = st.anchor
        self.length = paid_out(st.anchor, np.array([0.0, 0.0, st.depth]), 0.0)
        full = 2.5 * self.s * sc.force
        self.diameter = full / (0.5 * nominal.density * NORMAL * self.length * sc.speed**2)  # of a line without bights
        thick = THICK[sc.work_class]
        bights = self.length * self.diameter / thick
        self.node_mass = 2.0 * nominal.density * math.pi / 4.0 * thick**2 * bights / SEGMENTS  # line and its added mass, neutral
        self.stiffness = self.node_mass * PULSE**2 / 4.0
        self.damping = 0.4 * math.sqrt(self.stiffness * self.node_mass)
        self.rho = nominal.density
        self.tie = fairlead(plan)
        self.values = {"diameter_m": thick, "length_m": bights, "span_m": self.length}
        self.values |= {"normal_drag": NORMAL, "anchor": st.anchor.tolist()}

    def start(self, k: Kinematics) -> Array:
        """Nodes on a straight line from the anchor to the start, at rest: (SEGMENTS - 1) places, then velocities."""
        share = np.arange(1, SEGMENTS)[:, None] / SEGMENTS
        end = np.array([0.0, 0.0, self.plan.setting.depth])
        places = self.anchor + share * (end - self.anchor)
        return np.concatenate([places.ravel(), np.zeros(3 * (SEGMENTS - 1))])

    def tick(self, k: Kinematics) -> None:
        """The winch follows."""
        self.length = paid_out(self.anchor, np.array([k.x, k.y, k.z]), self.length)

    def _pull(self, k: Kinematics, own: Array) -> tuple[Array, Array, Array, Array]:
        """Places and velocities of all ends, segment directions and tensions (N)."""
        c = k.vel
        p, q, r = c[3], c[4], c[5]
        tx, ty, tz = self.tie
        ex, ey, ez = to_world(k.r, tx, ty, tz)
        vx, vy, vz = to_world(k.r, c[0] + q * tz - r * ty, c[1] + r * tx - p * tz, c[2] + p * ty - q * tx)
        inner = 3 * (SEGMENTS - 1)
        place = np.vstack([self.anchor, own[:inner].reshape(-1, 3), (k.x + ex, k.y + ey, k.z + ez)])
        speed = np.vstack([np.zeros(3), own[inner:].reshape(-1, 3), (vx, vy, vz)])
        span = place[1:] - place[:-1]
        size = np.sqrt(np.einsum("ij,ij->i", span, span)) + 1e-9
        along = span / size[:, None]
        rest = self.length / SEGMENTS
        stretch = size - rest
        rate = np.einsum("ij,ij->i", speed[1:] - speed[:-1], along)
        grip = np.clip(stretch / (0.02 * rest), 0.0, 1.0)  # damping fades in, so that the force stays continuous
        tension = np.maximum(0.0, self.stiffness * np.maximum(stretch, 0.0) + grip * self.damping * rate)
        return place, speed, along, tension

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Pull of the last segment at the fairlead, and half of that segment's own drag."""
        _, speed, along, tension = self._pull(k, own)
        load = -tension[-1] * along[-1] + 0.5 * self._drag(speed[-2:].mean(axis=0)[None], along[-1:], k)[0]
        fx, fy, fz = to_body(k.r, *(self.level(k.t) * load).tolist())
        x, y, z = self.tie
        f[0] += fx
        f[1] += fy
        f[2] += fz
        f[3] += y * fz - z * fy
        f[4] += z * fx - x * fz
        f[5] += x * fy - y * fx

    def _drag(self, speed: Array, along: Array, k: Kinematics) -> Array:
        """Morison drag (N) of one segment each with velocity ``speed`` and direction ``along``."""
        rel = speed - np.array(k.water[:3])
        tangent = np.einsum("ij,ij->i", rel, along)[:, None] * along
        across = rel - tangent
        area = 0.5 * self.rho * self.diameter * self.length / SEGMENTS
        size = np.sqrt(np.einsum("ij,ij->i", across, across))[:, None]
        slide = np.sqrt(np.einsum("ij,ij->i", tangent, tangent))[:, None]
        return np.asarray(-area * (NORMAL * size * across + TANGENTIAL * slide * tangent))

    def derivative(self, k: Kinematics, own: Array) -> Array:
        """Newton for every node."""
        _, speed, along, tension = self._pull(k, own)
        pull = tension[:, None] * along
        middle = along[1:] + along[:-1]
        middle /= np.sqrt(np.einsum("ij,ij->i", middle, middle))[:, None] + 1e-9
        force = pull[1:] - pull[:-1] + self._drag(speed[1:-1], middle, k)
        return np.concatenate([speed[1:-1].ravel(), (force / self.node_mass).ravel()])
