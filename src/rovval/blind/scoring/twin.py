"""What an effect that the library lacks has done to its log: the same flight is flown again without it, and both logs are held against the healthy vehicle.

The oracle fits a true effect's own form; where the library has none, the twin log says how large the gap would have been without the effect. The two
flights part, since the pilot sees the effect too: they are compared in the mean over their windows, and the scatter of these says how sure that is.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from rovval.blind.cases.generate import make
from rovval.blind.cases.grid import Case
from rovval.blind.plant.spec import Array
from rovval.diagnose.hypotheses.hypothesis import columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.problem.problem import gap_equations_at, pose
from rovval.diagnose.windows.multiple_shooting import cut_run


def made_by_effect(log: Path, vehicle: str, without_it: Case, asked: Mapping[str, Any]) -> dict[str, float]:
    """``seen``: share of the log's squared gap to the healthy vehicle, coefficients fitted within tolerance, that its twin, the case ``without_it``, does
    not have, of the dynamics or with the kinematic checks, whichever is larger; ``sure``: the standard errors of that difference. Empty where no twin can
    be flown, or a log has no usable window."""
    from rovval.core.errors import RovvalError

    with TemporaryDirectory() as folder:
        twin = Path(folder) / "twin.csv"
        if "failed" in make(Path(vehicle), without_it, twin):
            return {}
        try:
            with_it, without = (_gap(path, vehicle, **asked) for path in (log, twin))
        except (RovvalError, ArithmeticError, ValueError):
            return {}
    shares = 1.0 - without.mean(axis=1) / with_it.mean(axis=1)
    error = np.sqrt(sum(gap.var(axis=1, ddof=1) / gap.shape[1] for gap in (with_it, without)))
    best = int(np.argmax(shares))
    return {"seen": float(shares[best]), "sure": float((with_it.mean(axis=1) - without.mean(axis=1))[best] / error[best])}


def _gap(log: Path, vehicle: str, model: str, window_s: float, calibration_slop: float) -> Array:
    """Squared gap (2, m) of each window to the healthy vehicle, in the metric of the sensors' noise: of the dynamics, and with the kinematic checks."""
    from rovval.blind.sealed.answer import PROFILE
    from rovval.storage.archive import open_run
    from rovval.vehicle import load as load_vehicle

    part = cut_run(open_run(log, PROFILE), load_vehicle(vehicle), model, window_s)
    library, _ = hypotheses((part,))
    problem = pose((part,), columns_of(library), calibration_slop)
    return np.array([products.c for products in gap_equations_at(problem, healthy_fit(problem).beta, ())])
