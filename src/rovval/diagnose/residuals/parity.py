"""Parity: faults of the sensors shown by kinematics alone, without any dynamics.

Measured velocities integrated through the measured attitude must give the measured pose: what they give less what was measured is the
parity residual of a window (its mean taken out, since the pose at the window's start is itself only measured). Gyro bias,
velocity scale, misalignment, lever arm, filter lag, compass and attitude bias each leave their own trace in it; no force does.
The residual and those traces enter the contest of hypotheses as rows beside the dynamics: a sensor fault must explain both.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import signal

from rovval.core.data import Array, Flags
from rovval.diagnose.criteria import DEAD_RECKONED_SHARE, PARITY_LEAST_SD, PARITY_SMOOTHING
from rovval.diagnose.residuals.dead_reckoning import RELATIONS, fully_measured, measured_motion, pose_drift, without_margin
from rovval.diagnose.residuals.fault_signatures import FaultSignatures, fault_signatures
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.windows.windows import Windows
from rovval.effects import load


@dataclass(frozen=True, slots=True)
class ParityResiduals:
    """Rows (m, q) in standard errors and their change (m, q, k) per parameter of ``columns``; ``gram`` their products of those columns
    that leave a trace, ``factor`` which of them multiply what they measure, ``late`` which are delays; ``used`` relations, ``sigma`` of each, and
    ``design_effect`` of its score; ``of`` the motion that the traces are of. Zero rows where a window lacks pose or velocity."""

    rows: Array
    traces: Array
    gram: NormalEquations
    factor: Flags
    late: Flags
    columns: tuple[int, ...]
    used: tuple[str, ...]
    sigma: tuple[float, ...]
    design_effect: float
    notes: tuple[str, ...]
    of: FaultSignatures | None

    @property
    def delays(self) -> tuple[int, ...]:
        """Columns of sensors that are late."""
        return tuple(c for c, late in zip(self.gram.columns, self.late, strict=True) if late)

    def undone(self, beta: Array) -> tuple[Array, Array]:
        """Rows (m, q) with what sensors that are late by ``beta`` (k,) make of them taken out, and traces (m, q, k) about these delays."""
        late = {c: float(beta[c]) for c in self.delays if beta[c] != 0.0}
        if not late or self.of is None:
            return self.rows, self.traces
        keep, traces = [RELATIONS.index(name) for name in self.used], self.traces.copy()
        made, slopes = self.of.late(late)
        for column, slope in slopes.items():
            traces[..., self.columns.index(column)] = self._scaled(slope[..., keep])
        return self.rows - self._scaled(made[..., keep]), traces

    def normal_equations(self, beta: Array, columns: tuple[int, ...], design_effect: float) -> NormalEquations:
        """Products of the rows, discounted so that one common ``design_effect`` suits them and the dynamics. But for delays, rows are linear in the sensors'
        parameters, r(beta) = r - T beta, so that with A = T'T, b = T'r and c = r'r at the null value b(beta) = b - A beta and
        c(beta) = c - beta'(b + b(beta)); columns without a trace have zeros. Of a measured velocity that is 1 + s times the true one, s is not
        s of it but s / (1 + s), with slope 1 / (1 + s)^2."""
        null, m, k = self._about_delays(beta), len(self.gram.c), len(columns)
        given = np.where(self.late, 0.0, beta[list(null.columns)])
        taken = np.where(self.factor, given / (1.0 + given), given)
        slope = np.where(self.factor, (1.0 + given) ** -2, 1.0)
        b = null.b - null.A @ taken
        c = null.c - (null.b + b) @ taken
        place = {column: i for i, column in enumerate(null.columns)}
        to = [i for i, column in enumerate(columns) if column in place]
        of = [place[columns[i]] for i in to]
        scale = design_effect / self.design_effect
        out = NormalEquations(np.zeros((m, k, k)), np.zeros((m, k)), scale * c, columns)
        out.A[np.ix_(range(m), to, to)] = scale * null.A[np.ix_(range(m), of, of)] * np.outer(slope[of], slope[of])
        out.b[:, to] = scale * b[:, of] * slope[of]
        return out

    def _about_delays(self, beta: Array) -> NormalEquations:
        """Products of the columns that leave a trace about the delays of ``beta``, all else at its null value."""
        columns = self.gram.columns
        if not beta[list(self.delays)].any():
            return self.gram
        rows, traces = self.undone(beta)
        return _gram(rows, traces[..., [self.columns.index(c) for c in columns]], columns)

    def _scaled(self, relations: Array) -> Array:
        return np.asarray((relations / np.array(self.sigma)).reshape(self.rows.shape))


def parity_residuals(windows: Windows, columns: tuple[int, ...]) -> ParityResiduals:
    """Parity rows of every window and the trace that each sensor parameter among ``columns`` leaves in them."""
    nu, eta, whole = measured_motion(windows)
    nominal, usable = pose_drift(without_margin(nu), without_margin(eta), windows.run.dt), fully_measured(windows)
    nu, eta = (signal.savgol_filter(a, PARITY_SMOOTHING, 2, axis=1) for a in (nu, eta))
    of = fault_signatures(windows, nu, eta, usable)
    traces = np.zeros((*nominal.shape, len(columns)))
    for i, column in enumerate(columns):
        if load(windows.plant.slots[column].effect).place == "sensor":
            traces[..., i] = of.of(column)
    keep = [i for i, name in enumerate(RELATIONS) if whole[i]]
    nominal[~usable] = 0.0
    return _weighted(of, nominal, traces, columns, keep)


def _weighted(of: FaultSignatures, nominal: Array, traces: Array, columns: tuple[int, ...], keep: list[int]) -> ParityResiduals:
    """Rows and traces in standard errors: what all sensor faults together leave is the noise of each relation."""
    windows, m, k = of.windows, len(nominal), len(columns)
    if not keep:
        return _none(m, columns, ("no pose beside velocity in this log",))
    seen = np.flatnonzero(np.abs(traces).max(axis=(0, 1, 2)) > 0)
    slots = [windows.plant.slots[c] for c in columns]
    free = np.array([i for i in seen if not load(slots[i].effect).of_one_axis(slots[i].parameter.name)], dtype=int)  # not needed to find the noise
    sigma = np.array([max(1.4826 * float(np.median(np.abs(nominal[..., i]))), PARITY_LEAST_SD[i]) for i in keep])
    notes: list[str] = []
    left = nominal[..., keep]
    for _ in range(2 if len(free) else 0):  # noise from what the joint fit leaves, the fit weighted by that noise
        G = traces[..., keep, :][..., free] / sigma[:, None]
        X = G.reshape(-1, len(free))
        y = (nominal[..., keep] / sigma).reshape(-1)
        typical = np.array([slots[i].parameter.typical for i in free])
        fitted = np.linalg.lstsq(np.vstack([X, np.diag(0.1 / typical)]), np.concatenate([y, np.zeros(len(free))]), rcond=None)[0]
        left = (nominal[..., keep] / sigma - G @ fitted) * sigma
        sigma = np.maximum(left.std(axis=(0, 1)), [PARITY_LEAST_SD[i] for i in keep])
    keep, sigma = _independent(windows, keep, sigma, notes)
    if not keep:
        return _none(m, columns, tuple(notes))
    rows = (nominal[..., keep] / sigma).reshape(m, -1)
    scaled = (traces[..., keep, :] / sigma[:, None]).reshape(m, rows.shape[1], k)
    design_effect = _inflation(rows, scaled, free)
    gram = _gram(rows, scaled[..., seen], tuple(columns[i] for i in seen))
    factor = np.array([slots[i].parameter.error == "factor" for i in seen], dtype=bool)
    late = np.array([slots[i].parameter.error == "delay" for i in seen], dtype=bool)
    return ParityResiduals(rows, scaled, gram, factor, late, columns, tuple(RELATIONS[i] for i in keep), tuple(sigma.tolist()), design_effect, tuple(notes), of)


def _none(m: int, columns: tuple[int, ...], notes: tuple[str, ...]) -> ParityResiduals:
    """No rows at all."""
    rows, traces = np.zeros((m, 0)), np.zeros((m, 0, len(columns)))
    nothing = np.zeros(0, dtype=bool)
    return ParityResiduals(rows, traces, _gram(rows, traces[..., :0], ()), nothing, nothing, columns, (), (), 1.0, notes, None)


def _gram(rows: Array, traces: Array, columns: tuple[int, ...]) -> NormalEquations:
    turned = traces.swapaxes(1, 2)
    return NormalEquations(turned @ traces, (turned @ rows[..., None])[..., 0], (rows**2).sum(axis=1), columns)


def _independent(windows: Windows, keep: list[int], sigma: Array, notes: list[str]) -> tuple[list[int], Array]:
    """Leave out horizontal positions that were integrated from the velocities they would check."""
    noise = dict(zip(windows.channels, windows.noise, strict=True))
    seconds = windows.steps * windows.run.dt
    out = []
    for i, s in zip(keep, sigma, strict=True):
        expected = noise.get("u", 0.0) * np.sqrt(windows.run.dt * seconds / 6.0)  # random walk of integrated white noise, mean taken out
        if i < 2 and s < DEAD_RECKONED_SHARE * expected:
            notes.append(f"{RELATIONS[i]} follows the integrated velocity within {s:.3g} m: it is dead-reckoned and checks nothing")
            continue
        out.append(i)
    return out, np.array([s for i, s in zip(keep, sigma, strict=True) if i in out])


def _inflation(rows: Array, traces: Array, free: np.ndarray) -> float:
    if not len(free):
        return 1.0
    G = traces[..., free]
    H = np.einsum("wqi,wqj->ij", G, G)
    step = np.linalg.lstsq(H + 1e-9 * np.eye(len(free)) * max(np.trace(H), 1e-12), np.einsum("wqi,wq->i", G, rows), rcond=None)[0]
    score = np.einsum("wqi,wq->wi", G, rows - G @ step)
    spread, white = (score**2).mean(axis=0), np.einsum("wqi,wqi->i", G, G) / len(rows)
    usable = white > 0
    return float(max(1.0, np.median(spread[usable] / white[usable]))) if usable.any() else 1.0
