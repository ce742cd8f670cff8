"""`rovval list` and `rovval show`: every file of a plug-in folder is there, under the names that completion and reports give it."""

from collections.abc import Callable

import pytest
from typer.testing import CliRunner

from rovval import effects, vehicle
from rovval.cli import complete
from rovval.cli.app import app
from rovval.comparison import metrics
from rovval.ingest.profile import profiles
from rovval.plant import platforms

RUNNER = CliRunner()
KINDS: dict[str, Callable[[], tuple[str, ...]]] = {
    "platform": platforms.names,
    "effect": effects.names, "metric": metrics.names, "profile": profiles, "vehicle": vehicle.names,
}  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_listing_and_completion_know_the_same_names(kind):
    """Completion looks at file names alone; it must not drift from what the library loads."""
    assert tuple(complete.known(kind)) == KINDS[kind]()
    assert RUNNER.invoke(app, ["list", kind]).output.split() == list(KINDS[kind]())


@pytest.mark.parametrize(("kind", "name"), [(kind, name) for kind, names in KINDS.items() for name in names()])
def test_each_can_be_shown_as_text_and_as_json(kind, name):
    for flag in ([], ["--json"]):
        shown = RUNNER.invoke(app, ["show", kind, name, *flag])
        assert shown.exit_code == 0, shown.exception
        assert name in shown.output


def test_an_effect_shows_how_to_ask_for_each_of_its_hypotheses():
    shown = RUNNER.invoke(app, ["show", "effect", "time_offset"]).output
    assert "  [velocity] delay [s]" in shown
    assert "'time_offset:tau=VALUE', --effect 'time_offset[velocity]:delay=VALUE', --effect 'time_offset[attitude]:delay=VALUE'" in shown


def test_an_effect_is_shown_under_the_name_that_reports_give_it():
    shown = RUNNER.invoke(app, ["show", "effect", "quadratic_drag[surge]"])
    assert shown.exit_code == 0
    assert shown.stdout == RUNNER.invoke(app, ["show", "effect", "quadratic_drag"]).stdout
