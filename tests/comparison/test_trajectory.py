"""Track errors: evo's own figures on the same track, and what must not change them."""

from __future__ import annotations

import numpy as np
import pytest

from rovval.comparison.trajectory import absolute_error, aligned, relative_error
from rovval.core.data import Array
from rovval.core.frames import rotation_from_euler

T = np.arange(0.0, 60.0, 0.1)
EVO = {"ape": 0.738427, "aligned": 0.356682, "rpe": 0.562796}  # m, rmse of the part translation


def tracks() -> tuple[Array, Array]:
    """Poses (600, 6) of a helix, and of one that turns and drifts beside it."""
    measured = np.stack([3 * np.sin(0.2 * T), 3 * np.cos(0.2 * T), 0.1 * T, 0.05 * np.sin(T), 0.1 * np.cos(T), -0.2 * T], axis=1)
    drift = np.stack([0.02 * T, 0.3 * np.sin(0.1 * T), 0.2 * np.cos(0.3 * T), 0.02 * np.cos(T), 0.03 * np.sin(T), 0.003 * T], axis=1)
    return measured, measured + drift


def test_errors_are_those_of_evo():
    """evo 1.38.1 on these two tracks as TUM files: evo_ape; evo_ape --align; evo_rpe --delta 100 --delta_unit f; each translation, rmse."""
    measured, simulated = tracks()
    assert absolute_error(measured[:, :3], simulated[:, :3]) == pytest.approx(EVO["ape"], abs=1e-6)
    assert absolute_error(measured[:, :3], aligned(measured[:, :3], simulated[:, :3])) == pytest.approx(EVO["aligned"], abs=1e-6)
    assert relative_error(measured, simulated, 100) == pytest.approx(EVO["rpe"], abs=1e-6)


def test_a_rigid_motion_of_the_whole_track_is_no_error_once_aligned_and_none_of_the_way_made():
    measured, _ = tracks()
    turn = rotation_from_euler(np.array([0.3, -0.2, 1.0]))
    moved = measured[:, :3] @ turn.T + [5.0, -2.0, 1.0]
    assert absolute_error(measured[:, :3], moved) > 1.0
    assert absolute_error(measured[:, :3], aligned(measured[:, :3], moved)) < 1e-9
    heading = np.array([0.0, 0.0, 0.7])
    yawed = np.concatenate([measured[:, :3] @ rotation_from_euler(heading).T, measured[:, 3:] + heading], axis=1)
    assert relative_error(measured, yawed, 100) < 1e-9
