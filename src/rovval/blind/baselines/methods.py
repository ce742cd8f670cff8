"""What simple methods answer on the same logs: a diagnosis that names no more than they do is not worth its computing time.

``derivative``: pointwise accelerations, ordinary least squares of each hypothesis of the library, the best by BIC. ``sindy``: sparse
regression of the residual acceleration (`stlsq`). ``ridge``: all parameters of the library at once on the engine's own windows, the
hypothesis with the largest share of the fit. They know the library, the vehicle and the log, as the engine does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rovval.blind.baselines import stlsq
from rovval.blind.plant.spec import AXES, Array
from rovval.core.data import Run
from rovval.diagnose.criteria import PRIOR_WIDTH
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.problem.prior import tolerance_prior
from rovval.diagnose.problem.problem import pose
from rovval.diagnose.residuals.sensitivities import linearise
from rovval.diagnose.windows.multiple_shooting import cut_run
from rovval.diagnose.windows.windows import VELOCITY_CHANNELS, Windows
from rovval.vehicle.model import Vehicle

POINTS = 400  # instants of the pointwise methods, evenly over the log
LEAST_BIC_GAIN = 10.0  # BIC gain that counts as "very strong" (Kass and Raftery 1995)
PAIR_S = 0.2  # two samples


def baseline_answers(run: Run, vehicle: Vehicle, without: Sequence[str], model: str = "fossen", window_s: float = 10.0) -> dict[str, str]:
    """The effect that each simple method names, "" where it names none."""
    return _pointwise(run, vehicle, without, model) | {"ridge": _ridge(run, vehicle, without, model, window_s)}


def _pointwise(run: Run, vehicle: Vehicle, without: Sequence[str], model: str) -> dict[str, str]:
    points = _thinned(cut_run(run, vehicle, model, PAIR_S))
    library, _ = hypotheses((points,), without=without)
    asked = columns_of(library)
    columns, directions = tuple(sorted({*asked.slots, *tolerance_prior(points.plant, 0.05).sd})), asked.displaced
    origin = np.array([slot.parameter.null for slot in points.plant.slots])
    linear = linearise(points, origin, columns, directions)
    motion = [i for i, c in enumerate(points.channels) if c in VELOCITY_CHANNELS]
    fine = linear.valid & points.ok[:, :, motion].all(axis=(1, 2))
    r = (linear.r[fine][:, 1] - linear.r[fine][:, 0])[:, motion] / run.dt
    S = (linear.S[fine][:, 1] - linear.S[fine][:, 0])[:, motion] / run.dt
    return {"derivative": _by_bic(r, S, linear.columns, library), "sindy": _sparse(points, r, motion, fine)}


def _by_bic(r: Array, S: Array, columns: tuple[int, ...], library: Sequence[Hypothesis]) -> str:
    """Least squares per hypothesis, channels weighted by their spread; the best by BIC, "" where even that gains nothing."""
    spread = np.maximum(r.std(axis=0), 1e-12)
    y, n = (r / spread).ravel(), r.size
    place = {c: i for i, c in enumerate(columns)}
    scores: dict[str, float] = {}
    for h in library:
        x = (S[:, :, [place[c] for c in h.columns]] / spread[None, :, None]).reshape(n, -1)
        x = x[:, np.abs(x).max(axis=0) > 1e-9]
        left = y - x @ np.linalg.lstsq(x, y, rcond=None)[0] if x.shape[1] else y
        gain = n * np.log(float(y @ y) / max(float(left @ left), 1e-300)) - (x.shape[1] + len(h.at)) * np.log(n)
        scores[h.name] = max(gain, scores.get(h.name, -np.inf))
    best = max(scores, key=lambda k: scores[k])
    return best if scores[best] > LEAST_BIC_GAIN else ""


def _sparse(points: Windows, r: Array, motion: list[int], fine: np.ndarray) -> str:
    run, at = points.run, points.start[fine]
    values = {c: np.nan_to_num(run.get(c)[at]) for c in (*VELOCITY_CHANNELS, "z", "psi")} | {"t": run.t[at]}
    thrust = points.plant.thrust(points.actuation.inputs.speed)[at]
    names = tuple(points.plant.vehicle.thrusters)
    axes = dict(zip(VELOCITY_CHANNELS, AXES, strict=True))
    residual = {axes[points.channels[i]]: r[:, j] for j, i in enumerate(motion)}
    return stlsq.name(residual, stlsq.terms(values, dict(zip(names, thrust.T, strict=True))), names)


def _ridge(run: Run, vehicle: Vehicle, without: Sequence[str], model: str, window_s: float) -> str:
    parts = (cut_run(run, vehicle, model, window_s),)
    library, _ = hypotheses(parts, without=without)
    problem = pose(parts, columns_of(library), 0.05)
    sd = {c: s.parameter.typical for c, s in enumerate(problem.plant.slots)}
    sd |= {c: s / PRIOR_WIDTH for h in library if h.displaced for c, s in zip(h.columns, h.sd, strict=True)}
    A, b = problem.likelihood.total.A.sum(axis=0), problem.likelihood.total.b.sum(axis=0)
    prior = np.array([problem.design_effect / sd[c] ** 2 for c in problem.likelihood.total.columns])
    step = np.linalg.solve(A + np.diag(prior), b)
    part: dict[str, float] = {}
    for h in library:
        i = problem.likelihood.total.place(h.columns)
        part[h.name] = part.get(h.name, 0.0) + float(step[i] @ A[np.ix_(i, i)] @ step[i])
    return max(part, key=lambda k: part[k])


def _thinned(points: Windows) -> Windows:
    every = max(1, points.count // POINTS)
    pick = slice(None, None, every)
    return replace(
        points, start=points.start[pick], nu0=points.nu0[pick], eta0=points.eta0[pick], y=points.y[pick], ok=points.ok[pick]
    )
