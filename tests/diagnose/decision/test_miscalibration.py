"""A file that is off in many numbers: which ones, and what that explains."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnose_case import posed, slot

from rovval.diagnose.criteria import FILE_WIDTH
from rovval.diagnose.decision.miscalibration import departures
from rovval.diagnose.inference.laplace import laplace_evidence, promised_evidence
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.residuals.ridge import Prior

OFF = ("quadratic_drag[surge]:scale=0.6", "quadratic_drag[heave]:scale=0.6")


@pytest.mark.parametrize("alike", [0.0, 0.3])
def test_the_numbers_that_are_off_are_found_and_their_evidence_is_that_of_a_wider_prior(alike: float):
    """The update of rank one against the same evidence worked out anew; and the two drags that are off come first."""
    problem, _ = posed(OFF)
    columns = tuple(problem.tolerance.sd)
    problem = replace(problem, tolerance=Prior(problem.tolerance.sd, columns, np.full((len(columns),) * 2, alike) + (1.0 - alike) * np.eye(len(columns))))
    point = healthy_fit(problem)
    among = sorted(problem.tolerance.sd)
    found = departures(problem, point, among)
    assert {problem.plant.slots[s].key.partition("[")[2].partition("]")[0] for s in found[1].slots} == {"surge", "heave"}
    for file in found[:3]:
        wide = problem.tolerance.off_by_more({s: FILE_WIDTH * problem.tolerance.sd[s] for s in file.slots})
        again = replace(point, precision=problem.tempering * wide.precision(point.columns))
        assert file.evidence == pytest.approx(promised_evidence(problem, again) - file.cost, abs=0.1)
        assert file.cost == pytest.approx(2.0 * len(file.slots) * np.log(len(among)))


def test_a_healthy_vehicle_is_not_off():
    """Each number that is freed costs more than it explains."""
    problem, _ = posed()
    point = healthy_fit(problem)
    before = laplace_evidence(problem, point)
    assert all(file.evidence < before - len(file.slots) for file in departures(problem, point, sorted(problem.tolerance.sd)))
    assert slot(problem, "quadratic_drag[surge].scale") in problem.tolerance.sd
