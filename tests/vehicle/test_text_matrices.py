"""The thesis's folder of text matrices: Minerva's becomes the vehicle of the library, and what is missing is named at once."""

from __future__ import annotations

import shutil

import numpy as np
import pytest
from real_data import real

from rovval.core.errors import BadVehicle
from rovval.vehicle import load, text_matrices
from rovval.vehicle.model import allocation, as_matrix, rigid_body_mass

SIX = "\n".join(" ".join("0" if i != j else str(v) for j in range(6)) for i, v in enumerate((500, 500, 500, 50, 60, 70)))


@pytest.fixture
def folder(tmp_path):
    """A vehicle with two thrusters, one of which pushes sideways before the centre; drag printed negative, inertia by its upper half."""
    upper = [[0.0] * 6 for _ in range(6)]
    for i, v in enumerate((500, 500, 500, 50, 60, 70)):
        upper[i][i] = v
    upper[3][4] = -5.0
    text = {
        "M_RB": "\n".join(" ".join(map(str, row)) for row in upper), "M_A": SIX, "D_L": SIX.replace("5", "-5").replace("6", "-6").replace("7", "-7"),
        "D_q": SIX, "T": "1 0\n0 1\n0 0\n0 0\n0 0\n0 0.5", "COG": "0 0 0", "COB": "0 0 0.1", "V": "0.488", "D": "0.2\n0.2",
        "K_T": "0.5 -0.66 -0.25 0.24\n0.025 -0.28 0.17 0.15", "theta": "1.0 0.8\n0.9 0.5",
    }  # fmt: skip
    for name, body in text.items():
        (tmp_path / f"{name}.txt").write_text(body + "\n")
    return tmp_path


def test_axes_signs_and_thrust_law_are_turned_once(folder):
    v = text_matrices.read(folder, "two")
    assert allocation(v)[:, 1] == pytest.approx([0, -1, 0, 0, 0, -0.5])
    assert v.body.Ixy == pytest.approx(-5.0) and np.allclose(rigid_body_mass(v.body), rigid_body_mass(v.body).T)
    assert np.diag(as_matrix(v.body.linear_drag)).min() > 0
    assert v.body.centre_of_buoyancy == pytest.approx((0, 0, -0.1))
    assert v.thruster[1].k_neg == pytest.approx(1025 * 0.2**4 * 0.5 * 0.15 / 3600)
    assert v.thruster[0].advance_pos == pytest.approx((-0.25 / 0.24, -0.66 / 0.24, 0.5 / 0.24))


def test_every_problem_is_named_at_once(folder):
    (folder / "theta.txt").unlink()
    (folder / "V.txt").write_text("half\n")
    with pytest.raises(BadVehicle, match=r"(?s)V\.txt.*theta\.txt"):
        text_matrices.read(folder, "two")
    shutil.copy(folder / "D.txt", folder / "theta.txt")
    (folder / "V.txt").write_text("0.5 0.5\n")
    with pytest.raises(BadVehicle, match=r"(?s)theta\.txt is 2 x 1.*V\.txt has 2 numbers"):
        text_matrices.read(folder, "two")


def test_minerva_as_published_is_minerva_of_the_library():
    """But for its trim, which the library mends, and where thrusters stand along their own axes."""
    ours, library = text_matrices.read(real("minerva"), "minerva"), load("minerva")
    assert rigid_body_mass(ours.body) == pytest.approx(rigid_body_mass(library.body))
    for key in ("added_mass", "linear_drag", "quadratic_drag"):
        assert as_matrix(getattr(ours.body, key)) == pytest.approx(as_matrix(getattr(library.body, key)))
    assert ours.body.centre_of_buoyancy == pytest.approx(library.body.centre_of_buoyancy)
    assert allocation(ours) == pytest.approx(allocation(library), abs=2e-3)
    for a, b in zip(ours.thruster, library.thruster, strict=True):
        assert (a.k_pos, a.k_neg) == pytest.approx((b.k_pos, b.k_neg), rel=1e-3)
        assert a.advance_pos + a.advance_neg == pytest.approx(b.advance_pos + b.advance_neg, rel=1e-6)
