"""A thruster from its bench: what was put into a table or record comes out, and a published bench gives what its sheet allows."""

from __future__ import annotations

import json

import numpy as np
import pytest
from command_case import run
from real_data import real

from rovval.core.errors import BadInput, UsageProblem
from rovval.fit import bench
from rovval.fit.bench.step_response import steps


def test_the_motor_s_law_that_made_a_table_is_found_in_it(tmp_path):
    """V = 0.05 T + 0.6 sqrt(T), odd; words in the first line, the columns swapped."""
    thrust = np.array([-40.0, -20.0, -10.0, -2.0, 2.0, 10.0, 20.0, 40.0])
    volts = np.sign(thrust) * (0.05 * np.abs(thrust) + 0.6 * np.sqrt(np.abs(thrust)))
    (tmp_path / "b.csv").write_text("thrust;volts\n" + "\n".join(f"{t};{v}" for t, v in zip(thrust, volts, strict=True)))
    done = json.loads(run("fit", str(tmp_path / "b.csv"), "--motor", "--columns", "2,1", "--json", "--out", str(tmp_path / "m.json")).stdout)
    assert (done["fits"]["both ways"]["resistive"], done["fits"]["ahead"]["back_emf"]) == pytest.approx((0.05, 0.6))
    assert json.loads((tmp_path / "m.json").read_text()) == done


def test_the_time_constant_that_made_a_record_is_found_in_it():
    t = np.arange(0.0, 20.0, 0.01)
    rise, fall = (-np.expm1(-np.maximum(t - at, 0.0) / 0.35) for at in (4.0, 12.0))
    y = 100.0 * (rise - fall) + np.random.default_rng(0).normal(size=len(t))
    up, down = steps(t, y)
    assert (up.tau, down.tau) == pytest.approx((0.35, 0.35), abs=0.02)
    assert (up.at, down.at) == pytest.approx((4.0, 12.0), abs=0.03) and up.after == pytest.approx(100.0, abs=0.5)


def test_a_record_that_vibrates_is_no_record_of_steps():
    """A load cell's column gave four hundred "steps" of milliseconds each."""
    t = np.arange(0.0, 4.0, 0.001)
    with pytest.raises(BadInput, match=r"swings between .* every 1\d\.?5? samples"):
        steps(t, np.sin(2 * np.pi * 40.0 * t))


def test_a_record_without_a_step_and_a_table_without_numbers_are_refused(tmp_path):
    with pytest.raises(BadInput, match="no step"):
        steps(np.arange(10.0), np.zeros(10))
    (tmp_path / "b.csv").write_text("volts,thrust\n1,2\n3,x\n4\n")
    with pytest.raises(BadInput, match=r"(?s)line 3.*line 4 has 1 columns"):
        bench.table(tmp_path / "b.csv", (1, 2))
    with pytest.raises(UsageProblem, match="--columns"):
        run("fit", str(tmp_path / "b.csv"), "--motor", "--columns", "0,2")
    with pytest.raises(UsageProblem, match="--out"):
        run("fit", str(tmp_path / "b.csv"))


def test_a_published_bench():
    """Ten points up to 13 N show the root alone, with a third of a volt of what the equation leaves out (friction: no thrust below 1 V)."""
    _, document = bench.motor(real("thruster_bench") / "Steady_State_Data.csv", (1, 2))
    law = document["fits"]["both ways"]
    assert law["resistive"] == 0.0 and law["back_emf"] == pytest.approx(0.96, abs=0.01) and 0.3 < law["rms"] < 0.45
