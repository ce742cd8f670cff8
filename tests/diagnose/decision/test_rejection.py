"""Rejection: what speaks against causes that were found."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from rovval.diagnose.decision.rejection import of_one_kind
from rovval.diagnose.hypotheses.hypothesis import Hypothesis


@pytest.mark.parametrize(
    ("names", "many"),
    [
        (("linear_drag[surge]", "quadratic_drag[surge]", "linear_drag[sway]"), True), (("linear_drag[surge]", "linear_drag[sway]"), False),
        (("thruster_degraded[HFP]", "thruster_misaligned[HFS]", "thruster_reversed[HAP]"), True),
        (("linear_drag[surge]", "thruster_degraded[HFP]", "linear_drag[sway]"), False), (("waves", "current_constant", "dvl_scale"), False),
    ],
)  # fmt: skip
def test_three_causes_of_one_kind_are_a_crowd(names: tuple[str, ...], many: bool):
    named: Any = [SimpleNamespace(hypothesis=Hypothesis(name, name, (), (), ())) for name in names]
    assert of_one_kind(named) == many
