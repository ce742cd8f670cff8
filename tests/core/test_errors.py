"""A refusal says what is wrong and what to do next, in one exit code, also across processes."""

import pickle

import pytest

from rovval.core.errors import BadInput, BadVehicle, RovvalError, SimulationStopped, Unwritable, UsageProblem, all_at_once


@pytest.mark.parametrize(
    ("kind", "code"), [(RovvalError, 70), (UsageProblem, 2), (Unwritable, 2), (BadVehicle, 2), (BadInput, 3), (SimulationStopped, 4)]
)
def test_a_refusal_comes_whole_out_of_another_process(kind, code):
    error = pickle.loads(pickle.dumps(kind("log.csv: no rows", "look at the file")))
    assert type(error) is kind and error.exit_code == code
    assert str(error) == "log.csv: no rows\n  next: look at the file"


def test_all_problems_of_a_kind_are_one_message():
    assert all_at_once(["no depth"], "dive.csv") == "dive.csv: no depth"
    assert all_at_once(["no depth", "no heading"], "dive.csv").splitlines() == ["dive.csv: 2 problems", "  - no depth", "  - no heading"]
