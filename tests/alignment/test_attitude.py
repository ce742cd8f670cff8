"""Attitude of a log that tumbles comes to the grid as one rotation."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rovval.alignment import align
from rovval.core.data import RawLog, Reason, Run, Series

RATE = np.array([0.0, 1.3, 0.0])  # rad/s in body axes: over and over in 4.8 s
EULER = ("phi", "theta", "psi")
LARGEST = 1.3 * 0.025  # rad: a mean may stand a quarter of a step from its grid point, as that of any channel


def attitude(t: np.ndarray) -> Rotation:
    """Exact: past both poles of the Euler angles by a thousandth of a radian."""
    return Rotation.from_euler("ZYX", [0.3, 0.1, 0.001]) * Rotation.from_rotvec(np.outer(t, RATE))


def logged(hz: float, seconds: float = 40.0, phase: float = 0.013) -> RawLog:
    t = phase + np.arange(round(seconds * hz)) / hz
    angles = attitude(t).as_euler("ZYX")[:, ::-1]
    channels = {name: Series(t, angles[:, i], "row") for i, name in enumerate(EULER)}
    grid = (np.arange(round(seconds * 10)) * 0.1).astype(np.float64)
    return RawLog("tumbling.csv", "ab" * 32, "test", "", None, channels | {"n:A": Series(grid, np.sin(grid), "row")})


def off(run: Run) -> np.ndarray:
    """Angles between the run's attitude and the exact one, rad, where the run has one."""
    ok = np.all([run.ok(name) for name in EULER], axis=0)
    assert ok.mean() > 0.9
    found = Rotation.from_euler("ZYX", run.stack(EULER)[ok][:, ::-1])
    t = float(run.properties["grid_start_s"]) + np.arange(len(run))[ok] * run.dt
    return np.asarray((found.inv() * attitude(t)).magnitude())


@pytest.mark.parametrize("hz", [7.3, 23.0, 100.0])
def test_a_tumbling_attitude_is_right_at_every_point_of_the_grid(hz: float):
    raw = logged(hz)
    assert np.abs(np.diff(raw.channels["phi"].values)).max() > 2.0  # roll jumps where the pitch passes 90 degrees
    assert off(align(raw)).max() < LARGEST


def test_a_bad_angle_masks_the_attitude_and_nothing_is_joined_across_it():
    raw = logged(23.0)
    spoilt = raw.channels["psi"].values.copy()
    spoilt[100:103] = 90.0
    run = align(RawLog("t.csv", raw.sha256, "test", "", None, dict(raw.channels) | {"psi": Series(raw.channels["psi"].t, spoilt, "row")}))
    masked = [set(np.flatnonzero(run.reasons[name] == Reason.OUT_OF_RANGE)) for name in EULER]
    assert masked[0] and masked[0] == masked[1] == masked[2]
    assert off(run).max() < LARGEST


def test_an_attitude_that_stays_level_comes_as_its_angles():
    t = np.arange(400) / 23.0
    roll = 0.3 * np.sin(t)
    raw = RawLog("t.csv", "ab" * 32, "test", "", None, {n: Series(t, x, "row") for n, x in zip(EULER, (roll, 0.5 * roll, np.cos(t)), strict=True)})
    assert {align(raw).resampled[name].method for name in EULER} == {"circular mean"}
