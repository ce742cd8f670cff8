"""Dependence of a cause's size on what was logged: a varying-coefficient model (Hastie and Tibshirani 1993).

A cause whose equation is right has one size at every speed, heading, depth and thrust. What only looks like it (a drag that acts one way, a supply that gives
way under load, a Doppler log that loses a beam at speed) has another size where something else is so. Beside the fit of a cause stand its responses times
each covariate, which say how much its size changes with that covariate.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from rovval.core.data import Array
from rovval.core.large_arrays import columns_first
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.problem.cross_validation import by_fold
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.equivalent_wrench import equivalent_wrench
from rovval.diagnose.residuals.external_forces import wrench_sensitivities
from rovval.diagnose.residuals.normal_equations import Linearisation
from rovval.diagnose.search.discrepancy import GenericForces, beside
from rovval.diagnose.windows.windows import Windows
from rovval.effects.effect import Role

CONSTANT = 1e-6  # standard deviation, in the covariate's unit: one that varies less is none (rounding)
PLACED: Mapping[Role, str] = {"datum": "depth", "bottom": "depth", "onset": "time"}  # role of a parameter that places a cause -> along which covariate


def dependence(problem: Problem, point: Posterior, causes: Sequence[Hypothesis]) -> GenericForces | None:
    """The responses of each of ``causes``, fitted at ``point``, times each covariate, as further columns beside the fit; named by (cause, covariate), in units
    of the cause's size for one standard deviation of the covariate. None where there is no cause or no covariate.

    A cause that pushes is the wrench that does the same; what a sensor's fault adds to the log is multiplied itself, the parity residuals left as they are. A
    cause that is placed along a covariate (`PLACED`) is not held to one size along it: of the course of a stratification or a leak there is no law.
    """
    varying = covariates(problem.runs)
    asked = [[c for c in varying[0] if c not in (along for role, along in PLACED.items() if h.effect.has(role))] for h in causes]
    names = tuple((h.name, covariate) for h, own in zip(causes, asked, strict=True) for covariate in own)
    if not names:
        return None
    answers, linear = list[Array](), point.linear
    for windows, one, along in zip(problem.runs, linear, varying, strict=True):
        answer, at = columns_first(*one.r.shape, columns=len(names)), 0
        for h, own in zip(causes, asked, strict=True):
            answer[..., at : at + len(own)] = _responses(problem, point, windows, one, h, [along[name] for name in own])
            at += len(own)
        answers.append(answer)
    prior = point.precision, point.pull
    found, k = beside(problem, names, answers, linear, *prior, np.zeros(len(names))), len(point.columns)
    parity = by_fold(replace(point.total, A=point.total.A - point.dynamics.A, b=point.total.b - point.dynamics.b), problem.folds)
    found.data.A[:, :k, :k] += parity.A
    found.data.b[:, :k] += parity.b
    return found


def covariates(runs: Sequence[Windows]) -> list[Mapping[str, Array]]:
    """What a size may go with: of each run series (run,) by name, of mean zero and standard deviation one over the windows of all runs; those that all runs
    have and that vary."""
    found = [_series(windows) for windows in runs]
    inside = [windows.samples().reshape(-1) for windows in runs]
    kept: list[dict[str, Array]] = [{} for _ in runs]
    for name in found[0]:
        if all(name in one for one in found):
            values = np.concatenate([one[name][at] for one, at in zip(found, inside, strict=True)])
            if values.std() > CONSTANT:
                for one, into in zip(found, kept, strict=True):
                    into[name] = (one[name] - values.mean()) / values.std()
    return list(kept)


def _series(windows: Windows) -> dict[str, Array]:
    run, found = windows.run, dict[str, Array]()
    for c in ("u", "v", "w", "r"):
        if run.measured(c):
            found[c] = np.nan_to_num(run.get(c))
            found[f"|{c}|"] = np.abs(found[c])
    if run.measured("psi"):
        heading = np.nan_to_num(run.get("psi"))
        found["cos heading"], found["sin heading"] = np.cos(heading), np.sin(heading)
    for c, words in (("phi", "roll angle"), ("theta", "pitch angle"), ("z", "depth")):
        if run.measured(c):
            found[words] = np.nan_to_num(run.get(c))
    found["time"] = run.t.astype(float)
    found["thrusters' speed"] = np.sqrt(np.mean(windows.actuation.inputs.speed**2, axis=1))
    return found


def _responses(problem: Problem, point: Posterior, windows: Windows, one: Linearisation, h: Hypothesis, series: Sequence[Array]) -> Array:
    """Responses (m, n, c, f) of one run's windows to a cause times each covariate, of which ``series`` (run,) are given."""
    if h.effect.place == "sensor":
        at = [i for i, slot in enumerate(point.columns) if slot in h.slots]
        response = one.S[..., at] @ point.predicted_departure()[at]
        return np.asarray(response[..., None] * np.stack([x[windows.samples()] for x in series], axis=-1)[:, :, None])
    without = point.beta.copy()
    without[list(h.slots)] = problem.origin[list(h.slots)]
    wrench = equivalent_wrench(windows, point.beta, without)
    return wrench_sensitivities(windows, point.beta, len(series), lambda i: wrench * series[i][:, None])
