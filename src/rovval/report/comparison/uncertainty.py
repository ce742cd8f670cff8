"""How sure the errors of a comparison are: their intervals, and the verdict of ASME V&V 20 on each axis, as rows of tables and as JSON."""

from __future__ import annotations

from typing import Any

from rovval.comparison.block_bootstrap import CONFIDENCE, FEWEST_BLOCKS
from rovval.comparison.validation import COVERAGE_FACTOR, DOUBTFUL, HIDDEN, LEFT_OUT, SEEN, validation
from rovval.core.data import ChannelError, Comparison
from rovval.core.units import in_degrees
from rovval.report.common.numbers import interval, number, per_cent, quantity

ERRORS = ("mean_error", "mae", "rmse", "skill")
INTERVALS = (
    f"In brackets what other stretches of the same kind of motion would show, with a probability of {per_cent(CONFIDENCE)}: rows are drawn anew in blocks "
    f"of neighbours. It says nothing of motion that this log lacks; of fewer than {FEWEST_BLOCKS} windows there is none."
)
VALIDATION = (
    "E is the rms error in the windows, u_val what is unsure in the comparison itself: the sensor's noise, that noise in the state that a window starts "
    f"from, and the integration. The error of the model lies in E +- {COVERAGE_FACTOR:g} u_val. {SEEN.capitalize()}: E is above {COVERAGE_FACTOR:g} u_val. "
    f"{HIDDEN.capitalize()}: E is no larger than u_val, which makes as much by itself. {DOUBTFUL.capitalize()}: between. Left out, because nobody has stated "
    f"it, is {' and '.join(LEFT_OUT)}: an error that is seen may be theirs."
)


def interval_rows(c: Comparison) -> list[tuple[str, str, str, list[str]]]:
    """Of every axis that has intervals: its name and unit, the form of the simulation, and `ERRORS` with their intervals; none where no axis has any."""
    tables = (("free run", c.free), ("windows", c.windowed))
    known = ((axis, form, table[axis]) for axis in c.windowed for form, table in tables if axis in table)
    return [(axis, in_degrees(1.0, row.unit)[1], form, _estimates(row)) for axis, form, row in known if row.intervals]


def validation_rows(c: Comparison) -> list[tuple[str, list[str], str]]:
    """Of every axis whose noise is known: its name, E, u_D, u_num, u_input, u_val and the interval of the model's error, and the verdict."""
    rows = []
    for axis, found in validation(c).items():
        parts = (found.error, found.u_data, found.u_numerical, found.u_input, found.u_validation)
        rows.append((axis, [*(quantity(v, found.unit, 2) for v in parts), interval(*found.interval, found.unit, 2)], found.verdict))
    return rows


def document(c: Comparison) -> dict[str, Any]:
    """The verdict for JSON, in SI."""
    axes = {
        axis: {
            "unit": found.unit, "error": found.error, "u_data": found.u_data, "u_numerical": found.u_numerical, "u_input": found.u_input,
            "u_validation": found.u_validation, "low": found.interval[0], "high": found.interval[1], "verdict": found.verdict,
        }
        for axis, found in validation(c).items()
    }  # fmt: skip
    return {"standard": "ASME V&V 20-2009", "coverage_factor": COVERAGE_FACTOR, "axes": axes, "left_out": list(LEFT_OUT)}


def _estimates(row: ChannelError) -> list[str]:
    """0.0467 [0.043, 0.050] of each of `ERRORS`, angles in degrees."""
    found = []
    for name in ERRORS:
        factor = 1.0 if name == "skill" else in_degrees(1.0, row.unit)[0]
        value, low, high = (None if v is None else v * factor for v in (getattr(row, name), *row.intervals.get(name, (None, None))))
        found.append(f"{number(value)} {interval(low, high, digits=2)}")
    return found
