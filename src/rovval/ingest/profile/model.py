"""The profile language: every key of a profile, what it takes, what it means. docs/profiles.md is written out of this file."""

from __future__ import annotations

import hashlib
import re
import zoneinfo
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, PrivateAttr

from rovval.core.channels import Resampling
from rovval.core.errors import UsageProblem

ATTITUDE = "attitude"  # a quaternion that becomes phi, theta, psi
WORLD_VELOCITY = ("u", "v", "w")  # may be logged along world axes (`frame = "world"`) and are rotated into the body
GEODETIC = "degree_latitude"  # the unit of x and y when they are logged as latitude and longitude

# FRAME_CONFIG of ArduSub (ardupilot.org, Sub frame configurations) of the frames whose tables `rovval.vehicle` has.
ARDUSUB_FRAMES = {"vectored": 1, "vectored_6dof": 2}

BodyFrame = Literal["fsd", "flu"]
WorldFrame = Literal["ned", "enu", "nwu"]
Strings = tuple[str, ...]
OFFSET = re.compile(r"[+-]\d{2}:?\d{2}")


class Source(BaseModel):
    """Where a channel stands in the log and how it becomes SI: ``sign * (raw - zero) / span``, in ``unit``."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)

    unit: str
    """Unit of the logged value, of the table below; `quaternion` for `attitude`. Never guessed: a channel without unit is refused."""
    column: str | None = None
    """The column, as the header has it; case, blanks and a unit in brackets do not matter. `*` stands for the member of a family:
    `"n:*" = { column = "*_rpm" }` maps `HFP_rpm` to `n:HFP`."""
    columns: Strings = ()
    """Of `attitude`: the four columns of the quaternion in the order w, x, y, z."""
    topic: str | Annotated[Strings, Field(min_length=1)] | None = None
    """The topic of a bag, or the message type of an autopilot (`XKF1[1]`: its instance 1); `*` as in `column`. A list of names of one
    topic: the first that the bag has is read."""
    field: str | None = None
    """The field in the topic's messages: `twist.twist.linear.x`, `data[3]`; of `attitude` the quaternion itself."""
    sign: Literal[1, -1] = 1
    """-1 where the log counts the other way."""
    zero: float = 0.0
    """What the log holds at zero, in the logged unit: 1500 of a stick's pulse width."""
    span: float = 1.0
    """What the log's value changes by for one unit: 400 of a stick about 1500."""
    missing: tuple[float, ...] = ()
    """Values that say that there is none: `[0, 65535]`."""
    sign_from: Literal["n_cmd", "pwm"] | None = None
    """Of a speed `n:` that is logged without sign: the thruster's own command that has it; `pwm` about 1500 us."""
    optional: bool = False
    """Whether a log without it is still of this source."""
    frame: Literal["fsd", "flu", "world"] | None = None
    """Body axes of this channel (velocities, accelerations, theta, attitude) where they are not the profile's `frame`. `world`: u, v, w are
    along the world's axes and are turned into the body by the attitude."""
    world: WorldFrame | None = None
    """World axes of this channel (x, y, z, psi, attitude, and u, v, w along the world) where they are not the profile's `world`."""
    resampling: Resampling | None = None
    """How it comes to 10 Hz, where the channel's own way (below) is wrong: `mean` over the time about each grid point, or linear where it is slower than
    that, `circular` the same of an angle, `linear` between neighbours, `hold` the last value, `hold_mean` its mean until the next grid point."""
    longest_gap_s: float | None = Field(default=None, gt=0.0)
    """How far a gap is bridged, s, where the channel's own limit is wrong; a command that is held also acts so long after its last message."""
    stuck_s: float | None = Field(default=None, gt=0.0)
    """Equal values for longer than this, s, are a sensor that hangs, and are masked. Without it none are."""

    @property
    def topics(self) -> Strings:
        """The names of the topic, best first; () for a source that is no topic."""
        return () if self.topic is None else (self.topic,) if isinstance(self.topic, str) else self.topic


class Markers(BaseModel):
    """Where the log names moments itself: an operator's notes, modes, the beginning of a manoeuvre. `--from` and `--to` take such a name."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)

    column: str | None = None
    """The column of a table; where its cell begins to say something, or something else, stands a marker."""
    topic: str | None = None
    """The topic of a bag, or the message type of an autopilot (`MSG`, `STATUSTEXT`): each message is a marker."""
    field: str | None = None
    """The field of the topic that names it: `data`, `Message`, `text`."""


class Clock(BaseModel):
    """Where the stamps come from."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)

    kind: Literal["time_of_day", "epoch", "elapsed", "datetime", "header", "record"]
    """`elapsed`: since any start, in `unit`. `epoch`: since `since`, in `unit`. `datetime`: date and time as text. `time_of_day`: hour, minute,
    second and perhaps millisecond, in three or four columns of numbers or in one of text (`14:03:22.5`, `02:03:22 PM`), carried on over
    midnight. `header`, `record`: the clocks of a bag or autopilot: when the sensor says it measured, when the recorder wrote."""
    columns: Strings = ()
    """The columns of the stamp. `datetime`: one, or date and time, or year, month, day, hour, minute, second. A bag has none."""
    unit: str = "s"
    """Unit of an `elapsed` or `epoch` stamp: `s`, `ms`, `us`, `ns`, `min`, `h`, `day`."""
    since: Literal["unix", "excel", "labview", "matlab"] = "unix"
    """What an `epoch` counts from: 1970-01-01; 1899-12-30 (`unit = "day"`); 1904-01-01; year 0 (`datenum`, `unit = "day"`). UTC; the last three
    by the clock of `timezone` where it is given."""
    date_order: Literal["ymd", "dmy", "mdy"] | None = None
    """Of a `datetime`: the order of year, month and day. Without it only dates that say it themselves are read: a year of four digits first,
    dots (day first), a month's name. `03/04/2024` is refused until it is stated."""
    timezone: str | None = None
    """Of stamps that say no zone themselves: `Europe/Berlin`, `+02:00`; without it UTC, which the result says. `--timezone` overrides it. A zone
    or offset in the stamp (`Z`, `+02:00`) always holds."""


# Keys that came after the first archives: they count for the digest where they are set, so that the ids of runs stay as they were.
LATER = {"source": ("sign_from", "world"), "time": ("since", "date_order", "timezone"), "profile": ("ardusub_frame", "draft", "header", "markers", "water")}


class Profile(BaseModel):
    """One source of logs: which column or topic is which channel, in which unit and frame."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)

    name: str = Field(pattern=r"^[A-Za-z0-9_\-]+$")
    """Letters, digits, `_` and `-`."""
    description: str
    """A sentence: which logs these are."""
    notes: str = ""
    """How frames and signs were established; for people."""
    format: str
    """The reader: a name of the list below."""
    vehicle: str = ""
    """The vehicle of these logs: a name of `rovval list vehicle`, or a TOML file beside the profile."""
    frame: BodyFrame
    """Body axes. `fsd`: forward-starboard-down (positive: roll to starboard, nose up, turn to starboard). `flu`: forward-left-up of REP-103
    (positive: roll to starboard, nose down, turn to port)."""
    world: WorldFrame
    """World axes. `ned`: north-east-down (heading clockwise from north). `enu`: east-north-up (yaw counter-clockwise from east). `nwu`:
    north-west-up (counter-clockwise from north). Any body goes with any world; where they do not belong together (fsd with enu), heading and
    quaternion have to state their own."""
    draft: bool = False
    """The guesses of `rovval profile propose` that nobody has reviewed yet: every run says so. Delete it once each line is confirmed."""
    relative_heading: bool = False
    """The heading counts from the start while the position is in fixed axes; the constant between them is found from the log and reported.
    A diagnosis does not take it for a measurement."""
    water: Literal["still"] | None = None
    """`still`: a tank or a basin, where nothing but the vehicle moves the water: a diagnosis of these logs asks for no current and no waves."""
    time: Clock
    """Where the stamps come from: the keys of `[time]`."""
    channels: dict[str, Source] = Field(min_length=1)
    """Channel -> source: the keys of `[channels]`."""
    markers: Markers | None = None
    """Where the log names moments itself: the keys of `[markers]`."""
    header: Strings = ()
    """Of a table of text without a line of names: the names of all its columns, in order. Every line is a row then."""
    absent: Strings = ()
    """Columns or topics whose presence says that a log is *not* of this source."""
    ardusub_frame: Literal["vectored", "vectored_6dof"] | None = None
    """Of an autopilot log: the vehicle's frame; a log of another one is refused, and pulse widths are turned by its MOT_n_DIRECTION."""
    messages: dict[str, str] = {}
    """Of old bags that use types without defining them: name of the type -> text of its .msg."""
    _folder: Path = PrivateAttr(default_factory=Path)

    @property
    def vehicle_file(self) -> str:
        """The vehicle as `rovval.vehicle.load` takes it: a file's path is relative to the profile that names it."""
        return str(self._folder / self.vehicle) if self.vehicle.endswith(".toml") else self.vehicle

    def beside(self, folder: Path) -> Profile:
        """The profile as one of ``folder``: its vehicle's path counts from there."""
        copy = self.model_copy()
        copy._folder = folder
        return copy

    def in_zone(self, timezone: str | None) -> Profile:
        """The profile with ``timezone`` for its stamps, where they are date and time. Raises `UsageProblem` for an unknown zone."""
        if timezone is not None and (wrong := zone_problem(timezone)):
            raise UsageProblem(wrong, "the names are those of the IANA time zone database")
        if timezone is None or self.time.kind != "datetime":
            return self
        return self.model_copy(update={"time": self.time.model_copy(update={"timezone": timezone})})

    def source_of(self, channel: str) -> Source | None:
        """The source of a channel of a log: by its name, or by the pattern that it is a member of (``n:T1`` of ``n:T*``)."""
        return self.channels.get(channel) or next((s for key, s in self.channels.items() if fnmatchcase(channel, key)), None)

    def frame_of(self, channel: str) -> str:
        """Body axes that ``channel`` (a key of `channels`) is logged in, or "world"."""
        source = self.channels.get(channel)
        return (source.frame if source else None) or self.frame

    def world_of(self, channel: str) -> str:
        """World axes that ``channel`` is logged in."""
        source = self.channels.get(channel)
        return (source.world if source else None) or self.world

    @property
    def sha256(self) -> str:
        """Digest of what the profile does (its words aside), so that a run's id changes with it."""
        unset = {name: {k for k in LATER["source"] if getattr(source, k) is None} for name, source in self.channels.items()}
        words: dict[str, Any] = {"notes": True, "description": True, "channels": {n: keys for n, keys in unset.items() if keys}}
        words["time"] = {k for k in LATER["time"] if getattr(self.time, k) == Clock.model_fields[k].default}
        words |= {k: True for k in LATER["profile"] if getattr(self, k) == Profile.model_fields[k].default}
        return hashlib.sha256(self.model_dump_json(exclude=words).encode()).hexdigest()


def zone_problem(timezone: str) -> str:
    """What is wrong with the name of a time zone, "" where nothing is."""
    if OFFSET.fullmatch(timezone):
        return "" if int(timezone[1:3]) < 24 and int(timezone[-2:]) < 60 else f"timezone {timezone!r}: no such offset"
    try:
        zoneinfo.ZoneInfo(timezone)
    except (zoneinfo.ZoneInfoNotFoundError, ValueError, OSError):
        return f"timezone {timezone!r}: unknown; use a name such as Europe/Berlin, or an offset such as +02:00"
    return ""
