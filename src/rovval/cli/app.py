"""The commands, in the order in which `rovval --help` lists them."""

from __future__ import annotations

import os
from typing import Annotated

import typer

from rovval.cli import (
    archive,
    blind,
    compare,
    demo,
    diagnose,
    export,
    fit,
    fly,
    import_vehicle,
    ingest,
    inspect,
    listing,
    profile,
    report,
    run,
    scenario,
    simulate,
    trend,
    view,
)
from rovval.core.version import __version__

app = typer.Typer(
    rich_markup_mode=None,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 120},
    help="Replay ROV logs through a simulator, measure the sim-to-real gap, and find which unmodelled effect causes it.",
    epilog="Start with `rovval demo`. Exit codes: 0 done, 1 a stated tolerance is exceeded, 2 usage or configuration, "
    "3 unusable input, 4 the simulation left sane limits, 70 internal error, 130 interrupted.",
)


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"rovval {__version__}")
        raise typer.Exit


@app.callback()
def options(
    debug: Annotated[bool, typer.Option("--debug", help="Print tracebacks (or set ROVVAL_DEBUG=1).")] = False,
    version: Annotated[bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")] = False,
) -> None:
    """Options that stand before the command's name."""
    if debug:
        os.environ["ROVVAL_DEBUG"] = "1"


COMMANDS = (
    ("demo", demo.command, "The whole job on an embedded sample log."),
    ("inspect", inspect.command, "What is in a log, and which profiles would read it."),
    ("ingest", ingest.command, "Logs into the archive."),
    ("simulate", simulate.command, "Drive the simulator with a log's thruster speeds."),
    ("compare", compare.command, "Per-axis error of the simulator, and the report."),
    ("report", report.command, "Several runs or models side by side."),
    ("diagnose", diagnose.command, "Which unmodelled effect causes the gap."),
    ("fit", fit.command, "Tune chosen parameters of a vehicle to logs."),
    ("fly", fly.command, "A mission, with controllers in the loop, flown by the simulator."),
    ("import-vehicle", import_vehicle.command, "A vehicle of uuv_simulator as a vehicle file of ours."),
    ("scenario", scenario.command, "The thesis's five test scenarios."),
    ("export", export.command, "A run for ROS, Foxglove, PlotJuggler, evo, or as a table."),
    ("run", run.command, "A batch over many logs."),
    ("trend", trend.command, "How gaps and causes change over dives."),
    ("archive", archive.command, "Is what is kept whole and true; mend it."),
    ("view", view.command, "A run in the rerun viewer."),
    ("list", listing.list_command, "Names of vehicles, platforms, effects, profiles, metrics, runs."),
    ("show", listing.show_command, "One vehicle, platform, effect, profile, metric or run."),
)
for _name, _command, _help in COMMANDS:
    app.command(_name, short_help=_help)(_command)
app.add_typer(blind.app, name="blind", short_help="The withheld-effect check.")
app.add_typer(profile.app, name="profile", short_help="A profile for a new log: propose one, check one.")
