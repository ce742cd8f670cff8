"""docs/thesis.md: a reader finds it, and what it says is taken is what stands in the file or comes out of the equations."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rovval import vehicle
from rovval.core.frames import rotation_from_euler
from rovval.vehicle.model import rigid_body_mass

TEXT = (Path(__file__).parents[2] / "docs" / "thesis.md").read_text(encoding="utf-8")
MERLIN = vehicle.load("merlin")


def test_the_vehicle_and_the_readme_lead_to_it():
    assert any("docs/thesis.md" in note for note in MERLIN.notes)
    assert "docs/thesis.md" in (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")


def test_the_numbers_that_it_says_are_taken_are_those_of_the_file():
    body = MERLIN.body
    for said, number in (("I_xy = 28.489418", body.Ixy), ("I_xz = 82.409928", body.Ixz), ("I_yz = -7.821611", body.Iyz), ("2.86341 m3", body.volume)):
        assert said in TEXT and f"{number:g}"[:6] in said
    assert "2936 kg" in TEXT and body.mass == 2936.0
    assert np.allclose(rigid_body_mass(body), rigid_body_mass(body).T)


def test_the_printed_rotation_is_none_and_the_one_that_is_taken_is():
    """Equation 3.7 with its misprint, at an attitude where it shows."""
    phi, theta, psi = 0.3, 0.4, 0.5
    ours = rotation_from_euler(np.array([phi, theta, psi]))
    printed = ours.copy()
    printed[2, 1] = np.cos(theta) * np.cos(psi)
    assert ours @ ours.T == pytest.approx(np.eye(3)) and ours[2, 1] == pytest.approx(np.cos(theta) * np.sin(phi))
    assert np.abs(printed @ printed.T - np.eye(3)).max() > 0.1


def test_the_speed_against_the_diameter_is_what_it_says():
    n, diameter = 70.0 / 60.0, 0.3
    assert 82.7 / (1025.0 * diameter**4 * n**2) == pytest.approx(7.3, abs=0.05)
