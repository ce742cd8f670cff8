"""A velocity log that reads too much or too little: by its beams, that is by what four of them measure along themselves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnose_case import foreign, merlin, with_values

from rovval.diagnose import diagnose
from rovval.effects.library.dvl_scale import AXES, observe, unobserve
from rovval.effects.log import Log


def beams(lean: float) -> np.ndarray:
    """(4, 3) directions of beams that lean ahead, astern, to starboard and to port (rad from straight down)."""
    s, c = np.sin(lean), np.cos(lean)
    return np.array([[s, 0.0, c], [-s, 0.0, c], [0.0, s, c], [0.0, -s, c]])


def test_beams_that_lean_by_another_angle_are_those_of_the_geometry_and_back():
    true, lean, more = np.array([0.7, -0.3, 0.2]), np.radians(30.0), 0.05
    wrong = np.linalg.lstsq(beams(lean), beams(lean + more) @ true, rcond=None)[0]  # as four beams that lean by 30 degrees are solved for it
    nu, eta = np.tile([*true, 0.0, 0.0, 0.0], (1, 2, 1)), np.zeros((1, 2, 6))
    p = {name: np.zeros(1) for name in ("scale", *AXES)} | {"angle": np.array([more])}
    log = observe(Log(nu, eta, 0.1, nu[:, 0], eta[:, 0]), p)
    assert log.nu[0, 0, :3] == pytest.approx(wrong, abs=1e-12)
    assert wrong[0] > true[0] and wrong[2] < true[2]
    assert unobserve(log.nu[:, 0], eta[:, 0], p)[0] == pytest.approx(nu[:, 0])


@pytest.mark.slow
@pytest.mark.parametrize("more", [0.05, -0.05])
def test_beams_that_lean_by_another_angle_are_named_and_no_depth_sensor_with_them(tmp_path: Path, more: float):
    """By another plant: horizontal velocity one way, vertical the other and less; as one scale of all three it took an error of the depth beside it."""
    run, lean = foreign(tmp_path, (), 31, 300.0, 0.03, mission="yoyo"), np.radians(30.0)
    level, upright = np.sin(lean + more) / np.sin(lean), np.cos(lean + more) / np.cos(lean)
    [cause] = diagnose([with_values(run, u=level * run.get("u"), v=level * run.get("v"), w=upright * run.get("w"))], merlin()).causes
    assert cause.effect == "dvl_scale" and cause.parameters["angle"].value == pytest.approx(more, abs=0.015)
