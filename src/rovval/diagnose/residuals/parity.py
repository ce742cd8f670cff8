"""Parity residuals: analytical redundancy of the sensors by kinematics, without any dynamics (Chow and Willsky 1984; Gertler 1998).

Measured velocities integrated through the measured attitude must give the measured pose. The dead-reckoned less the measured pose is the parity
residual of a window, its mean taken out, since the pose at the window's start is itself only measured. Gyro bias, velocity scale, misalignment, lever
arm, filter lag, compass and attitude bias each have a signature in it; no force has. The residuals are rows of every fit, beside those of the
dynamics, so that a sensor fault has to explain both.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

import numpy as np

from rovval.core.data import Array, Flags
from rovval.core.large_arrays import zeros
from rovval.diagnose.criteria import DEAD_RECKONED_SHARE, OUTLIER_SIGMA, PARITY_LEAST_SD
from rovval.diagnose.residuals.dead_reckoning import (
    RELATIONS,
    fully_measured,
    measured_motion,
    pose_drift,
    smoothed,
    without_margin,
)
from rovval.diagnose.residuals.fault_signatures import FaultSignatures, fault_signatures
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.windows.attitude import tumbling
from rovval.diagnose.windows.windows import Windows
from rovval.effects import load

EVERY = slice(None)  # windows

@dataclass(frozen=True, slots=True)
class ParityResiduals:
    """Parity residuals of one run's windows, in standard errors, and their normal equations in the parameters of the sensors.

    Attributes:
        rows: parity residuals (m, q): q samples of all relations of a window; zero where the window lacks pose or velocity.
        signatures: change (m, q, k) of the residuals per unit of each parameter, at the parameters' null values.
        equations: normal equations of the columns that have a signature.
        is_factor: which of those columns scale the velocity that they measure (the fault s makes 1 + s times the true one).
        is_delay: which of them are delays.
        columns: the plant's slot numbers of the k parameters.
        relations: the components of the pose that could be checked, of ``x y z phi theta psi``.
        sigma: standard error of each relation, m or rad.
        left: what all faults of sensors together leave of each relation in half of the windows (rms within a window, m or rad): few windows in which an
            instrument lost its way say nothing of the others.
        design_effect: of the autocorrelation of the residuals.
        notes: why a relation was left out.
        motion: the measured motion that signatures are computed of; None where nothing could be checked.
    """

    rows: Array
    signatures: Array
    equations: NormalEquations
    is_factor: Flags
    is_delay: Flags
    columns: tuple[int, ...]
    relations: tuple[str, ...]
    sigma: tuple[float, ...]
    left: tuple[float, ...]
    design_effect: float
    notes: tuple[str, ...]
    motion: FaultSignatures | None

    @property
    def delays(self) -> tuple[int, ...]:
        """Slots of sensors' delays."""
        return tuple(c for c, is_delay in zip(self.equations.columns, self.is_delay, strict=True) if is_delay)

    def only(self, names: Collection[str]) -> ParityResiduals:
        """The same of these relations alone."""
        which, own = [i for i, name in enumerate(self.relations) if name in names], [self.columns.index(c) for c in self.equations.columns]
        at = [i for i in range(self.rows.shape[1]) if i % len(self.relations) in which]
        rows, signatures = self.rows[:, at], self.signatures[:, at]
        return replace(
            self, rows=rows, signatures=signatures, equations=_equations(rows, signatures[..., own], self.equations.columns),
            relations=tuple(self.relations[i] for i in which), sigma=tuple(self.sigma[i] for i in which), left=tuple(self.left[i] for i in which),
        )  # fmt: skip

    def at_delays(self, beta: Array) -> tuple[Array, Array]:
        """Residuals (m, q) without the part that the delays of ``beta`` (k,), in seconds, cause, and signatures (m, q, k) at these delays."""
        delays = {c: float(beta[c]) for c in self.delays if beta[c] != 0.0}
        if not delays or self.motion is None:
            return self.rows, self.signatures
        keep, signatures = [RELATIONS.index(name) for name in self.relations], self.signatures.copy()
        caused, slopes = self.motion.of_delays(delays)
        for column, slope in slopes.items():
            signatures[..., self.columns.index(column)] = self._scaled(slope[..., keep])
        return self.rows - self._scaled(caused[..., keep]), signatures

    def noise_loss(self, design_effect: float) -> Array:
        """Squared residual of each window (m,) that noise alone makes, in the units of `normal_equations`."""
        checked = np.abs(self.rows).max(axis=1, initial=0.0) > 0.0
        return np.asarray(np.where(checked, design_effect / self.design_effect * self.rows.shape[1], 0.0))

    def losses(self, beta: Array, design_effect: float, which: Flags) -> dict[str, float]:
        """Squared residuals of each relation about ``beta`` (p,), summed over the windows ``which`` (m,), in the units of `normal_equations`."""
        rows, signatures = self.at_delays(beta)
        own = [self.columns.index(c) for c in self.equations.columns]
        left = rows - signatures[..., own] @ self._faults(beta)[0]
        return self._by_relation(left[which] ** 2, design_effect)

    def tolerated(self, sd: Mapping[int, float], design_effect: float) -> dict[str, float]:
        """The same of sensors alone whose parameters are off by one standard deviation ``sd`` (by slot), each by itself."""
        own = [i for i, c in enumerate(self.columns) if c in sd]
        return self._by_relation(self.signatures[..., own] ** 2 @ np.array([sd[self.columns[i]] ** 2 for i in own]), design_effect)

    def _by_relation(self, square: Array, design_effect: float) -> dict[str, float]:
        """Squares (m, q) summed over the samples of each relation."""
        if not self.relations:
            return {}
        whole = square.reshape(-1, len(self.relations)).sum(axis=0)
        return {name: float(design_effect / self.design_effect * value) for name, value in zip(self.relations, whole, strict=True)}

    def _faults(self, beta: Array) -> tuple[Array, Array]:
        """What the residuals are linear in, of each column of the equations, at ``beta`` (p,), and its derivative: delays are none, a factor s makes the
        measured velocity 1 + s times the true one, and the residual is one of the measured."""
        given = np.where(self.is_delay, 0.0, beta[list(self.equations.columns)])
        return np.where(self.is_factor, given / (1.0 + given), given), np.where(self.is_factor, (1.0 + given) ** -2, 1.0)

    def normal_equations(
        self, beta: Array, columns: tuple[int, ...], design_effect: float, summed: bool = False, which: slice = EVERY
    ) -> NormalEquations:
        """Normal equations of the parity residuals about ``beta`` (p,) in ``columns``, times ``design_effect`` over their own: beside the dynamics, one
        common design effect then suits both. ``summed``: of all windows in one; else of the windows ``which``.

        But for delays, residuals are linear in the sensors' parameters, r(beta) = r - T beta, so that with A = T'T, b = T'r and c = r'r at the null values
        b(beta) = b - A beta and c(beta) = c - beta'(b + b(beta)). A factor s makes the measured velocity 1 + s times the true one; the residual is one of the
        measured velocity, of which the fault is s / (1 + s), with derivative 1 / (1 + s)^2. Columns without a signature are zero.
        """
        null = self._about_delays(beta).summed() if summed else self._about_delays(beta).part(which)
        m, k = len(null.c), len(columns)
        taken, slope = self._faults(beta)
        b = null.b - null.A @ taken
        c = null.c - (null.b + b) @ taken
        place = {column: i for i, column in enumerate(null.columns)}
        to = [i for i, column in enumerate(columns) if column in place]
        of = [place[columns[i]] for i in to]
        scale = design_effect / self.design_effect
        out = NormalEquations(zeros(m, k, k), np.zeros((m, k)), scale * c, columns)
        out.A[np.ix_(range(m), to, to)] = scale * null.A[np.ix_(range(m), of, of)] * np.outer(slope[of], slope[of])
        out.b[:, to] = scale * b[:, of] * slope[of]
        return out

    def _about_delays(self, beta: Array) -> NormalEquations:
        """Normal equations of the columns that have a signature about the delays of ``beta`` (p,), all other parameters null."""
        columns = self.equations.columns
        if not beta[list(self.delays)].any():
            return self.equations
        rows, signatures = self.at_delays(beta)
        return _equations(rows, signatures[..., [self.columns.index(c) for c in columns]], columns)

    def _scaled(self, relations: Array) -> Array:
        """Drift (m, rows, relations), m and rad, as residuals (m, q) in standard errors."""
        return np.asarray((relations / np.array(self.sigma)).reshape(self.rows.shape))


def parity_residuals(windows: Windows, columns: tuple[int, ...]) -> ParityResiduals:
    """Parity residuals of every window of a run, with the signature of each sensor parameter among the plant slots ``columns``."""
    nu, eta, checkable = measured_motion(windows)
    usable = fully_measured(windows)
    nominal = pose_drift(without_margin(nu), without_margin(eta), windows.run, usable)
    motion = fault_signatures(windows, *smoothed(nu, eta, tumbling(windows.run)), usable)
    signatures = np.zeros((*nominal.shape, len(columns)))
    for i, column in enumerate(columns):
        if load(windows.plant.slots[column].effect).place == "sensor":
            signatures[..., i] = motion.of(column)
    keep = [i for i, name in enumerate(RELATIONS) if checkable[i]]
    return _weighted(motion, nominal, signatures, columns, keep)


def _weighted(motion: FaultSignatures, nominal: Array, signatures: Array, columns: tuple[int, ...], keep: list[int]) -> ParityResiduals:
    """Residuals and signatures in standard errors: the noise of a relation is what a joint fit of all sensor faults leaves of it."""
    windows, m, k = motion.windows, len(nominal), len(columns)
    if not keep:
        return _none(m, columns, ("no pose beside velocity in this log",))
    seen = np.flatnonzero(np.abs(signatures).max(axis=(0, 1, 2)) > 0)
    slots = [windows.plant.slots[c] for c in columns]
    free = np.array([i for i in seen if not load(slots[i].effect).is_another_form(slots[i].parameter.name)], dtype=int)  # not needed to find the noise
    sigma = np.array([max(1.4826 * float(np.median(np.abs(nominal[..., i]))), PARITY_LEAST_SD[i]) for i in keep])
    notes: list[str] = []
    left = nominal[..., keep]
    for _ in range(2 if len(free) else 0):  # noise from what the joint fit leaves, the fit weighted by that noise
        size = np.sqrt((left**2).mean(axis=1) / sigma**2).max(axis=1)  # of a window, in which an instrument may have lost its way
        sane = size <= OUTLIER_SIGMA * np.median(size[size > 0.0]) if size.any() else size == 0.0
        G = signatures[..., keep, :][..., free] / sigma[:, None]
        X = G[sane].reshape(-1, len(free))
        y = (nominal[..., keep] / sigma)[sane].reshape(-1)
        typical = np.array([slots[i].parameter.typical for i in free])
        fitted = np.linalg.lstsq(np.vstack([X, np.diag(0.1 / typical)]), np.concatenate([y, np.zeros(len(free))]), rcond=None)[0]
        left = (nominal[..., keep] / sigma - G @ fitted) * sigma
        sigma = np.maximum(left[sane].std(axis=(0, 1)), [PARITY_LEAST_SD[i] for i in keep])
    if len(free):
        sigma = np.maximum(left.std(axis=(0, 1)), sigma)  # what such a window says is worth little, and is not left out
    before = keep
    keep, sigma = _independent(windows, keep, sigma, notes)
    if not keep:
        return _none(m, columns, tuple(notes))
    checked = np.abs(left).max(axis=(1, 2)) > 0.0
    half = np.median(np.sqrt((left[checked] ** 2).mean(axis=1)), axis=0)[[before.index(i) for i in keep]] if checked.any() else np.zeros(len(keep))
    rows = (nominal[..., keep] / sigma).reshape(m, -1)
    scaled = (signatures[..., keep, :] / sigma[:, None]).reshape(m, rows.shape[1], k)
    design_effect = _design_effect(rows, scaled, free)
    equations = _equations(rows, scaled[..., seen], tuple(columns[i] for i in seen))
    is_factor = np.array([slots[i].parameter.error == "factor" for i in seen], dtype=bool)
    is_delay = np.array([slots[i].parameter.error == "delay" for i in seen], dtype=bool)
    return ParityResiduals(
        rows, scaled, equations, is_factor, is_delay, columns, relations=tuple(RELATIONS[i] for i in keep), sigma=tuple(sigma.tolist()),
        left=tuple(half.tolist()), design_effect=design_effect, notes=tuple(notes), motion=motion,
    )  # fmt: skip


def _none(m: int, columns: tuple[int, ...], notes: tuple[str, ...]) -> ParityResiduals:
    """No residuals, of a log that nothing can be checked of."""
    rows, signatures = np.zeros((m, 0)), np.zeros((m, 0, len(columns)))
    nothing = np.zeros(0, dtype=bool)
    return ParityResiduals(rows, signatures, _equations(rows, signatures[..., :0], ()), nothing, nothing, columns, (), (), (), 1.0, notes, None)


def _equations(rows: Array, signatures: Array, columns: tuple[int, ...]) -> NormalEquations:
    """Normal equations of residuals (m, q) with signatures (m, q, k)."""
    turned = signatures.swapaxes(1, 2)
    return NormalEquations(turned @ signatures, (turned @ rows[..., None])[..., 0], (rows**2).sum(axis=1), columns)


def _independent(windows: Windows, keep: list[int], sigma: Array, notes: list[str]) -> tuple[list[int], Array]:
    """The relations to keep, and their standard errors, without horizontal positions that were integrated from the velocities they would check."""
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


def _design_effect(rows: Array, signatures: Array, free: np.ndarray) -> float:
    """Variance of the windows' scores over that of white residuals, median over the columns ``free``; never below 1 (`ridge.estimated_design_effect`)."""
    if not len(free):
        return 1.0
    G = signatures[..., free]
    H = np.einsum("wqi,wqj->ij", G, G)
    step = np.linalg.lstsq(H + 1e-9 * np.eye(len(free)) * max(np.trace(H), 1e-12), np.einsum("wqi,wq->i", G, rows), rcond=None)[0]
    score = np.einsum("wqi,wq->wi", G, rows - G @ step)
    spread, white = (score**2).mean(axis=0), np.einsum("wqi,wqi->i", G, G) / len(rows)
    usable = white > 0
    return float(max(1.0, np.median(spread[usable] / white[usable]))) if usable.any() else 1.0
