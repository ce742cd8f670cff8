"""Vehicles of uuv_simulator's YAML files."""

from __future__ import annotations

import numpy as np
import pytest

from rovval.core.errors import UsageProblem
from rovval.vehicle import uuv_yaml
from rovval.vehicle.model import allocation, inertia

YAML = """
pid:
  mass: 1862.87
  inertial: {ixx: 525.39, ixy: 1.44, ixz: 33.41, iyy: 794.2, iyz: 2.6, izz: 691.23}
  volume: 1.838
  cog: [0.0, 0.0, 0.0]
  cob: [0.0, 0.1, 0.3]
  Ma: [779.79, 1222.0, 3659.9, 534.9, 842.69, 224.32]
  linear_damping: [-74.82, -69.48, -728.4, -268.8, -309.77, -105]
  quad_damping: [-748.22, -992.53, -1821.01, -672, -774.44, -523.27]
tam: [[1, 0.7], [0, 0.7], [0, 0], [0, 0], [0, 0], [0.1, -0.3]]
conversion_fcn_params: {gain: 0.00031}
"""


def test_a_uuv_simulator_vehicle_is_read(tmp_path):
    """Forward-left-up and negative damping become ours; inertia keeps its meaning."""
    path = tmp_path / "rexrov.yaml"
    path.write_text(YAML, encoding="utf-8")
    v = uuv_yaml.read([path], "rexrov")
    assert v.body.centre_of_buoyancy == (0.0, -0.1, -0.3)
    assert v.body.linear_drag[0] == 74.82 and v.thruster[0].k_pos == pytest.approx(0.00031 * (2 * np.pi / 60) ** 2)
    flip = np.array([1, -1, -1, 1, -1, -1])
    tam = np.array([[1, 0.7], [0, 0.7], [0, 0], [0, 0], [0, 0], [0.1, -0.3]])
    lengths = np.linalg.norm(tam[:3], axis=0)
    assert allocation(v) * lengths == pytest.approx(flip[:, None] * tam)
    theirs = np.array([[525.39, 1.44, 33.41], [1.44, 794.2, 2.6], [33.41, 2.6, 691.23]])
    assert inertia(v.body) == pytest.approx(flip[:3, None] * theirs * flip[:3])
    path.write_text(YAML.replace("tam:", "tan:"), encoding="utf-8")
    with pytest.raises(UsageProblem, match="tam is in none of the files"):
        uuv_yaml.read([path], "rexrov")
