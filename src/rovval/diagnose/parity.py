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

from rovval.data import Array, Flags
from rovval.diagnose.products import Products
from rovval.diagnose.reckoning import LEAD, RELATIONS, complete, drift, measured, wrap_angles
from rovval.diagnose.stretches import Stretches
from rovval.effects import load
from rovval.plant.sensors import Log, observe

LEAST_SIGMA = (0.005, 0.005, 0.002, 0.001, 0.001, 0.001)  # m, rad: no sensor is believed below these (chosen)
STEP = 0.25  # finite-difference step, in typical sizes
SMOOTH = 11  # samples of the quadratic by which motion is smoothed for traces: a delay's is a slope, which noise would drown and correlate
FACTORS = ("dvl_scale",)  # faults that multiply what they measure
DEAD_RECKONED = 0.5  # a position that follows the integrated velocity closer than half its noise allows was integrated from it


@dataclass(frozen=True, slots=True)
class Parity:
    """Rows (m, q) in standard errors and their change (m, q, k) per parameter of ``columns``; ``gram`` their products of those columns
    that leave a trace, ``factor`` which of them multiply what they measure; ``used`` relations, ``sigma`` of each, and ``inflation`` of
    its score. Zero rows where a window lacks pose or velocity."""

    rows: Array
    traces: Array
    gram: Products
    factor: Flags
    columns: tuple[int, ...]
    used: tuple[str, ...]
    sigma: tuple[float, ...]
    inflation: float
    notes: tuple[str, ...]

    def moved(self, beta: Array, columns: tuple[int, ...]) -> Moved:
        """The same rows about another parameter point, for other columns."""
        return Moved(self, beta, columns)


@dataclass(frozen=True, slots=True)
class Moved:
    """Parity about the parameters ``beta`` (k,) for ``columns``."""

    parity: Parity
    beta: Array
    columns: tuple[int, ...]

    def products(self, inflation: float) -> Products:
        """Products of the rows, discounted so that one common ``inflation`` suits them and the dynamics. Rows are linear in the sensors'
        parameters, r(beta) = r - T beta, so that with A = T'T, b = T'r and c = r'r at the null value b(beta) = b - A beta and
        c(beta) = c - beta'(b + b(beta)); columns without a trace have zeros. Of a measured velocity that is 1 + s times the true one, s is not
        s of it but s / (1 + s), with slope 1 / (1 + s)^2."""
        null, m, k = self.parity.gram, len(self.parity.gram.c), len(self.columns)
        given = self.beta[list(null.columns)]
        beta = np.where(self.parity.factor, given / (1.0 + given), given)
        slope = np.where(self.parity.factor, (1.0 + given) ** -2, 1.0)
        b = null.b - null.A @ beta
        c = null.c - (null.b + b) @ beta
        place = {column: i for i, column in enumerate(null.columns)}
        to = [i for i, column in enumerate(self.columns) if column in place]
        of = [place[self.columns[i]] for i in to]
        scale = inflation / self.parity.inflation
        out = Products(np.zeros((m, k, k)), np.zeros((m, k)), scale * c, self.columns)
        out.A[np.ix_(range(m), to, to)] = scale * null.A[np.ix_(range(m), of, of)] * np.outer(slope[of], slope[of])
        out.b[:, to] = scale * b[:, of] * slope[of]
        return out


def parity(stretches: Stretches, columns: tuple[int, ...]) -> Parity:
    """Parity rows of every window and the trace that each sensor parameter among ``columns`` leaves in them."""
    nu, eta, whole = measured(stretches)
    nominal = drift(nu[:, LEAD:], eta[:, LEAD:], stretches.run.dt)
    nu, eta = (signal.savgol_filter(a, SMOOTH, 2, axis=1) for a in (nu, eta))
    smooth = drift(nu[:, LEAD:], eta[:, LEAD:], stretches.run.dt)
    sensor = [c for c in columns if load(stretches.plant.slots[c].effect).place == "sensor"]
    traces = np.zeros((*nominal.shape, len(columns)))
    for column in sensor:
        parameter = stretches.plant.slots[column].parameter
        step = STEP * parameter.typical
        beta = stretches.plant.null.copy()
        beta[column] += step
        seen = _seen(stretches, nu, eta, beta)
        traces[..., columns.index(column)] = wrap_angles(drift(seen.nu[:, LEAD:], seen.eta[:, LEAD:], stretches.run.dt) - smooth) / step
    keep = [i for i, name in enumerate(RELATIONS) if whole[i]]
    usable = complete(stretches)
    nominal[~usable], traces[~usable] = 0.0, 0.0
    return _weighted(stretches, nominal, traces, columns, keep)


def _seen(stretches: Stretches, nu: Array, eta: Array, beta: Array) -> Log:
    """The measured motion as sensors with the fault ``beta`` (k,) would have logged it."""
    plant = stretches.plant
    log = Log(nu, eta, stretches.run.dt, nu[:, 0], eta[:, 0])
    return observe(plant.vehicle, plant.index, plant.null, np.tile(beta, (len(nu), 1)), log)


def _weighted(stretches: Stretches, nominal: Array, traces: Array, columns: tuple[int, ...], keep: list[int]) -> Parity:
    """Rows and traces in standard errors: what all sensor faults together leave is the noise of each relation."""
    m, k = len(nominal), len(columns)
    if not keep:
        return _none(m, columns, ("no pose beside velocity in this log",))
    seen = np.flatnonzero(np.abs(traces).max(axis=(0, 1, 2)) > 0)
    slots = [stretches.plant.slots[c] for c in columns]
    free = np.array([i for i in seen if not load(slots[i].effect).of_one_axis(slots[i].parameter.name)], dtype=int)  # not needed to find the noise
    sigma = np.array([max(1.4826 * float(np.median(np.abs(nominal[..., i]))), LEAST_SIGMA[i]) for i in keep])
    notes: list[str] = []
    left = nominal[..., keep]
    for _ in range(2 if len(free) else 0):  # noise from what the joint fit leaves, the fit weighted by that noise
        G = traces[..., keep, :][..., free] / sigma[:, None]
        X = G.reshape(-1, len(free))
        y = (nominal[..., keep] / sigma).reshape(-1)
        typical = np.array([stretches.plant.slots[columns[i]].parameter.typical for i in free])
        fitted = np.linalg.lstsq(np.vstack([X, np.diag(0.1 / typical)]), np.concatenate([y, np.zeros(len(free))]), rcond=None)[0]
        left = (nominal[..., keep] / sigma - G @ fitted) * sigma
        sigma = np.maximum(left.std(axis=(0, 1)), [LEAST_SIGMA[i] for i in keep])
    keep, sigma = _independent(stretches, keep, sigma, notes)
    if not keep:
        return _none(m, columns, tuple(notes))
    rows = (nominal[..., keep] / sigma).reshape(m, -1)
    scaled = (traces[..., keep, :] / sigma[:, None]).reshape(m, rows.shape[1], k)
    inflation = _inflation(rows, scaled, free)
    gram = _gram(rows, scaled[..., seen], tuple(columns[i] for i in seen))
    factor = np.array([stretches.plant.slots[c].effect in FACTORS for c in gram.columns], dtype=bool)
    return Parity(rows, scaled, gram, factor, columns, tuple(RELATIONS[i] for i in keep), tuple(sigma.tolist()), inflation, tuple(notes))


def _none(m: int, columns: tuple[int, ...], notes: tuple[str, ...]) -> Parity:
    """No rows at all."""
    rows, traces = np.zeros((m, 0)), np.zeros((m, 0, len(columns)))
    return Parity(rows, traces, _gram(rows, traces[..., :0], ()), np.zeros(0, dtype=bool), columns, (), (), 1.0, notes)


def _gram(rows: Array, traces: Array, columns: tuple[int, ...]) -> Products:
    turned = traces.swapaxes(1, 2)
    return Products(turned @ traces, (turned @ rows[..., None])[..., 0], (rows**2).sum(axis=1), columns)


def _independent(stretches: Stretches, keep: list[int], sigma: Array, notes: list[str]) -> tuple[list[int], Array]:
    """Leave out horizontal positions that were integrated from the velocities they would check."""
    noise = dict(zip(stretches.channels, stretches.noise, strict=True))
    seconds = stretches.steps * stretches.run.dt
    out = []
    for i, s in zip(keep, sigma, strict=True):
        expected = noise.get("u", 0.0) * np.sqrt(stretches.run.dt * seconds / 6.0)  # random walk of integrated white noise, mean taken out
        if i < 2 and s < DEAD_RECKONED * expected:
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
