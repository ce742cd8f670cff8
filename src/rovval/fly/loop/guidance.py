"""What the autopilot is asked for at each moment of a leg: the set-points of the file, or those of line-of-sight guidance along a path.

Line of sight (Fossen 2011, 10.3.2): the vehicle steers for the point of the line that is the look-ahead distance ahead of its own foot on it, and no
further than the next way point. A vehicle that can push sideways takes that course at once and turns its nose along the line; another turns its nose.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rovval.core.data import Array
from rovval.core.frames import wrap
from rovval.fly.loop.controllers import SetPoints, State
from rovval.fly.mission import Hold, WayPoints

SEPARATION = 4.0  # the outer loop is that much slower than the inner ones, as cascaded loops are (Skogestad 2003: four times the closed-loop time constant)


def held(leg: Hold, size: int) -> SetPoints:
    """The set-points of a `hold` leg for ``size`` lanes."""

    def each(value: float | None, factor: float = 1.0) -> Array | None:
        return None if value is None else np.full(size, value * factor)

    return SetPoints(each(leg.depth_m), each(leg.altitude_m), each(leg.heading_deg, np.pi / 180.0), each(leg.speed_m_s), each(leg.sway_m_s))


class LineOfSight:
    """``B`` lanes on their way through the points, each at its own one. ``next`` (B,) counts the points reached."""

    def __init__(self, leg: WayPoints, state: State, length: float, bandwidth: float, sideways: bool) -> None:
        """``length`` m of the vehicle, ``bandwidth`` rad/s of the speed loops, ``sideways`` whether it can push to the side."""
        self._points = np.concatenate([state.eta[:, None, :3], np.tile(np.array(leg.points), (len(state.eta), 1, 1))], axis=1)
        self._speed, self._radius = leg.speed_m_s, leg.radius_m or 0.5 * length
        self._slow, self._lead, self._sideways = bandwidth / SEPARATION, 3.0 / bandwidth, sideways
        self._lookahead = leg.lookahead_m or max(2.0 * length, leg.speed_m_s / self._slow)
        self._heading = state.eta[:, 5].copy()
        self.next: NDArray[np.int64] = np.zeros(len(state.eta), dtype=np.int64)

    @property
    def fastest(self) -> float:
        """Limit of a set-point of depth, m/s."""
        return self._speed

    def set_points(self, state: State) -> SetPoints:
        """Depth, heading and speeds (B,) for where the vehicle is now."""
        lanes, last = np.arange(len(self.next)), self._points.shape[1] - 2
        here = state.eta[:, :3]
        there = np.linalg.norm(self._points[lanes, np.minimum(self.next, last) + 1] - here, axis=1) < self._radius
        self.next = np.minimum(self.next + there, last + 1)
        leg = np.minimum(self.next, last)
        begin, end = self._points[lanes, leg], self._points[lanes, leg + 1]
        line = end[:, :2] - begin[:, :2]
        length = np.hypot(line[:, 0], line[:, 1])
        along = line / np.maximum(length, 1e-9)[:, None]
        done = np.clip(np.einsum("bi,bi->b", here[:, :2] - begin[:, :2], along), 0.0, length)
        aim = begin[:, :2] + along * np.minimum(done + self._lookahead, length)[:, None]
        to_aim, to_end = aim - here[:, :2], end[:, :2] - here[:, :2]
        speed = np.minimum(self._speed, self._slow * np.hypot(to_end[:, 0], to_end[:, 1]))
        course = np.arctan2(to_aim[:, 1], to_aim[:, 0])
        nose = np.arctan2(along[:, 1], along[:, 0]) if self._sideways else course
        arrived = self.next > last
        self._heading = np.where((length > self._radius) & ~arrived, nose, self._heading)
        off = wrap(course - state.eta[:, 5])
        gate = np.where(arrived, 1.0, np.maximum(np.cos(wrap(self._heading - state.eta[:, 5])), 0.0))
        share = np.where(length > 0, np.minimum(done + speed * self._lead, length) / np.maximum(length, 1e-9), 1.0)
        depth = begin[:, 2] + (end[:, 2] - begin[:, 2]) * share
        sway = speed * gate * np.sin(off) if self._sideways else None
        return SetPoints(depth=depth, heading=self._heading, surge=speed * gate * np.cos(off), sway=sway)
