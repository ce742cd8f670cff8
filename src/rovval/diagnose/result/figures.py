"""The data of the figures: heat map of axis by regime, the worst windows before and after, the coherence matrix."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.decision.verdict import Decision
from rovval.diagnose.inference.gap import ANGULAR
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit, only_places
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.coherence import coherence
from rovval.diagnose.residuals.sensitivities import residual
from rovval.diagnose.result.attribution import slices
from rovval.diagnose.result.diagnosis import Coherence, HeatMap, Trace
from rovval.diagnose.search.forward import Selection
from rovval.diagnose.windows.windows import Windows, axis_channels

TRACES = 4  # windows drawn
COHERENCE_EFFECTS = 10  # rows of the matrix


def heat_map(part: Windows, error: Array, seed: int) -> HeatMap:
    """Share of each axis's squared gap in each regime, and the lift; ``error`` (m, n, c) are the nominal simulator's residuals of a run."""
    found = slices(part, error, part.ok, seed)
    axes = list(dict.fromkeys(s.axis for s in found))
    regimes = list(dict.fromkeys(s.regime for s in found))
    share, lift = np.zeros((len(axes), len(regimes))), np.zeros((len(axes), len(regimes)))
    for s in found:
        share[axes.index(s.axis), regimes.index(s.regime)] = s.share
        lift[axes.index(s.axis), regimes.index(s.regime)] = s.lift
    return HeatMap(axes=tuple(axes), regimes=tuple(regimes), share=_rows(share, 4), lift=_rows(lift, 3))


def traces(problem: Problem, fitted: HypothesisFit | None, before: list[Array]) -> tuple[Trace, ...]:
    """Measured, nominal and corrected curves of the windows with the largest weighted gap, at most one of an axis and run.

    ``before`` are the nominal simulator's residuals (m, n, c) of each run; without ``fitted`` causes the corrected curve is the nominal one.
    """
    found = []
    beta = problem.origin if fitted is None else fitted.beta
    for number, part in enumerate(problem.runs):
        nominal, corrected = residual(part, problem.origin)[0], residual(part, beta)[0]
        for axis, channel in axis_channels(part).items():
            weight = (np.where(part.ok[..., channel], before[number][..., channel] ** 2, 0.0) / problem.gap.variance[:, channel]).sum(axis=1)
            w = int(weight.argmax())
            found.append((float(weight[w]), number, axis, channel, w, nominal, corrected))
    found.sort(key=lambda item: -item[0])
    return tuple(_trace(problem.runs[number], axis, channel, w, *pair) for _, number, axis, channel, w, *pair in found[:TRACES])


def _trace(part: Windows, axis: str, channel: int, w: int, nominal: Array, corrected: Array) -> Trace:
    ok, y = part.ok[w, :, channel], part.y[w, :, channel]
    t = part.time()[w]
    name = part.channels[channel]
    pose = name in ("x", "y", "z", "phi", "theta", "psi")
    return Trace(
        title=f"{axis}, {t[0]:.0f} to {t[-1]:.0f} s of {part.run.id}",
        axis=axis,
        unit=("rad" if axis in ANGULAR else "m") + ("" if pose else "/s"),
        t_s=t[ok].round(3).tolist(),
        measured=y[ok].tolist(),
        nominal=(y - nominal[w, :, channel])[ok].tolist(),
        corrected=(y - corrected[w, :, channel])[ok].tolist(),
    )


def coherence_matrix(problem: Problem, selection: Selection, decision: Decision) -> Coherence:
    """First canonical correlation between the projected sensitivities of the causes, their groups and the best-ranked effects."""
    columns = set(problem.likelihood.total.columns)
    wanted = [name for n in decision.causes for name, _ in decision.groups[n.name]] + [name for name, _ in selection.ranking]
    own = {n: tuple(s for s in problem.plant.hypotheses[n] if not only_places(problem, s)) for n in dict.fromkeys(wanted)}
    names = [n for n in own if set(own[n]) <= columns][:COHERENCE_EFFECTS]
    slots = [own[n] for n in names]
    matrix = [[coherence(problem.likelihood.total, a, b) if a != b else 1.0 for b in slots] for a in slots]
    return Coherence(effects=tuple(names), matrix=_rows(np.array(matrix), 3) if names else ())


def _rows(matrix: Array, digits: int) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in np.round(matrix, digits).tolist())
