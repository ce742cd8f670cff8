"""The page of a calibration: every unknown once, intervals beside the prior, what is seen together, predicted runs, and what to fly for the rest."""

import json
from dataclasses import replace
from html import unescape
from math import exp, log

import numpy as np
import pytest
from page_case import check_html

from rovval import vehicle
from rovval.core.data import Array
from rovval.fit import FitResult
from rovval.fit.calibration import AxisError, Calibration, Row
from rovval.fit.calibration.unknowns import unknowns
from rovval.report import write_fit
from rovval.report.calibration import answer, foremost, heat_map, html, rest, whisker
from rovval.report.drawings.drawing import Box, Dot, Text
from rovval.report.fit import text
from rovval.report.notebook import page_of
from rovval.simulation.fitted_commands import Excess, largest

HEAVY = vehicle.load("bluerov2_heavy")
ASKED = tuple(one for one in unknowns(HEAVY, ("u", "v", "w", "phi", "theta", "z")) if not one.optional)
KEYS = [one.key for one in ASKED]
TOGETHER = ("thrust.gain", "added_mass[surge]")


def matrix(value: float = 0.81) -> Array:
    """Correlations of which one pair is close."""
    found = np.eye(len(KEYS))
    i, j = (KEYS.index(key) for key in TOGETHER)
    found[i, j] = found[j, i] = value
    return found


def made(left_out: float | None = 0.05, value: float = 0.81) -> Calibration:
    """A calibration as it might come out: every third unknown is held by its prior, one pair goes together."""
    rows = []
    for i, one in enumerate(ASKED):
        shown, at = i % 3 != 2, 0.4 * one.sd * (-1) ** i
        error = one.sd * (0.2 if shown else 0.95)
        middle, low, high = (exp(x) if one.kind == "factor" else x for x in (at, at - 1.645 * error, at + 1.645 * error))
        rows.append(Row(one, middle, low, high, error, at / one.sd, shown))
    errors = [AxisError(run, axis, "m/s", 0.1, 0.04, left_out, 600) for run in ("run_a", "run_b") for axis in ("surge", "sway")]
    commands = largest([np.array([[20.0] * 8, [-10.0] * 8])], HEAVY)
    calibrated = HEAVY.model_copy(update={"calibration": commands})
    pairs = ((*TOGETHER, value),) if abs(value) >= 0.7 else ()
    whole = tuple(tuple(float(x) for x in row) for row in matrix(value))
    further = (("run_b", Excess("T3", "astern", 1500.0, 600.0, 12, 600, False)),)
    return Calibration(calibrated, tuple(rows), whole, pairs, tuple(errors), {"tether.drag": (1.2, -0.4)}, (), True, ("run c: too short",), further)


def test_every_unknown_stands_on_the_page_once_with_its_error_or_what_would_show_it():
    found = made()
    page = unescape(html(found.document()))
    shown, held = (page.split("<h2>")[k] for k in (1, 2))
    for row in found.rows:
        here, other = (shown, held) if row.shown else (held, shown)
        assert here.count(f'<th scope="row"><code>{row.unknown.key}</code>') == 1
        assert f'<th scope="row"><code>{row.unknown.key}</code>' not in other
        assert row.shown or row.unknown.manoeuvre in held


def test_a_pair_that_is_seen_together_has_what_shows_each_by_itself():
    page = unescape(html(made().document()))
    apart = page.partition("What would separate them")[2].partition("</section>")[0]
    for one in ASKED:
        assert (one.manoeuvre in apart) == (one.key in TOGETHER) or one.manoeuvre in [x.manoeuvre for x in ASKED if x.key in TOGETHER]
    assert "0.81" in apart
    assert "What would separate them" not in html(made(value=0.4).document())


def test_every_kind_of_unknown_brings_what_would_show_it():
    for one in unknowns(HEAVY, ("u", "v", "w", "phi", "theta", "z")):
        assert len(one.manoeuvre.split()) > 5, one.key
        assert not {"{", "}"} & set(one.manoeuvre), one.key


@pytest.mark.parametrize("kind", ["factor", "offset"])
def test_a_whisker_lies_on_the_scale_of_its_prior(kind: str):
    row = next(row for row in made().document()["unknowns"].values() if row["kind"] == kind and row["shown"])
    band, span = (shape for shape in whisker(row).shapes if isinstance(shape, Box))
    [dot] = (shape for shape in whisker(row).shapes if isinstance(shape, Dot))
    deviation = band.width / 2
    assert dot.x - (band.x + deviation) == pytest.approx(row["moved"] * deviation)
    assert span.width == pytest.approx(2 * 1.645 * 0.2 * deviation)
    far = whisker(row | {"moved": 40.0})
    assert max(shape.x for shape in far.shapes if isinstance(shape, Dot)) < far.width, "nothing lies outside its drawing"


def test_the_picture_of_correlations_has_the_closest_pairs_and_a_cell_for_each():
    values = matrix()
    first = foremost(KEYS, values.tolist())
    assert [KEYS[i] for i in first] == sorted(TOGETHER, key=KEYS.index)
    assert foremost(KEYS, np.eye(len(KEYS)).tolist()) == []
    drawn = heat_map(["a", "b", "c"], [[1.0, -0.8, 0.05], [-0.8, 1.0, 0.5], [0.05, 0.5, 1.0]])
    cells = [(shape.css.split()[0]) for shape in drawn.shapes if isinstance(shape, Box)]
    assert cells == ["minus", "plus"], "a correlation of nothing has no colour"
    assert {"-.8", ".5"} <= {shape.words for shape in drawn.shapes if isinstance(shape, Text)}


def test_the_head_says_what_a_run_is_predicted_with_or_that_nobody_knows():
    assert "predicted with 50 % of the error" in answer(made(0.05).document())
    assert "more than it on 4 of 4" in answer(made(0.2).document())
    assert "40 % of the error of the file as given" in answer(made(None).document())
    assert "give two or more" in answer(made(None).document())


def test_the_head_names_what_moved_most_from_the_file_as_it_was_given():
    """Not from the prior's mean: of a file that was calibrated before, that lies elsewhere."""
    document = made().document()
    document["unknowns"]["trim.buoyancy"] |= {"value": 9.0, "shown": True, "moved": 0.0}
    document["unknowns"]["thrust.gain"] |= {"moved": 3.0}
    assert rest(document)[0].startswith("Furthest from the file: trim.buoyancy (9.00 N)")


def test_what_must_be_known_before_the_vehicle_is_used_is_on_the_page():
    page = html(replace(made(), converged=False).document())
    assert "had not settled" in page
    assert "run c: too short" in page
    assert "<td>1200</td><td>600</td>" in page, "largest commands, ahead and astern"
    assert "run_b drives T3 astern to 1500 rpm, on 12 of 600 rows beyond the 600 rpm of the other logs" in page
    assert "<script src" not in page
    check_html(page)


def test_the_page_and_its_document_are_written_together_and_a_notebook_shows_the_same(tmp_path):
    document = made().document()
    files = write_fit(document, tmp_path / "calibrated")
    assert sorted(files) == ["fit.html", "fit.json"]
    assert json.loads(files["fit.json"].read_text()) == json.loads(json.dumps(document))
    assert files["fit.html"].read_text() == page_of(FitResult("", document)).html
    assert len(document["matrix"]) == len(document["unknowns"])
    assert document["unknowns"]["thrust.gain"]["prior"] == pytest.approx(log(3.0))


def test_a_prediction_that_left_sane_limits_has_no_number():
    found = replace(made(), options={"cross_drag": (float("inf"), 2.0)})
    document = json.loads(json.dumps(found.document(), allow_nan=False))
    assert document["options"] == [{"name": "cross_drag", "gain": [None, 2.0], "accepted": False}]
    for page in (html(document), text(document)):
        assert "one left sane limits, +2.0" in unescape(page)
