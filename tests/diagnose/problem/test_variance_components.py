"""Noise and disturbances at their most likely: what was put in is found, from wherever the search begins."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnose_case import merlin, own

from rovval.core.channels import AXES
from rovval.diagnose.criteria import LEAST_NOISE
from rovval.diagnose.effort import DISTURBANCE_SEGMENTS
from rovval.diagnose.problem.disturbance import covariance, segment_responses
from rovval.diagnose.problem.variance_components import Components, variance_components
from rovval.diagnose.residuals.external_forces import typical_wrench
from rovval.diagnose.residuals.sensitivities import linearise
from rovval.diagnose.windows.multiple_shooting import cut

PUT_IN = Components(np.array([0.1, 0.1, 0.1, 0.02, 0.05, 0.1]), np.array([0.5, 0.8, 0.9, 0.8, 0.8, 0.3]), np.array([]))
SHOW = [0, 1, 2, 5]  # the axes that a log flown level shows


@pytest.fixture(scope="module")
def quiet():
    """Windows of a healthy log of the project's own plant and what they answer to pushes."""
    runs, _ = cut([own((), 5, 240.0)], merlin(), "fossen", 10.0)
    return runs, segment_responses(runs, runs[0].plant.null, typical_wrench(runs))


@pytest.fixture(scope="module")
def noise(quiet):
    """Noise of each channel, more than the least that is believed of a sensor."""
    return 3.0 * np.array([LEAST_NOISE[channel] for channel in quiet[0][0].channels])


def residuals(quiet, share, noise):
    """Residuals of nothing but forces of these ``share`` (6,) and white ``noise``."""
    (windows,), (answers,) = quiet
    rng = np.random.default_rng(1)
    root = np.linalg.cholesky(covariance(np.maximum(share, 1e-9), PUT_IN.correlation))
    forces = rng.normal(size=(windows.count, len(AXES) * DISTURBANCE_SEGMENTS)) @ root.T
    one = linearise(windows, windows.plant.null, ())
    r = np.einsum("wtci,wi->wtc", answers, forces) + noise * rng.normal(size=one.r.shape)
    return [replace(one, r=np.where(windows.ok, r, 0.0))]


def test_noise_disturbances_and_their_memory_are_found(quiet, noise):
    found = variance_components(quiet[0], residuals(quiet, PUT_IN.share, noise), quiet[1], Components.initial(3.0 * noise))
    assert found.noise == pytest.approx(noise, rel=0.05)
    assert found.share[SHOW] == pytest.approx(PUT_IN.share[SHOW], rel=0.25)
    assert np.abs(found.correlation - PUT_IN.correlation)[SHOW].max() < 0.2


def test_it_ends_at_the_same_wherever_it_begins(quiet, noise):
    left = residuals(quiet, PUT_IN.share, noise)
    one, other = (variance_components(quiet[0], left, quiet[1], Components.initial(factor * noise)) for factor in (0.5, 10.0))
    assert one.noise == pytest.approx(other.noise, rel=0.02) and one.share[SHOW] == pytest.approx(other.share[SHOW], rel=0.1)


def test_where_nothing_was_put_in_there_is_next_to_none(quiet, noise):
    found = variance_components(quiet[0], residuals(quiet, np.zeros(6), noise), quiet[1], Components.initial(3.0 * noise))
    assert found.share[SHOW].max() < 0.02 and found.noise == pytest.approx(noise, rel=0.05)


def test_what_is_louder_than_the_sensors_is_noise_and_no_force(quiet, noise):
    loud = noise * np.where(np.array(quiet[0][0].channels) == "r", 4.0, 1.0)
    found = variance_components(quiet[0], residuals(quiet, np.zeros(6), loud), quiet[1], Components.initial(noise))
    assert found.noise == pytest.approx(loud, rel=0.05) and found.share[SHOW].max() < 0.02
