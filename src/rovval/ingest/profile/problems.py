"""What is wrong with a profile whose keys are all of the right type: every problem, each in a sentence."""

from __future__ import annotations

from rovval.core.channels import CHANNELS, VELOCITIES
from rovval.core.units import SI, TIME_UNITS
from rovval.ingest.profile.model import ATTITUDE, GEODETIC, WORLD_VELOCITY, Clock, Profile, Source, zone_problem

COLUMNS = {"time_of_day": (1, 3, 4), "epoch": (0, 1), "elapsed": (1,), "datetime": (1, 2, 6), "header": (0,), "record": (0,)}  # of each kind of clock
FRAMED = (*VELOCITIES, "udot", "vdot", "wdot", "theta", ATTITUDE)  # channels that have body axes
PLACED = ("x", "y", "z", "psi", ATTITUDE, *WORLD_VELOCITY)  # channels that have world axes


def problems(profile: Profile) -> list[str]:
    """Every problem of a profile; [] for one that can be used."""
    found = [p for name, source in profile.channels.items() for p in _of_channel(name, source)]
    found += [*_of_clock(profile.time), *_of_frames(profile)]
    if profile.ardusub_frame is not None and profile.format != "autopilot":
        found.append(f"ardusub_frame is for autopilot logs, not {profile.format}")
    if profile.format != "ros_bag" and (several := [n for n, s in profile.channels.items() if len(s.topics) > 1]):
        found.append(f"{', '.join(several)}: a list of topics is for bags; {profile.format} takes one name")
    if profile.header and profile.format != "csv_log":
        found.append(f"header is for tables of text (csv_log), not {profile.format}")
    if twice := sorted({n for n in profile.header if profile.header.count(n) > 1}):
        found.append(f"header: {', '.join(map(repr, twice))} stand there twice")
    if (m := profile.markers) is not None and ((m.column is None) == (m.topic is None) or (m.topic is None) != (m.field is None)):
        found.append("markers: needs either column, or topic and field")
    lacking = {s.sign_from for s in profile.channels.values() if s.sign_from} - {n.partition(":")[0] for n in profile.channels}
    found += [f"sign_from = {family!r}: no channel {family}:THRUSTER is mapped" for family in sorted(lacking)]
    geodetic = [n for n in ("x", "y") if n in profile.channels and profile.channels[n].unit == GEODETIC]
    if len(geodetic) == 1:
        found.append(f"{geodetic[0]}: latitude and longitude go together; map x and y both with unit {GEODETIC}")
    return found


def _of_clock(clock: Clock) -> list[str]:
    found = []
    if clock.unit not in TIME_UNITS:
        found.append(f"time: unknown unit {clock.unit!r}" if clock.unit not in SI else f"time: {clock.unit!r} is no unit of time")
    if len(clock.columns) not in COLUMNS[clock.kind]:
        wanted = " or ".join(str(n) for n in COLUMNS[clock.kind])
        found.append(f"time: {clock.kind} needs {wanted} columns, not {len(clock.columns)}")
    if clock.date_order is not None and clock.kind != "datetime":
        found.append(f"time: date_order is for datetime, not {clock.kind}")
    if clock.since != "unix" and clock.kind != "epoch":
        found.append(f"time: since is for epoch, not {clock.kind}")
    if clock.timezone is not None:
        if clock.kind != "datetime" and (clock.kind, clock.since) not in (("epoch", "excel"), ("epoch", "matlab"), ("epoch", "labview")):
            found.append(f"time: timezone is for stamps of a wall clock (datetime), not {clock.kind}")
        found += [f"time: {p}"] if (p := zone_problem(clock.timezone)) else []
    return found


def _of_frames(profile: Profile) -> list[str]:
    """Frames that contradict each other, and what has to be stated where body and world do not belong together."""
    found = []
    along = [n for n in WORLD_VELOCITY if n in profile.channels and profile.frame_of(n) == "world"]
    if along and len(along) < 3:
        found.append(f"{', '.join(along)}: velocity along world axes needs all of u, v, w with frame = 'world'")
    for together in (("x", "y"), along):
        if len({profile.world_of(n) for n in together if n in profile.channels}) > 1:
            found.append(f"{', '.join(together)}: in different world axes; they are of one")
    if (profile.frame == "fsd") == (profile.world == "ned"):
        return found
    pair = f"with frame {profile.frame!r} and world {profile.world!r}"
    if (psi := profile.channels.get("psi")) and psi.world is None:
        found.append(f"channel 'psi': {pair} say how the heading counts: world = 'ned' (a compass: clockwise from north) or world = {profile.world!r}")
    if (q := profile.channels.get(ATTITUDE)) and (q.world is None or q.frame is None):
        found.append(f"channel {ATTITUDE!r}: {pair} say from which body axes into which world axes the quaternion turns: frame = ..., world = ...")
    return found


def _of_channel(name: str, source: Source) -> list[str]:
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
    if source.frame is not None and family not in FRAMED:
        found.append(f"channel {name!r}: has no frame")
    if source.world is not None and (name not in PLACED or (name in WORLD_VELOCITY and source.frame != "world")):
        found.append(f"channel {name!r}: has no world axes")
    if source.sign_from is not None and family != "n":
        found.append(f"channel {name!r}: sign_from is for measured thruster speeds, n:THRUSTER")
    if source.span == 0.0:
        found.append(f"channel {name!r}: span must not be 0")
    return found
