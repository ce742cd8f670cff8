"""A flight as JSON, in a terminal and as a page."""

from __future__ import annotations

import json

from page_case import check_html

from rovval import report, vehicle
from rovval.fly import fly
from rovval.fly.dry_run import dry_run
from rovval.fly.mission import parse
from rovval.report.flight import terminal

MISSION = parse(
    {
        "name": "short", "water": {"bottom_m": 40.0}, "sensors": {},
        "leg": [
            {"kind": "hold", "for_s": 4.0, "depth_m": 20.5, "heading_deg": 10.0},
            {"kind": "way_points", "for_s": 6.0, "speed_m_s": 0.3, "points": [[1.0, 0.5, 20.0]]},
        ],
    }
)  # fmt: skip


def test_a_flight_is_told_alike_for_machines_terminal_and_browser(tmp_path):
    flight = fly(MISSION, vehicle.load("merlin"), draws=3)
    files = report.write_flight(flight, tmp_path)
    document = json.loads(files["flight.json"].read_text())
    assert document["schema"] == "rovval.flight/1" and document["loop"] == "sensors" and document["draws"] == 3
    depth = next(h for h in document["held"] if h["quantity"] == "depth")
    assert depth["step"] == 20.5 - flight.eta[0, 2] and depth["draws"]["q05"] <= depth["draws"]["q95"]
    [point] = document["way_points"]
    page, text = files["flight.html"].read_text(), terminal.text(flight)
    check_html(page)
    for words in ("SYNTHETIC", "The way from above", "over the draws", "1, 0.5, 20"):
        assert words in page
    assert "way point (north, east, depth)" in text and "5 % to 95 % of draws" in text
    assert f"{point['distance_m']:.3f}"[:4] in text


def test_a_dry_run_prints_the_timeline():
    text = terminal.dry_run_text(dry_run(MISSION, vehicle.load("merlin")))
    assert "0.0 to      4.0 s  1 hold" in text and "1 point at 0.3 m/s" in text and "nothing would be exceeded" in text
