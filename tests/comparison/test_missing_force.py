"""The force that a simulator misses, against one that was really left out of it."""

from dataclasses import replace

import numpy as np
import pytest
from report_cases import make_run

from rovval import vehicle
from rovval.comparison.missing_force import WINDOW_S, missing_force
from rovval.core.channels import VELOCITIES
from rovval.simulation import simulate

MERLIN = vehicle.load("merlin")


def test_a_steady_pull_that_the_simulator_lacks_is_found() -> None:
    """The simulator itself with 40 N more buoyancy is the vehicle: its missing force is 40 N upwards, and nothing else."""
    logged = make_run(100)
    run = replace(logged, values={name: v if name in ("x", "y", "z", "psi") else 0.0 * v for name, v in logged.values.items()})
    nominal, real = (simulate(run, MERLIN, effects=effects, window_s=WINDOW_S) for effects in ((), ("buoyancy_error:force=40",)))
    rows, force = missing_force(nominal, real.windowed.nu, MERLIN)
    assert len(rows) == 10 and (np.diff(run.t[rows]) == pytest.approx(WINDOW_S))
    assert force[:, 2].mean() == pytest.approx(-40.0, rel=0.1) and np.abs(force[:, [0, 1]].mean(axis=0)).max() < 4.0
    assert np.abs(missing_force(nominal, nominal.windowed.nu, MERLIN)[1]).max() == 0.0
    assert np.isfinite(missing_force(nominal, run.stack(VELOCITIES), MERLIN)[1]).all()
