"""The body is not what the file says: mass, balance, resistance."""

from __future__ import annotations

import math

import numpy as np

from rovval.blind.plant.spec import AXES, Array
from rovval.blind.second.fault import Fault, Instant, pull
from rovval.blind.second.hull import NODES, WEIGHTS, Hull
from rovval.blind.second.sheet import TURN_RAD_S

GROUPS = {"translation": (0, 1, 2), "rotation": (3, 4, 5)}
BOTH = (*AXES, "translation")


def members(target: str | None) -> tuple[int, ...]:
    """Indices of the axes of a target that may be a group."""
    return GROUPS.get(str(target)) or (AXES.index(str(target)),)


class AddedMass(Fault):
    """Added mass of one axis, or of surge, sway and heave alike; what couples axes is left as it is."""

    name, place, form, targets = "added_mass", "vehicle", "equal", BOTH
    unit = "0.35 of the body's own mass or inertia more; of several axes on average, each in proportion to its own"

    def prepare(self) -> None:
        """Extra added mass of each axis (kg, kg m2)."""
        axes = members(self.target)
        own = [float(np.diag(self.sheet.inertia)[i - 3]) if i > 2 else self.sheet.mass for i in axes]
        there = [float(self.sheet.added[i, i]) for i in axes]
        share = [1.0] if len(axes) == 1 else [len(axes) * x / sum(there) for x in there]
        self.extra = {i: 0.35 * self.size * o * s for i, o, s in zip(axes, own, share, strict=True)}
        self.values = {"added": list(self.extra.values()), "axes": [AXES[i] for i in self.extra]}

    def alter(self, hull: Hull, on: float) -> None:
        """Add it."""
        for i, extra in self.extra.items():
            hull.added[i, i] += on * extra


class InertiaError(Fault):
    """The moment of inertia about one axis."""

    name, place, form, targets = "inertia_error", "vehicle", "equal", ("yaw", "pitch", "roll")
    unit = "half of the moment of inertia more"

    def prepare(self) -> None:
        """Relative excess."""
        self.values = {"relative": 0.5 * self.size}

    def alter(self, hull: Hull, on: float) -> None:
        """Scale it."""
        i = self.axis - 3
        hull.inertia[i, i] *= 1.0 + on * 0.5 * self.size


class LinearDrag(Fault):
    """More friction at low speed: a laminar plate's drag, with |v|^0.5 in the coefficient (Blasius): F as |v|^1.5 below and linear at the lowest speeds."""

    name, targets = "linear_drag", AXES
    unit = "0.4 of the working drag of the axis at working speed, as a softened |v|^1.2"

    def prepare(self) -> None:
        """Size at working speed."""
        self.ref = self.sheet.cruise if self.axis < 3 else TURN_RAD_S
        self.force = 0.4 * self.size * self.sheet.drag(self.axis, self.ref)
        self.values = {"force": self.force, "reference_speed": self.ref, "power": 1.2}

    def wrench(self, s: Instant) -> Array:
        """Against the motion through the water."""
        x = s.rel[self.axis] / self.ref
        out = np.zeros(6)
        out[self.axis] = -self.on(s.t) * self.force * x * (x * x + 0.0025) ** 0.1
        return out


class QuadraticDrag(Fault):
    """Form drag of something bolted on, on one axis, all of translation or all of rotation; its coefficient falls by a third through a smooth drag
    crisis at 1.2 times working speed (Achenbach 1972)."""

    name, targets = "quadratic_drag", (*BOTH, "rotation")
    unit = "half of the working drag of each axis concerned, at working speed"

    def prepare(self) -> None:
        """Coefficients, N s2/m2 or N m s2."""
        self.axes = members(self.target)
        self.ref = [self.sheet.cruise if i < 3 else TURN_RAD_S for i in self.axes]
        self.force = [0.5 * self.size * self.sheet.drag(i, v) for i, v in zip(self.axes, self.ref, strict=True)]
        self.values = {"force": self.force, "axes": [AXES[i] for i in self.axes], "reference_speed": self.ref}

    def wrench(self, s: Instant) -> Array:
        """Against the motion through the water."""
        out, on = np.zeros(6), self.on(s.t)
        for i, ref, force in zip(self.axes, self.ref, self.force, strict=True):
            x = s.rel[i] / ref
            out[i] = -on * force * abs(x) * x * (1.0 - math.tanh(3.0 * (abs(x) - 1.2)) / 5.0) / 1.1
        return out


class CrossDrag(Fault):
    """A skid that is deeper at one end: strips are wider ahead and narrower aft, as before in the middle (Faltinsen 1990, 6.1)."""

    name, both_signs = "cross_drag", True
    unit = "the centre of sway drag a fifth of the half-length ahead"

    def prepare(self) -> None:
        """Strip coefficients."""
        self.at = [self.sheet.half_length * x for x in NODES]
        taper = [0.5 * w * 0.6 * x for x, w in zip(NODES, WEIGHTS, strict=True)]
        self.side = [self.size * w * self.sheet.drag(1, self.sheet.cruise) / self.sheet.cruise**2 for w in taper]
        self.values = {"arm_m": self.size * 0.6 * self.sheet.half_length / 3.0}

    def wrench(self, s: Instant) -> Array:
        """Sway and yaw of the strips."""
        push, turn, on = 0.0, 0.0, self.on(s.t)
        for x, c in zip(self.at, self.side, strict=True):
            v = s.rel[1] + x * s.rel[5]
            push, turn = push - c * abs(v) * v, turn - x * c * abs(v) * v
        return on * np.array([0.0, push, 0.0, 0.0, 0.0, turn])


class BuoyancyError(Fault):
    """Foam that is compressed or a ballast that is other: a vertical force at the centre of buoyancy, a little less of it deeper (1 % a metre)."""

    name, both_signs = "buoyancy_error", True
    unit = "0.15 of the working force up"

    def prepare(self) -> None:
        """Lift, N."""
        self.lift = 0.15 * self.size * self.sheet.force
        self.values = {"lift": self.lift}

    def wrench(self, s: Instant) -> Array:
        """Up."""
        lift = self.on(s.t) * self.lift * (1.0 - 0.01 * (float(s.at[2]) - self.site.depth))
        return pull(-lift * s.down, self.sheet.cb)


class BuoyancyDrift(Fault):
    """A leak: weight comes in as through an orifice under falling pressure, fast at first."""

    name, event = "buoyancy_drift", True
    unit = "0.35 of the working force heavier by the end of the log"

    def prepare(self) -> None:
        """Weight by the end, N."""
        self.weight = 0.35 * self.size * self.sheet.force
        self.long = max(1.0, self.site.seconds - float(self.onset or 0.0))
        self.values = {"weight_at_end": self.weight, "seconds": self.long}

    def wrench(self, s: Instant) -> Array:
        """Down, at the centre of buoyancy."""
        x = min(1.0, max(0.0, (s.t - float(self.onset or 0.0)) / self.long))
        return pull(self.weight * (1.5 * x - 0.5 * x * x) * s.down, self.sheet.cb)


class CgOffset(Fault):
    """The centre of gravity is off ahead or to the side."""

    name, place, form, targets, both_signs = "cg_offset", "vehicle", "equal", ("surge", "sway"), True
    unit = "a static tilt of 5 degrees (against its autopilot, where the vehicle has one)"

    def prepare(self) -> None:
        """Offset, m."""
        self.offset = math.tan(math.radians(5.0)) * self.size * self.sheet.stiffness / (self.sheet.mass * self.sheet.gravity)
        self.values = {"offset": self.offset}

    def alter(self, hull: Hull, on: float) -> None:
        """Move it."""
        hull.cg = hull.cg + on * self.offset * np.eye(3)[self.axis]


class PayloadChange(Fault):
    """A sample is taken up in front and hangs there: mass, weight, moment and inertia of a lump of stone (2.5 times the density of water)."""

    name, place, event = "payload_change", "vehicle", True
    unit = "a wet weight of 0.18 of the working force, half a half-length ahead and a fifth below"

    def prepare(self) -> None:
        """Mass (kg), volume (m3), place (m)."""
        wet = 0.18 * self.size * self.sheet.force
        self.mass = wet / (self.sheet.gravity * (1.0 - 1.0 / 2.5))
        self.volume = self.mass / (2.5 * self.sheet.density)
        self.at = self.sheet.half_length * np.array([0.5, 0.0, 0.2])
        self.values = {"mass": self.mass, "wet_weight": wet, "at": self.at.tolist()}

    def alter(self, hull: Hull, on: float) -> None:
        """Put it together with the body."""
        mass, volume, a = on * self.mass, on * self.volume, self.at
        hull.cg = (hull.mass * hull.cg + mass * a) / (hull.mass + mass)
        hull.cb = (hull.volume * hull.cb + volume * a) / (hull.volume + volume)
        hull.inertia = hull.inertia + mass * (float(a @ a) * np.eye(3) - np.outer(a, a))
        hull.mass, hull.volume = hull.mass + mass, hull.volume + volume
