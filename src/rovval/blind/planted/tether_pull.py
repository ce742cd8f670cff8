"""The tether as a pull: a constant-tension winch, and a snag."""

from __future__ import annotations

import math

from rovval.blind.plant.effect import Effect, Kinematics, Planting
from rovval.blind.plant.rotation import to_body, to_world
from rovval.blind.plant.spec import Array
from rovval.blind.planted.tether_drag import fairlead


class _Pull(Effect):
    """Shared: a force at the fairlead towards a point, with its moment."""

    def setup(self, plan: Planting) -> None:
        """Fairlead and numbers."""
        self.tie = fairlead(plan)
        self.numbers(plan)

    def numbers(self, plan: Planting) -> None:
        """Numbers of the effect."""

    def pull(self, k: Kinematics, f: list[float], point: tuple[float, float, float], tension: float, beyond: float) -> None:
        """Add ``tension`` towards ``point``; ``beyond`` > 0 multiplies a softened stretch beyond that length instead."""
        x, y, z = self.tie
        ex, ey, ez = to_world(k.r, x, y, z)
        dx, dy, dz = point[0] - k.x - ex, point[1] - k.y - ey, point[2] - k.z - ez
        far = math.sqrt(dx * dx + dy * dy + dz * dz) + 1e-6
        if beyond > 0.0:
            over = (far - beyond) / 0.15
            tension *= 0.15 * (over if over > 30.0 else math.log1p(math.exp(over)))
        else:
            tension *= 1.0 - math.exp(-far / 3.0)
        gain = self.level(k.t) * tension / far
        fx, fy, fz = to_body(k.r, gain * dx, gain * dy, gain * dz)
        f[0] += fx
        f[1] += fy
        f[2] += fz
        f[3] += y * fz - z * fy
        f[4] += z * fx - x * fz
        f[5] += x * fy - y * fx


class TetherTension(_Pull):
    """The winch holds a tension: a pull at the stern towards the anchor, a little stronger far out."""

    name = "tether_tension"
    unit = "0.2 of the working force"

    def numbers(self, plan: Planting) -> None:
        """Tension (N)."""
        self.tension = 0.2 * self.s * plan.scale.force
        x, y, z = plan.setting.anchor.tolist()
        self.point = (x, y, z)
        self.values = {"tension": self.tension, "anchor": [x, y, z]}

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Towards the anchor."""
        self.pull(k, f, self.point, self.tension, 0.0)


class TetherSnag(_Pull):
    """The tether is caught near where the vehicle is at the onset: beyond a free length it pulls back as a spring."""

    name = "tether_snag"
    event = True
    unit = "0.4 of the working force for each metre beyond the free length of 1 m (small vehicles 0.5 m)"

    def numbers(self, plan: Planting) -> None:
        """Stiffness (N/m) and free length (m)."""
        self.stiff = 0.4 * self.s * plan.scale.force
        self.free = (1.0 if plan.scale.work_class else 0.5) + plan.scale.length
        self.point: tuple[float, float, float] | None = None
        self.values = {"stiffness": self.stiff, "free_length": self.free}

    def tick(self, k: Kinematics) -> None:
        """Catch at the onset."""
        if self.point is None and self.onset is not None and k.t >= self.onset:
            self.point = (k.x, k.y, k.z)
            self.values["point"] = [k.x, k.y, k.z]

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """One-sided spring, softened."""
        if self.point is not None:
            self.pull(k, f, self.point, self.stiff, self.free)
