"""Parity: faults of the sensors shown by kinematics alone, without any dynamics.

Measured velocities integrated through the measured attitude must give the measured pose: what they give less what was measured is the
parity residual of a window (its mean taken out, since the pose at the window's start is itself only measured). Gyro bias,
velocity scale, misalignment, lever arm, filter lag, compass and attitude bias each leave their own trace in it; no force does.
The residual and those traces enter the contest of hypotheses as rows beside the dynamics: a sensor fault must explain both.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import signal, stats

from rovval.data import Array, Flags
from rovval.diagnose.products import Products
from rovval.diagnose.stretches import Stretches
from rovval.effects import load
from rovval.frames import euler_rates, rotation_from_euler, wrap
from rovval.plant.sensors import Log, observe

ROW_EVERY = 10  # samples between rows of a window: poses 1 s apart, whose errors are nearly independent
RELATIONS = ("x", "y", "z", "phi", "theta", "psi")
LEAST_SIGMA = (0.005, 0.005, 0.002, 0.001, 0.001, 0.001)  # m, rad: no sensor is believed below these (chosen)
STEP = 0.25  # finite-difference step, in typical sizes
LEAD = 10  # samples before a window from which a sensor's memory is filled: many times the steps of delays and lags (0.05 s)
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
    nu, eta, whole = _measured(stretches)
    nominal = _drift(nu[:, LEAD:], eta[:, LEAD:], stretches.run.dt)
    nu, eta = (signal.savgol_filter(a, SMOOTH, 2, axis=1) for a in (nu, eta))
    smooth = _drift(nu[:, LEAD:], eta[:, LEAD:], stretches.run.dt)
    sensor = [c for c in columns if load(stretches.plant.slots[c].effect).place == "sensor"]
    traces = np.zeros((*nominal.shape, len(columns)))
    for column in sensor:
        parameter = stretches.plant.slots[column].parameter
        step = STEP * parameter.typical
        beta = stretches.plant.null.copy()
        beta[column] += step
        seen = _seen(stretches, nu, eta, beta)
        traces[..., columns.index(column)] = wrap_angles(_drift(seen.nu[:, LEAD:], seen.eta[:, LEAD:], stretches.run.dt) - smooth) / step
    keep = [i for i, name in enumerate(RELATIONS) if whole[i]]
    usable = _complete(stretches)
    nominal[~usable], traces[~usable] = 0.0, 0.0
    return _weighted(stretches, nominal, traces, columns, keep)


def faults(parity_rows: Parity, stretches: Stretches) -> list[dict[str, object]]:
    """Each sensor effect fitted to the parity rows alone: value with 90 % interval and whether it is significant on its own."""
    found: list[dict[str, object]] = []
    by_effect: dict[str, list[int]] = {}
    for i, column in enumerate(parity_rows.columns):
        if np.abs(parity_rows.traces[..., i]).max(initial=0.0) > 0:
            by_effect.setdefault(stretches.plant.slots[column].hypothesis, []).append(i)
    total = float((parity_rows.rows**2).sum())
    for places in by_effect.values():
        trace = parity_rows.traces[..., places]
        H = np.einsum("wqi,wqj->ij", trace, trace) + 1e-12 * np.eye(len(places))
        g = np.einsum("wqi,wq->wi", trace, parity_rows.rows)
        value = np.linalg.solve(H, g.sum(axis=0))
        score = g - np.einsum("wqi,wqj,j->wi", trace, trace, value)
        bread = np.linalg.inv(H)
        error = np.sqrt(np.diag(bread @ (score.T @ score) @ bread))
        t = float(stats.t.ppf(0.95, max(len(g) - len(places), 2)))
        share = float(g.sum(axis=0) @ value) / total if total > 0 else 0.0
        for j, place in enumerate(places):
            slot = stretches.plant.slots[parity_rows.columns[place]]
            low, high = float(value[j] - t * error[j]), float(value[j] + t * error[j])
            found.append(
                {
                    "check": "measured velocity against measured pose",
                    "fault": slot.key,
                    "value": float(value[j]),
                    "low": low,
                    "high": high,
                    "unit": slot.parameter.unit,
                    "share": share,
                    "significant": bool(low > 0 or high < 0) and share > 0.05,
                    "note": "fitted alone, by kinematics, without dynamics",
                }
            )
    return found


def wrap_angles(rows: Array) -> Array:
    """Differences of the last three relations (angles) wrapped; rows (..., 6 relations)."""
    out = np.array(rows)
    out[..., 3:] = wrap(out[..., 3:])
    return out


def _seen(stretches: Stretches, nu: Array, eta: Array, beta: Array) -> Log:
    """The measured motion as sensors with the fault ``beta`` (k,) would have logged it."""
    plant = stretches.plant
    log = Log(nu, eta, stretches.run.dt, nu[:, 0], eta[:, 0])
    return observe(plant.vehicle, plant.index, plant.null, np.tile(beta, (len(nu), 1)), log)


def _measured(stretches: Stretches) -> tuple[Array, Array, Flags]:
    """Velocities and poses of the windows and the LEAD before them (m, LEAD + n, 6), held before the log's start, gaps bridged linearly,
    and which relations the log can serve (6,)."""
    run = stretches.run
    at = np.maximum(stretches.start[:, None] + np.arange(-LEAD, stretches.steps + 1)[None, :], 0)
    nu = np.stack([_bridged(run.get(c))[at] for c in ("u", "v", "w", "p", "q", "r")], axis=-1)
    eta = np.stack([_bridged(run.get(c), angle=c in RELATIONS[3:])[at] for c in RELATIONS], axis=-1)
    attitude = all(run.measured(c) for c in RELATIONS[3:])
    linear = attitude and all(run.measured(c) for c in ("u", "v", "w"))
    angular = attitude and all(run.measured(c) for c in ("p", "q", "r"))
    return nu, eta, np.array([(linear if i < 3 else angular) and run.measured(c) for i, c in enumerate(RELATIONS)])


def _bridged(values: Array, angle: bool = False) -> Array:
    good = np.isfinite(values)
    if not good.any():
        return np.zeros_like(values)
    line = np.interp(np.arange(len(values)), np.flatnonzero(good), np.unwrap(values[good]) if angle else values[good])
    return np.asarray(line)


def _complete(stretches: Stretches) -> Flags:
    """Windows (m,) in which velocity and attitude were measured nearly throughout (bridged gaps would look like faults)."""
    run = stretches.run
    at = stretches.start[:, None] + np.arange(stretches.steps + 1)[None, :]
    needed = [c for c in ("u", "v", "w", "p", "q", "r", "phi", "theta", "psi") if run.measured(c)]
    return np.asarray(np.all([run.ok(c)[at].mean(axis=1) > 0.9 for c in needed], axis=0))


def _drift(nu: Array, eta: Array, dt: float) -> Array:
    """Dead-reckoned less measured pose (m, rows, 6) at every row, mean of the window taken out. Trapezoidal rule."""
    world = np.einsum("mnij,mnj->mni", rotation_from_euler(eta[..., 3:]), nu[..., :3])
    rates = np.concatenate([world, euler_rates(eta[..., 3:], nu[..., 3:])], axis=-1)
    path = np.concatenate([np.zeros_like(rates[:, :1]), np.cumsum(0.5 * dt * (rates[:, 1:] + rates[:, :-1]), axis=1)], axis=1)
    off = wrap_angles(eta[:, :1] + path - eta)
    off[..., 3:] = np.unwrap(off[..., 3:], axis=1)
    rows = off[:, ::ROW_EVERY]
    return np.asarray(rows - rows.mean(axis=1, keepdims=True))


def _weighted(stretches: Stretches, nominal: Array, traces: Array, columns: tuple[int, ...], keep: list[int]) -> Parity:
    """Rows and traces in standard errors: what all sensor faults together leave is the noise of each relation."""
    m, k = len(nominal), len(columns)
    if not keep:
        return _none(m, columns, ("no pose beside velocity in this log",))
    free = np.flatnonzero(np.abs(traces).max(axis=(0, 1, 2)) > 0)
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
    scaled = (traces[..., keep, :] / sigma[:, None]).reshape(m, -1, k)
    inflation = _inflation(rows, scaled, free)
    gram = _gram(rows, scaled[..., free], tuple(columns[i] for i in free))
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
