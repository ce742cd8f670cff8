"""A mission file: where the vehicle starts, what it is told to do leg by leg, its limits, its sensors and the water. Checked whole before anything flies.

Units are those of the file: metres, degrees, seconds, rpm. ``docs/missions.md`` is written out of this file (`rovval.fly.document`).
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from rovval.core.did_you_mean import suggestion
from rovval.core.errors import UsageProblem, all_at_once

FOLDER = Path(__file__).parent / "missions"
Positive = Annotated[float, Field(gt=0)]
NotNegative = Annotated[float, Field(ge=0)]
Share = Annotated[float, Field(ge=0, le=1)]
Axis = Literal["surge", "sway", "heave", "roll", "pitch", "yaw"]
Point = tuple[float, float, float]


class Strict(BaseModel):
    """Immutable, and a misspelt key is an error rather than ignored."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Start(Strict):
    """Where the vehicle is at the beginning, at rest in the water."""

    north_m: float = 0.0
    east_m: float = 0.0
    depth_m: float = 20.0
    roll_deg: Annotated[float, Field(ge=-180, le=180)] = 0.0
    pitch_deg: Annotated[float, Field(gt=-90, lt=90)] = 0.0
    heading_deg: float = 0.0


class Water(Strict):
    """The surface and the bottom (effects `free_surface` and `seabed`). Currents, waves and the rest are effects of the library."""

    surface: bool = Field(default=True, description="buoyancy falls to nothing through the surface, at depth 0")
    bottom_m: float | None = Field(default=None, description="depth of a flat bottom that can be touched; without it there is none, and no altitude")
    effects: tuple[str, ...] = Field(default=(), description='settings as `--effect` takes them, such as "current_constant:north=0.3"')


class Limits(Strict):
    """What the thrusters can do. A demand beyond it is cut, and every sample in which it was is counted in the result."""

    rpm: Positive | None = Field(
        default=None, description="of every thruster; without it the vehicle file's `rpm_max`, else the speed of its pulse table's greatest thrust, else none"
    )
    rpm_per_s: Positive | None = Field(default=None, description="fastest change of a thruster's speed; without it none")


class Gains(Strict):
    """PID gains of one axis in place of those that follow from the vehicle: N, N s and N/s per metre, N m per radian, N s per m/s for a speed."""

    kp: NotNegative
    ki: NotNegative = 0.0
    kd: NotNegative = 0.0


class Control(Strict):
    """The controllers. Without gains they are placed from the vehicle's own mass and drag (`rovval.fly.loop.controllers`)."""

    bandwidth_rad_s: Positive = Field(default=0.5, description="where the closed loops' poles lie; 0.5 rad/s is a crossover at 0.15 of a sample at 10 Hz")
    feedforward: bool = Field(default=True, description="smooth set-points and the force that they take beforehand; false: plain PID on the set-point")
    level: bool = Field(default=True, description="roll and pitch are kept level wherever the autopilot holds something and the thrusters can")
    depth: Gains | None = None
    heading: Gains | None = None
    surge: Gains | None = None
    sway: Gains | None = None


class Sensor(Strict):
    """One instrument: white noise and a constant bias (standard deviations), every how many seconds it measures, how late that arrives, how much is lost."""

    noise: NotNegative
    bias: NotNegative = 0.0
    period_s: NotNegative = Field(default=0.0, description="0: every sample, 10 a second")
    delay_s: Annotated[float, Field(ge=0, le=5)] = 0.0
    dropout: Share = Field(default=0.0, description="share of the measurements that do not arrive")
    outages: tuple[tuple[float, float], ...] = Field(default=(), description="stretches in which none arrives, [from, to] in s since the start")


class Sensors(Strict):
    """What closes the loop in place of the true state, through an INS-like Kalman filter. Defaults: a survey-class suite (orders of magnitude of data
    sheets: fibre-optic or good MEMS gyros, 600 kHz DVL, USBL at short range)."""

    gyro: Sensor = Field(default=Sensor(noise=0.0005, bias=0.0002), description="rad/s")
    accelerometer: Sensor = Field(default=Sensor(noise=0.005, bias=0.005), description="m/s2")
    attitude: Sensor = Field(default=Sensor(noise=0.003, bias=0.002), description="rad; roll, pitch and heading of the AHRS")
    depth: Sensor = Field(default=Sensor(noise=0.01), description="m")
    velocity: Sensor = Field(default=Sensor(noise=0.01, period_s=0.2, delay_s=0.1, dropout=0.02), description="m/s; DVL over the bottom")
    position: Sensor = Field(default=Sensor(noise=0.3, period_s=2.0, delay_s=0.5, dropout=0.1), description="m; USBL")
    altitude: Sensor = Field(default=Sensor(noise=0.02, period_s=0.2, dropout=0.02), description="m; altimeter, unfiltered")


class Speeds(Strict):
    """Planned thruster speeds from a table, whatever the vehicle does; between rows they run linearly."""

    kind: Literal["speeds"]
    file: str = Field(
        description="CSV beside the mission file: `t_s` (s since the leg's start), then rpm of each thruster under its name; one without a column stands still"
    )


class Protocol(Strict):
    """The movement protocol of thesis 4.6: each axis both ways in open loop, a pause after each."""

    kind: Literal["protocol"]
    axes: tuple[Axis, ...] = ("surge", "sway", "heave", "yaw")
    move_s: Positive = 30.0
    rest_s: NotNegative = 30.0
    rpm: Positive | None = Field(default=None, description="of the fastest thruster; the thesis ran at 70")
    share: Share = Field(default=0.25, description="of the thrusters' greatest speed, where no rpm is given")
    hold: tuple[Literal["depth", "heading"], ...] = Field(
        default=(), description="what the autopilot holds meanwhile where each movement began, unless that is what moves"
    )

    @property
    def for_s(self) -> float:
        """How long it takes."""
        return 2 * len(self.axes) * (self.move_s + self.rest_s)


class Singly(Strict):
    """Each thruster alone, ahead and then astern, a pause after each: what shows each thruster's own thrust and direction, where movements turn fixed
    groups in which a turned thruster looks like lost thrust of its neighbours."""

    kind: Literal["singly"]
    push_s: Positive = 10.0
    rest_s: NotNegative = 10.0
    rpm: Positive | None = Field(default=None, description="without it as fast as all thrusters together hold `speed_m_s` ahead")
    speed_m_s: Positive = 0.5


class Hold(Strict):
    """Set-points for the autopilot: each one given is controlled, the rest is left alone."""

    kind: Literal["hold"]
    for_s: Positive
    depth_m: float | None = None
    altitude_m: Positive | None = Field(default=None, description="above the bottom, in place of a depth")
    heading_deg: float | None = None
    speed_m_s: float | None = Field(default=None, description="ahead, over ground")
    sway_m_s: float | None = Field(default=None, description="to starboard, over ground")

    @model_validator(mode="after")
    def _one_height(self) -> Hold:
        if self.depth_m is not None and self.altitude_m is not None:
            raise ValueError("give depth_m or altitude_m, not both")
        if all(getattr(self, name) is None for name in ("depth_m", "altitude_m", "heading_deg", "speed_m_s", "sway_m_s")):
            raise ValueError("holds nothing: give depth_m, altitude_m, heading_deg, speed_m_s or sway_m_s")
        return self


class WayPoints(Strict):
    """Along straight lines from where the leg begins through the points, by line-of-sight guidance; the last one is held."""

    kind: Literal["way_points"]
    points: Annotated[tuple[Point, ...], Field(min_length=1)] = Field(description="[north, east, depth] in m")
    speed_m_s: Positive
    for_s: Positive = Field(description="how long it may take; what is left is spent at the last point")
    radius_m: Positive | None = Field(default=None, description="how near counts as there; without it half of the vehicle's length")
    lookahead_m: Positive | None = Field(default=None, description="without it two vehicle lengths, or as far as the loops' bandwidth asks for at that speed")


Leg = Annotated[Speeds | Protocol | Singly | Hold | WayPoints, Field(discriminator="kind")]


class Mission(Strict):
    """The file. ``folder`` is where it lies: tables of speeds are looked for there."""

    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9._-]+$")]
    title: str = ""
    vehicle: str = Field(default="", description="used unless `--vehicle` says otherwise")
    start: Start = Start()
    water: Water = Water()
    limits: Limits = Limits()
    control: Control = Control()
    sensors: Sensors | None = Field(default=None, description="without this table the loop is closed on the true state")
    leg: Annotated[tuple[Leg, ...], Field(min_length=1)] = Field(description="what it is told to do, one after the other")
    folder: Path = Field(Path(), exclude=True)


def names() -> tuple[str, ...]:
    """Missions that come with rovval."""
    return tuple(sorted(p.stem for p in FOLDER.glob("*.toml")))


def load(name_or_path: str | Path) -> Mission:
    """A mission of the library by its name, of a TOML file, or of a CSV of thruster speeds alone. Raises UsageProblem, which names every problem at once."""
    path = FOLDER / f"{name_or_path}.toml" if str(name_or_path) in names() else Path(name_or_path)
    if not path.is_file():
        raise UsageProblem(
            f"{name_or_path}: no such mission file",
            f"{suggestion(str(name_or_path), names(), 'docs/missions.md')}, or write one as docs/missions.md says",
        )
    if path.suffix.lower() == ".csv":
        return parse({"name": re.sub(r"[^A-Za-z0-9._-]", "_", path.stem), "leg": [{"kind": "speeds", "file": path.name}]}, path)
    try:
        return parse(tomllib.loads(path.read_text(encoding="utf-8")), path)
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise UsageProblem(f"{path} is not TOML: {error}", "mend the line that is named") from None


def parse(document: Mapping[str, Any], path: Path = Path("mission")) -> Mission:
    """A mission from the tables of its file; ``path`` names it in messages, and tables of speeds lie beside it. Raises UsageProblem."""
    try:
        return Mission.model_validate({"name": path.stem, **document, "folder": path.resolve().parent})
    except ValidationError as error:
        raise UsageProblem(all_at_once([_problem(e) for e in error.errors()], str(path)), "docs/missions.md has every key with its unit") from None


def _problem(error: Any) -> str:
    got = "" if error["type"] in ("missing", "union_tag_not_found") else f" (is {error['input']!r:.60})"
    return f"{'.'.join(map(str, error['loc']))}: {error['msg']}{got}"
