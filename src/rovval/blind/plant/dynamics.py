"""The right-hand side: Kirchhoff's equations for the momentum of body and water, in the flow relative to the water.

State: position (NED), quaternion, generalised momentum h = (M_RB + M_A) nu_r (6, body axes), shaft speed and integral of each
motor, then the own states of the effects. With V the water's velocity (Lamb, Hydrodynamics, art. 124; the flow is uniform on
the scale of the vehicle):

    h_lin' = F - w x h_lin - (m - rho vol) V'
    h_rot' = Q - w x h_rot - v_r x h_lin - (m r_g - rho vol r_b) x V'

where V' is the acceleration of the water at the vehicle seen in body axes. Nothing is shared with the simulator under test.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rovval.blind.plant.effect import Effect, Kinematics
from rovval.blind.plant.motor import Drive
from rovval.blind.plant.parameters import Params
from rovval.blind.plant.rotation import matrix, to_body
from rovval.blind.plant.scales import Scales
from rovval.blind.plant.spec import Array

BASE = 13  # position 3, quaternion 4, momentum 6
FITTED_J = 1.0  # advance ratios of open-water series end near there
CLEAR_M = 0.3  # chosen: where the bottom and the surface begin to push back


class Plant:
    """One vehicle with its effects; ``rhs(t, y)`` for any solver."""

    def __init__(self, healthy: Params, effects: Sequence[Effect], scale: Scales, motor: Drive, bottom: float) -> None:
        self.healthy, self.effects, self.scale, self.motor, self.bottom = healthy, effects, scale, motor, bottom
        self.many = len(healthy.k_pos)
        self.set_point = np.zeros(self.many)
        self.background = [0.0] * 6
        self.volts = 1.0
        self.kin = Kinematics()
        self.changers = [e for e in effects if e.overrides("change")]
        self.flows = [e for e in effects if e.overrides("flow")]
        self.speeders = [e for e in effects if e.overrides("speed")]
        self.slices: list[slice] = []
        end = BASE + 2 * self.many
        for e in effects:
            size = len(e.start(self.kin_at_rest()))
            self.slices.append(slice(end, end + size))
            end += size
        self.size = end
        self.thrusters = [(e, s) for e, s in zip(effects, self.slices, strict=True) if e.overrides("thrust")]
        self.wrenches = [(e, s) for e, s in zip(effects, self.slices, strict=True) if e.overrides("wrench")]
        self.owners = [(e, s) for e, s in zip(effects, self.slices, strict=True) if s.stop > s.start]
        self.levels: list[float] = []
        self.mass: Array = np.eye(6)
        self.refresh(0.0)

    def kin_at_rest(self) -> Kinematics:
        """An instant with everything at zero (sizes of the own states do not depend on it)."""
        zero = np.zeros(self.many)
        return Kinematics(n=zero, turn=zero, static=zero, thrust=zero)

    def refresh(self, t: float) -> Array | None:
        """Bring the parameters to time ``t``; the matrix that carries the momentum over, where the mass has changed."""
        levels = [e.level(t) for e in self.changers]
        if levels == self.levels and hasattr(self, "p"):
            return None
        p = self.healthy.copy()
        for e, level in zip(self.changers, levels, strict=True):
            e.change(p, level)
        before = self.mass
        self.p, self.levels = p, levels
        self.mass = p.total_mass()
        self.inverse = np.linalg.inv(self.mass)
        self.reach = p.reach()
        self.lin, self.quad = p.lin.tolist(), p.quad.tolist()
        self.power = p.drag_power.tolist()
        self.reference = [self.scale.speed] * 3 + [0.5] * 3
        self.plain, self.advancing = not any(self.power), bool(np.any(p.advance))
        self.weight, self.lift = p.mass * p.gravity, p.density * p.volume * p.gravity
        self.displaced = p.density * p.volume
        return np.asarray(self.mass @ np.linalg.inv(before))

    def water(self, t: float, x: float, y: float, z: float) -> tuple[float, ...]:
        """Sum of all flows at a point."""
        if not self.flows:
            return (0.0,) * 8
        if len(self.flows) == 1:
            return self.flows[0].flow(t, x, y, z)
        return tuple(map(sum, zip(*(e.flow(t, x, y, z) for e in self.flows), strict=True)))

    def bollard(self, n: Array) -> Array:
        """Static thrust (N) of speed ``n`` (rpm): square law with a slightly different power."""
        p = self.p
        size = np.abs(n)
        gain = np.where(n >= 0.0, p.k_pos, p.k_neg)
        return np.asarray(gain * n * size * (size / self.scale.rpm + 1e-9) ** p.thrust_power)

    def under_way(self, n: Array, rel: list[float]) -> Array:
        """K_T(J) / K_T(0) of units whose file gives it: J = u_a / (n D) with n in rev/s, held where the polynomial was fitted."""
        p, speed = self.p, n / 60.0
        size = np.where(p.diameter > 0.0, p.diameter, 1.0)
        axial = np.hstack([p.directions, np.cross(p.positions, p.directions)]) @ np.array(rel)
        j = np.clip(axial * speed / (size * (speed * speed + 1e-9)), -FITTED_J, FITTED_J)
        a, b, c = np.where(n >= 0.0, p.advance[0].T, p.advance[1].T)
        return np.asarray(1.0 + j * (a + j * (b + j * c)))

    def see(self, t: float, y: Array) -> Kinematics:
        """Fill ``self.kin`` from the state: attitude, velocities, water, thrust."""
        k = self.kin
        s = y[:BASE].tolist()
        k.t, k.x, k.y, k.z = t, s[0], s[1], s[2]
        k.r = r = matrix(s[3], s[4], s[5], s[6])
        k.rel = rel = (self.inverse @ y[7:13]).tolist()
        flow = self.water(t, k.x, k.y, k.z)
        k.water = flow  # type: ignore[assignment]
        a, b, c = to_body(r, flow[0], flow[1], flow[2])
        k.vel = [rel[0] + a, rel[1] + b, rel[2] + c, rel[3], rel[4], rel[5]]
        k.altitude = self.bottom - k.z
        k.volts = self.volts
        k.n = turn = y[BASE : BASE + self.many]
        for e in self.speeders:
            turn = e.speed(turn, k)
        k.turn = turn
        k.static = self.bollard(turn)
        thrust = k.static * self.under_way(turn, rel) if self.advancing else k.static
        for e, own in self.thrusters:
            thrust = e.thrust(thrust, k, y[own])
        k.thrust = thrust
        return k

    def forces(self, k: Kinematics, y: Array) -> list[float]:
        """Body wrench: thrust, drag, weight and buoyancy, background, effects."""
        f: list[float] = (self.reach @ k.thrust).tolist()
        rel, lin, quad = k.rel, self.lin, self.quad
        for i in range(6):
            v = rel[i]
            size = abs(v)
            q = quad[i] * size
            if not self.plain:
                q *= (size / self.reference[i] + 0.02) ** self.power[i]
            f[i] += self.background[i] - (lin[i] + q) * v
        gx, gy, gz = k.r[6], k.r[7], k.r[8]  # world down seen from the body
        w, b = self.weight, self.lift
        f[0] += (w - b) * gx
        f[1] += (w - b) * gy
        f[2] += (w - b) * gz
        rg, rb = self.p.gravity_centre, self.p.buoyancy_centre
        mx, my, mz = w * rg[0] - b * rb[0], w * rg[1] - b * rb[1], w * rg[2] - b * rb[2]
        f[3] += my * gz - mz * gy
        f[4] += mz * gx - mx * gz
        f[5] += mx * gy - my * gx
        if k.altitude < CLEAR_M or k.z < CLEAR_M:
            self._edge(k, f)
        for e, own in self.wrenches:
            e.wrench(k, y[own], f)
        return f

    def _edge(self, k: Kinematics, f: list[float]) -> None:
        """Soft bottom and surface, so that a vehicle out of control stays in the water; no pilot comes this near."""
        depth = max(0.0, CLEAR_M - k.altitude) - max(0.0, CLEAR_M - k.z)
        sink = k.r[6] * k.vel[0] + k.r[7] * k.vel[1] + k.r[8] * k.vel[2]
        push = -6.0 * self.scale.force * (depth / CLEAR_M + 0.5 * abs(depth) / CLEAR_M * sink / self.scale.speed)
        for i in range(3):
            f[i] += push * k.r[6 + i]

    def rhs(self, t: float, y: Array) -> Array:
        """Time derivative of the state."""
        k = self.see(t, y)
        f = self.forces(k, y)
        u, v, w, p, q, r = k.rel
        a, b, c, d, e, g = y[7:13].tolist()
        m = k.r
        if self.flows:
            climb = m[6] * k.vel[0] + m[7] * k.vel[1] + m[8] * k.vel[2]
            fl = k.water
            acc = to_body(m, fl[3] + climb * fl[6], fl[4] + climb * fl[7], fl[5])
            rg, rb, load = self.p.gravity_centre, self.p.buoyancy_centre, self.p.mass
            gap = load - self.displaced
            s0, s1, s2 = (load * rg[i] - self.displaced * rb[i] for i in range(3))
            f[0] -= gap * acc[0]
            f[1] -= gap * acc[1]
            f[2] -= gap * acc[2]
            f[3] -= s1 * acc[2] - s2 * acc[1]
            f[4] -= s2 * acc[0] - s0 * acc[2]
            f[5] -= s0 * acc[1] - s1 * acc[0]
        q0, q1, q2, q3 = y[3:7].tolist()
        pull = 0.5 * (1.0 - (q0 * q0 + q1 * q1 + q2 * q2 + q3 * q3))  # keeps the quaternion's length at one
        x, o, z = k.vel[0], k.vel[1], k.vel[2]
        out = np.empty(self.size)
        out[:BASE] = (
            m[0] * x + m[1] * o + m[2] * z,
            m[3] * x + m[4] * o + m[5] * z,
            m[6] * x + m[7] * o + m[8] * z,
            0.5 * (-q1 * p - q2 * q - q3 * r) + pull * q0,
            0.5 * (q0 * p + q2 * r - q3 * q) + pull * q1,
            0.5 * (q0 * q + q3 * p - q1 * r) + pull * q2,
            0.5 * (q0 * r + q1 * q - q2 * p) + pull * q3,
            f[0] - (q * c - r * b),
            f[1] - (r * a - p * c),
            f[2] - (p * b - q * a),
            f[3] - (q * g - r * e) - (v * c - w * b),
            f[4] - (r * d - p * g) - (w * a - u * c),
            f[5] - (p * e - q * d) - (u * b - v * a),
        )
        self.motor.derivative(self.set_point, y, out, BASE, self.many)
        for effect, own in self.owners:
            out[own] = effect.derivative(k, y[own])
        return out
