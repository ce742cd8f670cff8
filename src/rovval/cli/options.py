"""Arguments and options that several commands share, each stated once."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from rovval.cli import complete
from rovval.core.errors import UsageProblem
from rovval.storage.places import place


class Model(StrEnum):
    """The platforms, a file of `rovval.plant.platforms` each."""

    fossen = "fossen"
    uuv = "uuv"
    freefloating = "freefloating"


def refuse_overwriting(vehicle: str | None, out: Path | None) -> None:
    """Refuse to write a vehicle over the one that it is made from: its numbers before and its comments would be gone."""
    if vehicle and out and out.exists() and Path(vehicle).exists() and out.samefile(vehicle):
        raise UsageProblem(f"{out}: is the vehicle that was asked for with --vehicle", "write the new one to another file")


Source = Annotated[
    str,
    typer.Argument(
        metavar="LOG|RUN", help="A log file, a bag folder, or a run of the archive.", autocompletion=complete.sources
    ),
]
Sources = Annotated[
    list[str],
    typer.Argument(metavar="LOG|RUN...", help="Log files or runs of the archive.", autocompletion=complete.sources),
]
ProfileOption = Annotated[
    str | None,
    typer.Option(
        "--profile",
        metavar="P",
        autocompletion=complete.profiles,
        help="How to read the log: a name of `rovval list profile` or a TOML file. Default: the profile that fits the log.",
    ),
]
TimezoneOption = Annotated[
    str | None,
    typer.Option(
        "--timezone",
        metavar="ZONE",
        help="Of stamps that are date and time without a zone of their own: Europe/Berlin, +02:00. Default: the profile's, else UTC.",
    ),
]
VehicleOption = Annotated[
    str | None,
    typer.Option(
        "--vehicle",
        metavar="V",
        autocompletion=complete.vehicles,
        help="A name of `rovval list vehicle` or a TOML file. Default: the vehicle that the run names.",
    ),
]
FromOption = Annotated[
    str | None,
    typer.Option("--from", metavar="S|MARKER", help="Take the log from here, as if it began there: s since the run's start, or a marker's name."),
]
ToOption = Annotated[
    str | None, typer.Option("--to", metavar="S|MARKER", help="Take the log to here: s since the run's start, or a marker's name.")
]
ModelOption = Annotated[
    Model,
    typer.Option(
        "--model",
        help="Platform: fossen (equation 3.10 of the thesis, its Simulink model), uuv (uuv_simulator in Gazebo, its ROS simulator), "
        "freefloating (no added mass, no linear drag); `rovval show platform NAME` has sources and what each leaves out.",
    ),
]
ArchiveOption = Annotated[Path, typer.Option("--archive", metavar="DIR", parser=place, help="Where runs are kept: a folder, or s3://bucket/prefix.")]
EffectOption = Annotated[
    list[str] | None,
    typer.Option(
        "--effect",
        metavar="NAME[TARGET]:PARAM=VALUE",
        autocompletion=complete.effects,
        help="Add an effect to the simulator, for example inflow_loss:loss=0.3; repeatable.",
    ),
]
WindowOption = Annotated[float, typer.Option("--window", metavar="S", min=0.5, help="Length of the restarted windows, s.")]
JsonFlag = Annotated[bool, typer.Option("--json", help="Print only the machine-readable result on stdout.")]
PicturesOption = Annotated[bool, typer.Option("--pictures", help="Camera and sonar pictures of a bag into its recording, too.")]
QuietOption = Annotated[bool, typer.Option("--quiet", "-q", help="No messages or progress on stderr.")]
FailAbove = Annotated[
    list[str] | None,
    typer.Option(
        "--fail-above",
        metavar="AXIS[.METRIC]=VALUE",
        help="Exit 1 if the axis's rmse (or the metric named) is above VALUE in SI, or was not measured; repeatable.",
    ),
]
