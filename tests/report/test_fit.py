"""The text of a fit: parameters with intervals, and whether the gap shrinks or grows."""

from typing import Any

from rovval.report.fit import changes, text


def document(**more: Any) -> dict[str, Any]:
    row = {"was": 0.0, "value": 0.31, "low": 0.26, "high": 0.36, "unit": "N s2/m2", "at_bound": False, "differs": True}
    shrunk = {"total": 0.34, "low": 0.1, "high": 0.5}
    head = {"run": "dive", "vehicle": "merlin", "model": "fossen", "windows": 12, "window_s": 10.0}
    return head | {"parameters": {"quadratic_drag[surge].scale": row}, "shrinkage": shrunk, "undetermined": [], "harm": [], "left_out": []} | more


def test_a_gap_that_grows_is_said_to_grow() -> None:
    assert changes({"total": -0.34, "low": -0.5, "high": -0.1}) == "grows by 34 % [10, 50]"
    assert changes({"total": 0.34, "low": 0.1, "high": 0.5}) == "shrinks by 34 % [10, 50]"


def test_a_parameter_has_a_line_with_its_interval() -> None:
    said = text(document())
    assert "The squared gap shrinks by 34 % [10, 50] on held-out windows with 1 parameter tuned." in " ".join(said.split())
    line = next(row for row in said.splitlines() if row.startswith("quadratic_drag[surge].scale"))
    assert line.split() == ["quadratic_drag[surge].scale", "0", "0.310", "[0.260,", "0.360]", "N", "s2/m2"]


def test_what_a_reader_must_know_before_using_the_vehicle_is_said() -> None:
    assert "Not shown to be better" in text(document(shrinkage={"total": 0.1, "low": -0.1, "high": 0.2}))
    assert "Nothing was tuned. Next:" in text(document(parameters={}))
    why = "not excited"
    assert f"  waves.height: {why}" in text(document(undetermined=[{"parameter": "waves.height", "why": why}]))
    assert "sway by 41 %" in text(document(harm=[{"axis": "sway", "change": 0.41}]))
