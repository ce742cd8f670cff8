"""The windows of a run: measured start states, measured channels, and what a simulation predicts of these."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rovval.core.channels import AXES
from rovval.core.data import Array, Flags, Run
from rovval.core.frames import wrap
from rovval.diagnose.windows.attitude import ANGLES, attitude_error, measured_attitude, tumbling
from rovval.plant import Plant
from rovval.simulation.actuation import Actuation

VELOCITY_CHANNELS = ("u", "v", "w", "p", "q", "r")
ATTITUDE_CHANNELS = ("phi", "theta")
AXIS_OF = dict(zip((*VELOCITY_CHANNELS, "x", "y", "z", "phi", "theta", "psi"), (*AXES, *AXES), strict=True))
POSE_OF = dict(zip(VELOCITY_CHANNELS, ("x", "y", "z", "phi", "theta", "psi"), strict=True))


@dataclass(frozen=True, slots=True)
class Windows:
    """The m windows of one run, of n = steps + 1 samples of c residual channels each; SI units and radians.

    Attributes:
        run: the run, conditioned.
        plant: what simulates it.
        actuation: thruster speeds and whatever else drives the simulation.
        channels: names of the residual channels.
        start: first sample of each window on the run's grid (m,).
        steps: sampling intervals of a window.
        nu0, eta0: measured initial velocities and poses (m, 6).
        y: measured channels (m, n, c); of the attitude of a run that tumbles the turns summed up (`attitude.turned_through`).
        ok: where they hold a measurement (m, n, c).
        noise: standard deviation of the white noise of each channel (c,).
        outliers: samples that were set aside as such.
        contact_s: seconds that were left out because the vehicle was in contact.
        disturbance_response: what disturbances of one standard deviation do to the channels (m, n, c, d); None until they are estimated.
        stopped: windows in which the simulation of the nominal vehicle stops.
    """

    run: Run
    plant: Plant
    actuation: Actuation
    channels: tuple[str, ...]
    start: NDArray[np.int64]
    steps: int
    nu0: Array
    eta0: Array
    y: Array
    ok: Flags
    noise: Array
    outliers: int
    contact_s: float
    disturbance_response: Array | None = None
    stopped: int = 0

    @property
    def count(self) -> int:
        """Number of windows."""
        return len(self.start)

    @property
    def axes(self) -> tuple[str, ...]:
        """Axis that each channel belongs to."""
        return tuple(AXIS_OF[c] for c in self.channels)

    def some(self, which: Flags | slice) -> Windows:
        """Those of the windows ``which``, (m,) or a slice of them, their disturbances not estimated yet."""
        kept = {name: getattr(self, name)[which] for name in ("start", "nu0", "eta0", "y", "ok")}
        return replace(self, disturbance_response=None, **kept)

    def part(self, which: slice) -> Windows:
        """Those of the windows ``which``, with their disturbances."""
        return replace(self.some(which), disturbance_response=None if self.disturbance_response is None else self.disturbance_response[which])

    def depths(self) -> Array:
        """Depths (m, down) that the run went through where they were measured, else those that its windows begin at."""
        return self.run.get("z")[self.run.ok("z")] if self.run.measured("z") else self.eta0[:, 2]

    def samples(self) -> NDArray[np.int64]:
        """Every sample's place on the run's grid (m, steps + 1)."""
        return self.start[:, None] + np.arange(self.steps + 1)

    def time(self) -> Array:
        """Seconds since the run's start of every sample (m, steps + 1)."""
        return np.asarray(self.samples() * self.run.dt)


def residual_channels(run: Run) -> tuple[str, ...]:
    """The channels of a run that a simulation is compared in: velocities, or the pose of an axis whose velocity was not logged, and roll and pitch, whose
    static value shows trim."""
    chosen = [c if run.measured(c) else POSE_OF[c] for c in VELOCITY_CHANNELS]
    chosen += [c for c in ATTITUDE_CHANNELS if c not in chosen]
    return tuple(c for c in chosen if run.measured(c))


def predicted_channels(windows: Windows, which: NDArray[np.int64], nu: Array, eta: Array, out: Array | None = None) -> Array:
    """Residual channels (b, n, c) of simulated velocities ``nu`` and poses ``eta`` (b, n, 6) of the windows ``which`` (b,); written to ``out`` where it is
    given."""
    names = (*VELOCITY_CHANNELS, "x", "y", "z", "phi", "theta", "psi")
    at = [names.index(channel) for channel in windows.channels]
    begins = [i for i in range(len(at)) if i == 0 or at[i] != at[i - 1] + 1 or at[i] == 6]  # neighbours are copied at once
    blocks = [(at[i], j - i) for i, j in zip(begins, [*begins[1:], len(at)], strict=True)]
    predicted = np.concatenate([(nu, eta)[first // 6][..., first % 6 : first % 6 + size] for first, size in blocks], axis=-1, out=out)
    if tumbling(windows.run):
        samples = windows.samples()[which]
        error = attitude_error(eta[..., 3:], measured_attitude(windows.run)[samples], windows.channels)
        for i, name in enumerate(windows.channels):
            if name in ANGLES:
                predicted[..., i] = windows.y[which, :, i] + error[..., ANGLES.index(name)]
    return predicted


def interpolated(windows: Windows, channel: str, t: Array) -> Array:
    """A channel of the windows' run at times ``t`` (s since its start), gaps bridged; zeros where it was not measured."""
    good = np.flatnonzero(windows.run.ok(channel)) if windows.run.measured(channel) else np.zeros(0, dtype=int)
    if not len(good):
        return np.zeros(t.shape)
    values = windows.run.get(channel)[good]
    return np.asarray(np.interp(t / windows.run.dt, good, np.unwrap(values) if channel == "psi" else values))


def channel_difference(windows: Windows, a: Array, b: Array, out: Array | None = None) -> Array:
    """a - b (..., c) by channel, angles wrapped to (-pi, pi]; rotation vectors are no longer than that. It is written to ``out`` where that is given."""
    out = np.asarray(np.subtract(a, b, out=out))
    for i, name in enumerate(windows.channels):
        if name in ANGLES and (out[..., i].max(initial=0.0) > np.pi or out[..., i].min(initial=0.0) < -np.pi):
            out[..., i] = wrap(out[..., i])
    return out


def axis_channels(windows: Windows) -> dict[str, int]:
    """Index of the channel in which the gap on each measured axis is stated: its velocity, or its pose where no velocity was logged."""
    carrier = {}
    for axis, velocity in zip(AXES, VELOCITY_CHANNELS, strict=True):
        name = velocity if velocity in windows.channels else POSE_OF[velocity]
        if name in windows.channels:
            carrier[axis] = windows.channels.index(name)
    return carrier
