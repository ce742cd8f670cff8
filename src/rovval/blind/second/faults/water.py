"""The water moves, or is heavier below."""

from __future__ import annotations

import math

import numpy as np

from rovval.blind.plant.spec import Array
from rovval.blind.second.fault import Fault, Instant, pull

EDDIES = 12  # Fourier modes of the turbulence


class _Stream(Fault):
    """Shared: a current with frozen turbulence about it, a sum of random Fourier modes without divergence (Kraichnan 1970)."""

    place = "water"
    rough = 0.08  # rms of the turbulence over the mean (estuaries and fjords: 5 to 10 %)

    def stir(self, speed: float) -> None:
        """Draw the modes: eddies of 1 to 10 m that live for 10 to 60 s."""
        way = self.rng.normal(size=(EDDIES, 3))
        way /= np.linalg.norm(way, axis=1, keepdims=True)
        self.number = way * (math.tau / np.exp(self.rng.uniform(0.0, math.log(10.0), (EDDIES, 1))))
        side = np.cross(way, self.rng.normal(size=(EDDIES, 3)))
        side /= np.linalg.norm(side, axis=1, keepdims=True)
        self.eddy = side * (self.rough * speed * math.sqrt(6.0 / EDDIES))
        self.beat = math.tau / self.rng.uniform(10.0, 60.0, EDDIES)
        self.phase = self.rng.uniform(0.0, math.tau, EDDIES)

    def eddies(self, t: float, at: Array) -> Array:
        """Velocity of the turbulence."""
        return np.asarray(np.cos(self.number @ at - self.beat * t + self.phase) @ self.eddy)


class CurrentConstant(_Stream):
    """A steady current, the same at all depths, with turbulence."""

    name = "current_constant"
    unit = "0.3 of the working speed from anywhere"

    def prepare(self) -> None:
        """Size and way."""
        speed, way = 0.3 * self.size * self.sheet.cruise, float(self.rng.uniform(-math.pi, math.pi))
        self.mean = speed * np.array([math.cos(way), math.sin(way), 0.0])
        self.stir(speed)
        self.values = {"speed": speed, "towards_rad": way, "north": float(self.mean[0]), "east": float(self.mean[1])}

    def current(self, t: float, at: Array) -> Array:
        """Mean and eddies."""
        return np.asarray(self.on(t) * (self.mean + self.eddies(t, at)))


class CurrentShear(_Stream):
    """Ekman's spiral: the current falls off and turns with depth, within a few metres (Ekman 1905)."""

    name = "current_shear"
    unit = "0.45 of the working speed two metres above the start; e times less and a radian further 4 m below that"

    def prepare(self) -> None:
        """Size and way at the top."""
        self.top, self.way = 0.45 * self.size * self.sheet.cruise, float(self.rng.uniform(-math.pi, math.pi))
        self.thick = 4.0
        self.stir(0.5 * self.top)
        self.values = {"speed": self.top, "towards_rad": self.way, "thickness_m": self.thick, "from_m": self.site.depth - 2.0}

    def current(self, t: float, at: Array) -> Array:
        """The spiral at a depth."""
        below = (float(at[2]) - self.site.depth + 2.0) / self.thick
        speed, way = self.top * math.exp(-min(3.0, max(-1.0, below))), self.way + below
        return np.asarray(self.on(t) * (np.array([speed * math.cos(way), speed * math.sin(way), 0.0]) + self.eddies(t, at)))


class CurrentVarying(_Stream):
    """A tide in a harbour mouth: an ellipse that is run through in a few minutes (seiche), with a second harmonic."""

    name = "current_varying"
    unit = "a long half-axis of 0.25 of the working speed, in 100 to 250 s"

    def prepare(self) -> None:
        """Axes, tilt and periods."""
        self.long = 0.25 * self.size * self.sheet.cruise
        self.short, self.tilt = float(self.rng.uniform(-0.6, 0.6)) * self.long, float(self.rng.uniform(0.0, math.pi))
        self.period, self.phase0 = float(self.rng.uniform(100.0, 250.0)), float(self.rng.uniform(0.0, math.tau))
        self.stir(self.long)
        self.values = {"speed": self.long, "short_axis": self.short, "period_s": self.period}

    def current(self, t: float, at: Array) -> Array:
        """On the ellipse."""
        a = math.tau * t / self.period + self.phase0
        x, y = self.long * (math.cos(a) + 0.25 * math.cos(2.0 * a)), self.short * math.sin(a)
        c, s = math.cos(self.tilt), math.sin(self.tilt)
        return np.asarray(self.on(t) * (np.array([c * x - s * y, s * x + c * y, 0.0]) + self.eddies(t, at)))


class Waves(Fault):
    """Sea from all over a sector: ten Airy waves at equal steps of the energy of a JONSWAP spectrum, spread by a squared cosine (Hasselmann 1973)."""

    name, place = "waves", "water"
    unit = "orbital speed of 0.15 of the working speed (rms times root two) at the starting depth"

    def prepare(self) -> None:
        """Components: frequency, number, way, amplitude of the orbital speed at the surface."""
        depth, g = self.site.depth, self.sheet.gravity
        peak = max(float(self.rng.uniform(5.0, 9.0)), 1.7 * math.sqrt(depth))
        w = np.linspace(0.75, 1.6, 10) * math.tau / peak
        bump = 3.3 ** np.exp(-((w * peak / math.tau - 1.0) ** 2) / (2.0 * 0.08**2))
        energy = w**-3.0 * np.exp(-1.25 * (math.tau / (w * peak)) ** 4) * bump  # of the orbital speed: the spectrum times w^2
        self.w, self.k = w, w * w / g
        decay = np.exp(-self.k * depth)
        speed = 0.15 * self.size * self.sheet.cruise
        self.amplitude = np.sqrt(energy) * speed / math.sqrt(float(np.sum(energy * decay**2)))
        main = float(self.rng.uniform(-math.pi, math.pi))
        self.way = main + 0.5 * np.arcsin(self.rng.uniform(-1.0, 1.0, 10))
        self.phase = self.rng.uniform(0.0, math.tau, 10)
        self.values = {"peak_s": peak, "towards_rad": main, "orbital_speed": speed}

    def current(self, t: float, at: Array) -> Array:
        """Orbital velocity."""
        c, s = np.cos(self.way), np.sin(self.way)
        angle = self.k * (c * at[0] + s * at[1]) - self.w * t + self.phase
        size = self.on(t) * self.amplitude * np.exp(-self.k * max(0.0, float(at[2])))
        along = size * np.cos(angle)
        return np.array([along @ c, along @ s, size @ np.sin(angle)])


class DensityGradient(Fault):
    """Water that is stratified all through: buoyancy grows with depth in proportion, and no further than from fresh to sea water."""

    name, place, both_signs = "density_gradient", "water", True
    unit = "0.2 of the working force a metre of depth"

    def prepare(self) -> None:
        """Slope, N/m, and limit, N (28 kg/m3)."""
        self.slope = 0.2 * self.size * self.sheet.force
        self.most = 14.0 * self.sheet.volume * self.sheet.gravity
        self.values = {"slope_n_m": self.slope, "limit_n": self.most}

    def wrench(self, s: Instant) -> Array:
        """More lift below."""
        lift = float(np.clip(self.slope * (float(s.at[2]) - self.site.depth), -self.most, self.most))
        return pull(-self.on(s.t) * lift * s.down, self.sheet.cb)
