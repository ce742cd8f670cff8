"""Sensor faults as kinematics alone show them: each fitted to the parity residuals by itself, with its interval.

Intervals come from the scatter of the windows' scores (sandwich covariance: White 1982), with Student's t.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import stats

from rovval.core.data import Array
from rovval.diagnose.criteria import FAULT_SPARE_WINDOWS, MATERIAL
from rovval.diagnose.residuals.parity import ParityResiduals
from rovval.diagnose.windows.windows import Windows
from rovval.effects import load
from rovval.plant.slots import Slot

STEPS, CONVERGED = 6, 1e-9  # Gauss-Newton steps at most, and the share of the loss that one must gain for another to follow


@dataclass(frozen=True, slots=True)
class FittedFault:
    """A parameter of a sensor, fitted to the parity residuals by itself.

    Attributes:
        fault: the parameter, such as ``gyro_bias.r``.
        value: estimate, in ``unit``.
        low, high: 90 % interval.
        was: what the vehicle's file says of it.
        unit: of all four.
        share: of the squared parity residuals that the fault accounts for.
        significant: whether ``was`` lies outside the interval, ``share`` is above `MATERIAL`, and the estimate is a value that the parameter can have.
        check: the kinematic identity in words.
        note: how it was fitted, in words.
    """

    fault: str
    value: float
    low: float
    high: float
    was: float
    unit: str
    share: float
    significant: bool
    check: str = "measured velocity against measured pose"
    note: str = "fitted alone, by kinematics, without dynamics"


def sensor_faults(parity: ParityResiduals, windows: Windows, origin: Array) -> list[FittedFault]:
    """Each sensor effect, and the scale factor of each axis, fitted to one run's parity residuals by itself.

    ``origin`` (k,) are the parameters of the vehicle's file. A fault is left out where windows are too few for their scatter to say how sure it is
    (`FAULT_SPARE_WINDOWS`).
    """
    found = list[FittedFault]()
    by_effect: dict[tuple[str, str], list[int]] = {}
    for i, column in enumerate(parity.columns):
        if np.abs(parity.signatures[..., i]).max(initial=0.0) > 0:
            by_effect.setdefault(_jointly(windows.plant.slots[column]), []).append(i)
    total, count = float((_about(parity, origin)[0] ** 2).sum()), int((np.abs(parity.signatures).max(axis=(1, 2), initial=0.0) > 0).sum())
    for places in by_effect.values():
        if count < len(places) + FAULT_SPARE_WINDOWS:
            continue
        value, score, H, loss = _fitted(parity, origin, places)
        bread = np.linalg.inv(H)
        error = np.sqrt(np.diag(bread @ (score.T @ score) @ bread))
        t = float(stats.t.ppf(0.95, count - len(places)))
        share = 1.0 - loss / total if total > 0 else 0.0
        for j, place in enumerate(places):
            slot_id = parity.columns[place]
            slot = windows.plant.slots[slot_id]
            low, high, was = float(value[j] - t * error[j]), float(value[j] + t * error[j]), float(origin[slot_id])
            possible = slot.parameter.low <= was + float(value[j]) <= slot.parameter.high
            found.append(
                FittedFault(
                    fault=slot.key,
                    value=was + float(value[j]),
                    low=was + low,
                    high=was + high,
                    was=was,
                    unit=slot.parameter.unit,
                    share=share,
                    significant=bool(low > 0 or high < 0) and share > MATERIAL and possible,
                )
            )
    return found


def _fitted(check: ParityResiduals, origin: Array, places: list[int]) -> tuple[Array, Array, Array, float]:
    """Least squares fit of faults: (departure from ``origin`` (p,), score of each window there (m, p), curvature (p, p), squared residuals).

    Residuals are not linear in a delay, hence Gauss-Newton steps as long as the fit gets better.
    """
    beta, columns = origin.copy(), [check.columns[i] for i in places]
    rows, signatures = _about(check, beta)
    for _ in range(STEPS):
        score, H = _normal(rows, signatures[..., places])
        trial = beta.copy()
        trial[columns] += np.linalg.solve(H, score.sum(axis=0))
        there, slopes = _about(check, trial)
        if (there**2).sum() >= (1.0 - CONVERGED) * (rows**2).sum():
            break
        beta, rows, signatures = trial, there, slopes
    return (beta - origin)[columns], *_normal(rows, signatures[..., places]), float((rows**2).sum())


def _normal(rows: Array, G: Array) -> tuple[Array, Array]:
    """Scores of the windows (m, p) and curvature (p, p) of signatures ``G`` (m, q, p)."""
    return np.einsum("wqi,wq->wi", G, rows), np.einsum("wqi,wqj->ij", G, G) + 1e-12 * np.eye(G.shape[-1])


def _about(check: ParityResiduals, beta: Array) -> tuple[Array, Array]:
    """Parity residuals (m, q) and fault signatures (m, q, p) at the sensor parameters of ``beta`` (k,)."""
    rows, signatures = check.at_delays(beta)
    linear = np.array([0.0 if c in check.delays else beta[c] for c in check.columns])
    return rows - signatures @ linear, signatures


def _jointly(slot: Slot) -> tuple[str, str]:
    """Key of the parameters that are fitted jointly: those of an effect, except that another form of it is fitted by itself."""
    return slot.hypothesis, slot.parameter.name if load(slot.effect).is_another_form(slot.parameter.name) else ""
