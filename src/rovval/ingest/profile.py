"""A profile: one TOML file that says, for one source of logs, which column or topic is which channel, in which unit and frame.

Nothing is guessed: a mapped channel without unit is refused by name. Keys of `[channels]` are names of `rovval.core.channels`;
`"n:*" = {column = "*_PV", unit = "rpm"}` maps every column that fits the pattern, and `attitude` with the unit `quaternion`
stands for the three Euler angles.
"""

from __future__ import annotations

import hashlib
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, PrivateAttr, ValidationError

from rovval.core.channels import CHANNELS, VELOCITIES, Resampling
from rovval.core.errors import UsageProblem, all_at_once
from rovval.core.units import SI

FOLDER = Path(__file__).parent / "profiles"
ATTITUDE = "attitude"  # a quaternion that becomes phi, theta, psi
WORLD_VELOCITY = ("u", "v", "w")  # may be logged along world axes (`frame = "world"`) and are rotated into the body
GEODETIC = "degree_latitude"  # the unit of x and y when they are logged as latitude and longitude

# FRAME_CONFIG of ArduSub (ardupilot.org, Sub frame configurations) of the frames whose tables `rovval.vehicle` has.
ARDUSUB_FRAMES = {"vectored": 1, "vectored_6dof": 2}

BodyFrame = Literal["fsd", "flu"]
WorldFrame = Literal["ned", "enu", "nwu"]


class Source(BaseModel):
    """Where a channel stands in the log and how it becomes SI: ``sign * (raw - zero) / span`` in ``unit``. ``topic`` may be a list of
    names of one topic: the first that the bag has is read. ``longest_gap_s``: how far a gap is bridged; a command that is held also acts
    so long after its last message. ``sign_from``, of a speed that is logged without sign: the thruster's own command that has it,
    ``n_cmd`` or ``pwm`` (about 1500 us)."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    unit: str
    column: str | None = None
    columns: tuple[str, ...] = ()
    topic: str | Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    field: str | None = None
    sign: Literal[1, -1] = 1
    zero: float = 0.0
    span: float = 1.0
    missing: tuple[float, ...] = ()
    sign_from: Literal["n_cmd", "pwm"] | None = None
    optional: bool = False
    frame: Literal["fsd", "flu", "world"] | None = None
    resampling: Resampling | None = None
    longest_gap_s: float | None = Field(default=None, gt=0.0)
    stuck_s: float | None = Field(default=None, gt=0.0)

    @property
    def topics(self) -> tuple[str, ...]:
        """The names of the topic, best first; () for a source that is no topic."""
        return () if self.topic is None else (self.topic,) if isinstance(self.topic, str) else self.topic


class Clock(BaseModel):
    """Where the stamps come from. ``time_of_day``: columns hour, minute, second and perhaps millisecond, wrapping at midnight.
    ``epoch``: since 1970 UTC, ``elapsed``: since any start, both in ``unit``. ``datetime``: text. ``header``, ``record``: a bag's
    clocks: when the sensor says it measured, when the recorder wrote."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    kind: Literal["time_of_day", "epoch", "elapsed", "datetime", "header", "record"]
    columns: tuple[str, ...] = ()
    unit: str = "s"


class Profile(BaseModel):
    """One source of logs. ``format`` is the name of the reader (a file of `rovval.ingest`); ``absent`` names columns or topics
    whose presence says that a log is *not* of this source. ``relative_heading``: the heading counts from the start while the
    position is in fixed axes; the constant between them is found from the log and reported. ``messages``: definitions (name -> text of the .msg) of types that
    old bags use without defining them. ``ardusub_frame``: the frame of the vehicle in an autopilot log; a log of another one is refused, and
    pulse widths are turned by the log's MOT_n_DIRECTION."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: str = Field(pattern=r"^[A-Za-z0-9_\-]+$")
    description: str
    notes: str = ""
    format: str
    vehicle: str = ""
    frame: BodyFrame
    world: WorldFrame
    relative_heading: bool = False
    time: Clock
    channels: dict[str, Source] = Field(min_length=1)
    absent: tuple[str, ...] = ()
    ardusub_frame: Literal["vectored", "vectored_6dof"] | None = None
    messages: dict[str, str] = {}
    _folder: Path = PrivateAttr(default_factory=Path)

    @property
    def vehicle_file(self) -> str:
        """The vehicle as `rovval.vehicle.load` takes it: a file's path is relative to the profile that names it."""
        return str(self._folder / self.vehicle) if self.vehicle.endswith(".toml") else self.vehicle

    @property
    def sha256(self) -> str:
        """Digest of what the profile does (its words aside), so that a run's id changes with it."""
        unset = {name: {"sign_from"} for name, source in self.channels.items() if source.sign_from is None}  # ids of runs stay as they were
        words: dict[str, Any] = {"notes": True, "description": True, "channels": unset}
        if self.ardusub_frame is None:
            words["ardusub_frame"] = True
        return hashlib.sha256(self.model_dump_json(exclude=words).encode()).hexdigest()


def profiles() -> tuple[str, ...]:
    """Names of the built-in profiles."""
    return tuple(sorted(path.stem for path in FOLDER.glob("*.toml")))


def load_profile(name_or_path: str | Path) -> Profile:
    """A built-in profile by name, or a user's by path; refuses with every problem at once (`UsageProblem`)."""
    built_in = FOLDER / f"{name_or_path}.toml"
    path = built_in if built_in.parent == FOLDER and built_in.is_file() else Path(name_or_path)
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except (FileNotFoundError, IsADirectoryError):
        hint = f"use a path to a TOML file or one of: {', '.join(profiles())}"
        raise UsageProblem(f"unknown profile {str(name_or_path)!r}", hint) from None
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise UsageProblem(f"profile {path}: not readable as TOML: {error}") from None
    profile = parse_profile(table, str(path))
    profile._folder = path.parent
    return profile


def parse_profile(table: Mapping[str, Any], where: str) -> Profile:
    """A checked profile from TOML's tables; ``where`` names it in messages. Raises `UsageProblem` with every problem."""
    try:
        profile = Profile.model_validate(dict(table))
    except ValidationError as error:
        raise UsageProblem(all_at_once([_say(e) for e in error.errors()], f"profile {where}"), _HINT) from None
    if problems := _problems(profile):
        raise UsageProblem(all_at_once(problems, f"profile {where}"), _HINT)
    return profile


_HINT = "see `rovval show profile merlin` for one that works"


def _say(error: Any) -> str:
    place = [str(part) for part in error["loc"]]
    if place[:1] == ["channels"] and place[2:] == ["unit"]:
        return f"channel {place[1]!r}: states no unit; nothing is guessed"
    return f"{'.'.join(place)}: {error['msg']}" + (f" (got {error['input']!r})" if error["type"] != "missing" else "")


def _problems(profile: Profile) -> list[str]:
    found = [p for name, source in profile.channels.items() for p in _channel_problems(name, source)]
    if (profile.frame == "fsd") != (profile.world == "ned"):
        found.append(f"frame {profile.frame!r} with world {profile.world!r}: the pairs are fsd with ned, flu with enu or nwu")
    if profile.ardusub_frame is not None and profile.format != "autopilot":
        found.append(f"ardusub_frame is for autopilot logs, not {profile.format}")
    if profile.time.unit not in SI:
        found.append(f"time: unknown unit {profile.time.unit!r}")
    wanted = {"time_of_day": (3, 4), "epoch": (0, 1), "elapsed": (1, 1), "datetime": (1, 2), "header": (0, 0), "record": (0, 0)}
    low, high = wanted[profile.time.kind]
    if not low <= len(profile.time.columns) <= high:
        found.append(f"time: {profile.time.kind} needs {low} to {high} columns, not {len(profile.time.columns)}")
    if profile.format != "ros_bag" and (several := [n for n, s in profile.channels.items() if len(s.topics) > 1]):
        found.append(f"{', '.join(several)}: a list of topics is for bags; {profile.format} takes one name")
    world = [n for n in WORLD_VELOCITY if n in profile.channels and profile.channels[n].frame == "world"]
    if world and len(world) < 3:
        found.append(f"{', '.join(world)}: velocity along world axes needs all of u, v, w with frame = 'world'")
    lacking = {s.sign_from for s in profile.channels.values() if s.sign_from} - {n.partition(":")[0] for n in profile.channels}
    found += [f"sign_from = {family!r}: no channel {family}:THRUSTER is mapped" for family in sorted(lacking)]
    geodetic = [n for n in ("x", "y") if n in profile.channels and profile.channels[n].unit == GEODETIC]
    if len(geodetic) == 1:
        found.append(f"{geodetic[0]}: latitude and longitude go together; map x and y both with unit {GEODETIC}")
    return found


def _channel_problems(name: str, source: Source) -> list[str]:
    found = []
    family, _, member = name.partition(":")
    if name != ATTITUDE and family not in CHANNELS:
        found.append(f"channel {name!r}: unknown; use one of: {', '.join(CHANNELS)}, {ATTITUDE}")
    addresses = [source.column is not None, bool(source.columns), source.topic is not None]
    if sum(addresses) != 1:
        found.append(f"channel {name!r}: needs exactly one of column, columns, topic")
    if (source.topic is None) != (source.field is None):
        found.append(f"channel {name!r}: topic and field go together")
    if source.columns and (name != ATTITUDE or len(source.columns) != 4):
        found.append(f"channel {name!r}: columns is for attitude, as four columns w, x, y, z")
    if (source.unit == "quaternion") != (name == ATTITUDE) or (source.unit != "quaternion" and source.unit not in SI):
        found.append(f"channel {name!r}: unknown unit {source.unit!r}; use one of: {', '.join(sorted(SI))}")
    places = (source.column,) if source.column else source.topics or ("",)
    if any(("*" in member) != ("*" in address) for address in places) or member.count("*") > 1:
        found.append(f"channel {name!r}: a pattern needs one * in the channel and one in its column")
    if source.frame == "world" and name not in WORLD_VELOCITY:
        found.append(f"channel {name!r}: frame = 'world' is for u, v, w")
    if source.frame is not None and family not in (*VELOCITIES, "udot", "vdot", "wdot"):
        found.append(f"channel {name!r}: has no frame")
    if source.sign_from is not None and family != "n":
        found.append(f"channel {name!r}: sign_from is for measured thruster speeds, n:THRUSTER")
    if source.span == 0.0:
        found.append(f"channel {name!r}: span must not be 0")
    return found
