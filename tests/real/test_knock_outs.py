"""Tank runs of a BlueROV2 with a piece knocked out of the calibrated vehicle, or the log damaged: it is named first, and nothing else with certainty.

The bounds are the targets of the project; what the engine reaches stands in the README with its date.
"""

from __future__ import annotations

import pytest
from knock_outs import RUNS, knocked_out
from real_answers import WRONG, confidence, named_first, overconfident, table

pytestmark = pytest.mark.real
NAMED_FIRST = 2 / 3  # of the pieces that close a tenth of the squared gap when they are put back


@pytest.mark.parametrize("run", RUNS)
def test_pieces_are_named_on_each_run(run: str):
    answers = knocked_out(run)
    (right, asked), (wrong, sure) = named_first(answers), overconfident(answers)
    print(f"\n{table(answers)}\nnamed first: {right} of {asked}; wrong of the names at 0.9 or above: {wrong} of {sure}")
    assert asked  # a run on which no piece shows asks nothing
    assert right >= asked / 3


def test_pieces_are_named_first_and_no_other_with_certainty():
    answers = tuple(one for run in RUNS for one in knocked_out(run))
    (right, asked), (wrong, sure) = named_first(answers), overconfident(answers)
    print(f"\n{table(answers)}\n\n{confidence(answers)}\nnamed first: {right} of {asked}; wrong of the names at 0.9 or above: {wrong} of {sure}")
    assert right >= NAMED_FIRST * asked
    assert wrong <= WRONG * sure
