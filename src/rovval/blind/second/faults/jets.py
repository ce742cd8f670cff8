"""Jets, and what they meet: inflow, cross-flow, hull, neighbours, bottom, wall."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from rovval.blind.plant.spec import Array
from rovval.blind.second.blades import blade
from rovval.blind.second.fault import Fault, Instant, pull

OBLIQUE = math.cos(math.pi / 4.0)  # share of a surge speed that blows along a unit at 45 degrees


class InflowLoss(Fault):
    """The blades' four-quadrant curve, where the file has bollard thrust."""

    name, place = "inflow_loss", "input"
    unit = "0.3 of the thrust lost at working speed of hull and shaft"

    def prepare(self) -> None:
        """How much of the inflow the blades see (one less the wake fraction, over the unit's true diameter), by the loss that it makes."""
        n, flow, wide = np.array([self.sheet.rpm]), np.array([OBLIQUE * self.sheet.cruise]), np.array([float(self.sheet.diameter.mean())])
        self.loss = min(0.85, 0.3 * self.size)

        def short(share: float) -> float:
            return float(1.0 - blade(n, share * flow, wide)[0] / (n[0] * n[0])) - self.loss

        self.share = float(brentq(short, 0.0, 200.0))
        self.values = {"loss_at_working_point": self.loss, "inflow_share": self.share}

    def pushes(self, thrust: Array, s: Instant) -> Array:
        """The curve's share of the thrust at rest."""
        gain = np.where(s.spin >= 0.0, self.sheet.ahead, self.sheet.astern)
        change = gain * (blade(s.spin, self.share * s.axial, self.sheet.diameter) - s.spin * np.abs(s.spin))
        return np.asarray(thrust + self.on(s.t) * change)


class CrossflowLoss(Fault):
    """Water that crosses the mouth of a duct stalls its lip: thrust falls as the sine of the angle between jet and flow does."""

    name, place = "crossflow_loss", "input"
    unit = "0.4 of the thrust lost where the cross-flow is as fast as the jet at working speed of hull and shaft"

    def prepare(self) -> None:
        """Speed of the jet at working shaft speed (momentum theory), relative to that of the hull."""
        self.jet = OBLIQUE * self.sheet.cruise / self.sheet.rpm
        self.values = {"loss": min(1.0, 0.8 * self.size)}

    def pushes(self, thrust: Array, s: Instant) -> Array:
        """Less by the squared sine."""
        rel = np.array(s.rel)
        flow = rel[:3] + np.cross(rel[3:], self.sheet.at)
        across = np.maximum(0.0, np.sum(flow * flow, axis=1) - s.axial**2)
        jet = (self.jet * s.spin) ** 2 + 1e-6
        return np.asarray(thrust * (1.0 - self.on(s.t) * min(1.0, 0.8 * self.size) * across / (across + jet)))


class HullInteraction(Fault):
    """A jet that blows at the hull pushes it back (thrust deduction) and runs along it (Coanda): the more thrust, the more it sticks."""

    name, place = "hull_interaction", "input"
    unit = "0.3 of the thrust of the jets that meet the hull at working thrust"

    def prepare(self) -> None:
        """Sign of thrust with which each unit blows at the middle; none for units that blow past."""
        inward = np.sum(self.sheet.aim * self.sheet.at, axis=1) / np.maximum(np.linalg.norm(self.sheet.at, axis=1), 1e-9)
        self.meets = np.where(np.abs(inward) < 0.15, 0.0, np.sign(inward))
        if not self.meets.any():
            self.meets = np.ones(len(self.sheet.units))
        self.values = {"loss": 0.3 * self.size, "units": int(np.count_nonzero(self.meets))}

    def pushes(self, thrust: Array, s: Instant) -> Array:
        """Less of it where it meets the hull."""
        hit = np.maximum(0.0, thrust * self.meets) / self.sheet.thrust
        loss = np.minimum(0.9, 0.3 * self.size * 1.5 * hit / (0.5 + hit))
        return np.asarray(thrust * (1.0 - self.on(s.t) * loss))


class ThrusterInteraction(Fault):
    """One unit breathes the jet of its neighbour: its inflow is faster by a share of the neighbour's induced speed, as the root of its thrust."""

    name, place, targets = "thruster_interaction", "input", ("thruster",)
    unit = "0.55 of the unit's thrust lost while its neighbour pushes with working thrust"

    def prepare(self) -> None:
        """The nearest other unit."""
        gaps = np.linalg.norm(self.sheet.at - self.sheet.at[self.at_unit], axis=1)
        gaps[self.at_unit] = np.inf
        self.other = int(np.argmin(gaps))
        self.values = {"loss": min(1.0, 0.55 * self.size), "upstream": self.sheet.units[self.other]}

    def pushes(self, thrust: Array, s: Instant) -> Array:
        """Loss by the root of the neighbour's thrust."""
        jet = min(1.2, math.sqrt(abs(float(thrust[self.other])) / self.sheet.thrust))
        out = thrust.copy()
        out[self.at_unit] *= 1.0 - self.on(s.t) * min(1.0, min(1.0, 0.55 * self.size) * jet)
        return out


class GroundEffect(Fault):
    """Jets that blow at the bottom come back as a fountain, and the hull's image draws it down as it slides over (Cheeseman and Bennett 1955: the
    share of the thrust goes as the inverse square of the height)."""

    name = "ground_effect"
    unit = "at one half-length of altitude (0.8 m at least), a lift of half of the vertical thrust and a steady 0.15 of the working force"

    def prepare(self) -> None:
        """Height of one half-length."""
        self.near = max(0.8, self.sheet.half_length)
        self.values = {"height_m": self.near, "altitude_at_start": self.site.seabed - self.site.depth}

    def wrench(self, s: Instant) -> Array:
        """Away from the bottom, less when it slides."""
        share = 1.0 / (1.0 + (max(0.1, s.altitude) / self.near) ** 2)
        blows = float(np.abs(s.thrust * self.sheet.aim[:, 2]).sum())
        slides = (s.rel[0] ** 2 + s.rel[1] ** 2) / self.sheet.cruise**2
        lift = 2.0 * share * self.size * (0.5 * blows + self.sheet.force * (0.15 - 0.2 * slides))
        return np.array([*(-self.on(s.t) * lift * s.down), 0.0, 0.0, 0.0])


class WallSuction(Fault):
    """A quay beside the start: speed along it makes the gap's water faster and its pressure lower (Bernoulli in a narrowing gap, Newman 1977)."""

    name = "wall_suction"
    unit = "0.5 of the working force at working speed and one half-length of gap; the wall stands 1.5 to 2.5 m off"

    def prepare(self) -> None:
        """Where the wall is."""
        way = self.site.heading + float(self.rng.choice([-0.5, 0.5])) * math.pi
        self.normal, self.off = np.array([math.cos(way), math.sin(way), 0.0]), float(self.rng.uniform(1.5, 2.5))
        self.along = np.array([-math.sin(way), math.cos(way), 0.0])
        self.values = {"towards_rad": way, "distance_m": self.off}

    def wrench(self, s: Instant) -> Array:
        """Towards the wall."""
        gap = max(0.5, self.off - float(self.normal @ s.at)) / max(0.5, self.sheet.half_length)
        along = (float(self.along @ s.world(np.array(s.rel[:3]))) / self.sheet.cruise) ** 2
        return pull(self.on(s.t) * self.size * self.sheet.force * along / (gap * gap + gap) * s.body(self.normal), np.zeros(3))
