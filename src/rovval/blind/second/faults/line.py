"""The tether: a line that drags, a winch that pulls, a line that is caught."""

from __future__ import annotations

import math

import numpy as np

from rovval.blind.plant.spec import Array
from rovval.blind.second.fault import Fault, Instant, pull

LUMPS = 8
NORMAL, TANGENTIAL = 1.2, 0.02  # drag coefficients of a cylinder across and along (Driscoll, Lueck and Nahon 2000)


class _Line(Fault):
    """Shared: where the line is tied and which way it leaves, by a sagging shape between winch and vehicle (Irvine 1981, parabola)."""

    def prepare(self) -> None:
        """The tie: aft, on top."""
        self.tie = self.sheet.half_length * np.array([-0.8, 0.0, -0.25])
        self.numbers()

    def numbers(self) -> None:
        """Numbers of the effect."""

    def chord(self, s: Instant, to: Array) -> tuple[Array, float]:
        """Vector from the tie to a place, world, and its length."""
        away = to - s.at - s.world(self.tie)
        return away, float(np.linalg.norm(away)) + 1e-6


class TetherDrag(_Line):
    """Lumps along the line move with the vehicle in proportion to their place; half of what is nearer to the vehicle, in that proportion, it carries."""

    name = "tether_drag"
    unit = "as much drag as the hull has in surge at working speed, were the line across the flow"

    def numbers(self) -> None:
        """Projected area of each lump, m2."""
        speed = self.sheet.cruise
        whole = self.size * self.sheet.force / (0.5 * self.sheet.density * NORMAL * speed * speed)
        place = (np.arange(LUMPS) + 0.5) / LUMPS
        self.share, self.area = place, whole / float(np.sum(place**3))
        self.sag = 0.12
        self.values = {"area_m2": whole, "sag": self.sag}

    def wrench(self, s: Instant) -> Array:
        """Drag of the lumps, by their share, at the tie."""
        away, length = self.chord(s, self.site.winch)
        rel, arm = np.array(s.rel), self.tie
        moving = s.world(rel[:3] + np.cross(rel[3:], arm))
        tangents = away / length + 4.0 * self.sag * (2.0 * self.share[:, None] - 1.0) * np.array([0.0, 0.0, -1.0])
        tangents /= np.linalg.norm(tangents, axis=1, keepdims=True)
        flow = self.share[:, None] * moving
        along = np.sum(flow * tangents, axis=1, keepdims=True) * tangents
        across = flow - along
        drag = NORMAL * np.linalg.norm(across, axis=1, keepdims=True) * across + math.pi * TANGENTIAL * np.linalg.norm(along, axis=1, keepdims=True) * along
        force = -0.5 * self.sheet.density * self.area * np.sum(self.share[:, None] * drag, axis=0)
        return pull(self.on(s.t) * s.body(force), arm)


class TetherTension(_Line):
    """A winch that keeps tension, and hunts about it; the line leaves the vehicle steeper than the way to the winch, by its sag."""

    name = "tether_tension"
    unit = "0.2 of the working force"

    def numbers(self) -> None:
        """Tension, N; beat of the winch."""
        self.tension, self.beat = 0.2 * self.size * self.sheet.force, math.tau / float(self.rng.uniform(25.0, 60.0))
        self.values = {"tension": self.tension, "winch": self.site.winch.tolist()}

    def wrench(self, s: Instant) -> Array:
        """Along the line at the tie."""
        away, length = self.chord(s, self.site.winch)
        way = away / length + np.array([0.0, 0.0, 0.25])
        size = self.tension * (1.0 + 0.15 * math.sin(self.beat * s.t)) / float(np.linalg.norm(way))
        return pull(self.on(s.t) * size * s.body(way), self.tie)


class TetherSnag(_Line):
    """Caught where the vehicle is at the onset: beyond some slack it pulls with the power 1.5 of the stretch, and damps going out."""

    name, event = "tether_snag", True
    unit = "0.4 of the working force a metre beyond the slack of half a metre"

    def numbers(self) -> None:
        """Stiffness, slack."""
        self.stiff, self.slack = 0.4 * self.size * self.sheet.force, 0.5 + 0.5 * self.sheet.half_length
        self.caught: Array | None = None
        self.values = {"stiffness": self.stiff, "free_length": self.slack}

    def on(self, t: float) -> float:
        """All at once."""
        return float(t >= float(self.onset or 0.0))

    def advance(self, s: Instant, dt: float) -> None:
        """Catch."""
        if self.caught is None and s.t >= float(self.onset or 0.0):
            self.caught = s.at + s.world(self.tie)
            self.values["point"] = self.caught.tolist()

    def wrench(self, s: Instant) -> Array:
        """Back towards the point."""
        if self.caught is None:
            return np.zeros(6)
        away, length = self.chord(s, self.caught)
        over = max(0.0, length - self.slack)
        out = max(0.0, -float(away @ s.world(np.array(s.nu[:3]))) / length)
        return pull(s.body(away / length) * self.stiff * over**1.5 * (1.0 + 0.5 * out), self.tie)
