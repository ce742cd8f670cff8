"""The text of a test scenario: every expectation with its verdict, then what was compared or which channels the log holds."""

from report_cases import make_run, make_sim

from rovval.comparison import compare
from rovval.fly.scenarios import Check, Outcome
from rovval.report.scenario.document import markdown
from rovval.report.scenario.terminal import text
from rovval.vehicle import load


def outcome(**more: object) -> Outcome:
    checks = (Check("level", "0.1 deg", True), Check("still", "2 m/s", False), Check("depth", "1 m", None))
    return Outcome(1, "stability", "merlin", "fossen", checks, **more)  # type: ignore[arg-type]


def test_every_expectation_is_told_with_its_verdict() -> None:
    said = text(outcome()).splitlines()
    assert said == ["Scenario 1: stability (merlin, fossen)", "  pass  level: 0.1 deg", "  FAIL  still: 2 m/s", "  -     depth: 1 m", "NOT passed"]


def test_what_was_compared_and_the_channels_of_the_log_follow() -> None:
    run = make_run(300)
    assert "in windows" in text(outcome(comparison=compare(run, make_sim(run))))
    row = {"channel": "u", "unit": "m/s", "low": -1.0, "high": 1.5, "coverage": 0.5, "n": 3}
    said = text(outcome(document={"channels": [row, row | {"channel": "v", "n": 0}]}))
    assert "50.0%" in said and "  v " not in said


def test_the_document_says_which_platform_stands_for_the_thesis_s() -> None:
    """One that was asked for stands for both of them; it was once told as if there were two."""
    one, merlin = outcome(motion=make_sim(make_run(300))), load("merlin")
    assert "Platforms: fossen alone, for both" in markdown({(1, "fossen"): one}, merlin)
    assert "uuv for its ROS simulator" in markdown({(1, "fossen"): one, (1, "uuv"): one}, merlin)
