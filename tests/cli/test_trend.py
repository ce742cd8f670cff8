"""`rovval trend` on rows of a catalogue."""

import json

import numpy as np
from catalogue_case import NOW, row
from typer.testing import CliRunner

from rovval.cli.app import app
from rovval.storage import catalogue


def trend(archive, *args):
    done = CliRunner().invoke(app, ["trend", "--archive", str(archive), *args])
    assert done.exit_code == 0, done.output
    return done


def test_a_growing_gap_is_said_with_its_rate_and_date(tmp_path):
    rng = np.random.default_rng(1)
    gaps = 0.05 * np.exp(0.1 * rng.standard_normal(60) + np.log(1.02) * np.maximum(np.arange(60) - 20, 0))
    rows = [row(n, surge=float(gap), sway=None, causes=[]) for n, gap in enumerate(gaps)]
    catalogue.update(tmp_path, rows, NOW)
    said = " ".join(trend(tmp_path).stdout.split())
    assert "gap in surge" in said and "rises by" in said and "a week since" in said and "2026" in said
    document = json.loads(trend(tmp_path, "--vehicle", "merlin", "--json").stdout)
    by_name = {s["name"]: s for s in document["series"]}
    [change] = by_name["surge"]["changes"]
    rate = change["rate_per_week"]
    assert rate["low"] < 1.02**7 - 1 < rate["high"] and change["since_low"] < "2026-03-22" < change["since_high"]
    assert "sway" not in by_name and by_name["heave"]["changes"] == []
    assert "no such dive" in trend(tmp_path, "--since", "2030-01-01").stderr
