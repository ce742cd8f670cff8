"""One platform as the vehicle, another as its simulator: what the other leaves out is known by construction."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rovval import vehicle
from rovval.diagnose import diagnose
from rovval.fly import fly
from rovval.fly.mission import load

MERLIN = vehicle.load("merlin")


def steps(path: Path) -> Path:
    """A table of speeds: every thruster at one of its own for 5 to 12 s, up to 150 rpm, all of them still in a quarter of the steps (coast-downs)."""
    rng, rows, t = np.random.default_rng(5), [[0.0] * 8], 0.0
    while t < 420.0:
        lasts, speed = rng.uniform(5.0, 12.0), rng.uniform(-150.0, 150.0, 7) * (rng.random() > 0.25)
        rows += [[t + 0.5, *speed], [t + lasts, *speed]]
        t += lasts
    lines = [",".join(("t_s", *MERLIN.thrusters)), *(",".join(f"{x:.2f}" for x in row) for row in rows)]
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.mark.slow
def test_what_freefloating_leaves_out_is_named(tmp_path):
    """It has no added mass and no linear drag. Merlin's are 0.5 m and 0.1 I, and what its quadratic drag is at 0.1 m/s (thesis 3.12, 3.13): a scale of 1 in
    translation."""
    run = fly(load(steps(tmp_path / "steps.csv")), MERLIN, "fossen").run()
    found = diagnose([run], MERLIN, model="freefloating")
    assert found.verdict in ("explained", "partly_explained")
    causes = {cause.effect: cause for cause in found.causes}
    assert {name.partition("[")[0] for name in causes} == {"added_mass", "linear_drag"}
    for name in ("added_mass[translation]", "linear_drag[translation]"):
        assert causes[name].parameters["scale"].value == pytest.approx(1.0, abs=0.25)
    assert found.shrinkage.total > 0.5
