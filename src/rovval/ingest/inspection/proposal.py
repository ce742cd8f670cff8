"""A profile for a log that none is known for: from names, units in headers and values, every guess marked for review."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from rovval.ingest.inspection import uorb_types
from rovval.ingest.inspection.inspect import Inspection
from rovval.ingest.inspection.matches import match
from rovval.ingest.inspection.names import DECORATION, PULSE, SHAFT, SPEED, THRUSTER, Guess, channel_guess, unit_said, words
from rovval.ingest.inspection.ros_types import ARRAYS, meaning
from rovval.ingest.inspection.stamps_of_table import Stamps
from rovval.ingest.inspection.summary import FieldSummary, TopicSummary
from rovval.ingest.profile import FOLDER, Clock, Profile, Source, load_profile

TURN_RAD, TURN_DEG = 6.4, 361.0  # no angle in radians is larger than the first, none in degrees than the second (two pi and 360, and a margin)
RATE_RAD = 3.5  # rad/s: a vehicle under water does not turn faster than this (200 deg/s), so that larger values are degrees a second
PULSES_US = (800.0, 2200.0)  # widths that RC servos and ESCs take
SHAFT_RPS = 80.0  # rev/s: no thruster of an ROV turns faster, so that larger values are rpm
COMMANDS = ("n", "pwm", "stick")  # of a thruster or stick that was at rest all the time a line is proposed all the same
QUATERNIONS = tuple(tuple(f"{stem}{n}" for n in ends) for stem, ends in (("q", "wxyz"), ("quat", "wxyz"), ("q", "0123"), ("orientation", "wxyz")))
NOTES = {"event", "events", "marker", "markers", "mark", "note", "notes", "comment", "mode", "annotation", "ereignis", "bemerkung", "statustext", "msg"}
ADDRESS = ("column", "columns", "topic", "field")  # stand first in a line
BY_DEFAULT = {"u": "m/s", "v": "m/s", "w": "m/s", "x": "m", "y": "m", "z": "m", "altitude": "m", "voltage": "V", "tether_length": "m", "pwm": "pwm_us"}


@dataclass(frozen=True, slots=True)
class Line:
    """One mapped channel: its source as TOML keys, why it is thought so, and what has to be reviewed ("" where the log itself says it)."""

    channel: str
    source: Mapping[str, object]
    why: str
    review: str


@dataclass(frozen=True, slots=True)
class _Candidate:
    topic: TopicSummary
    field: FieldSummary
    guess: Guess
    unit: str
    why: str
    review: str


def proposed(found: Inspection, name: str) -> str:
    """The profile as TOML, to be read and changed by a person: the built-in one where one reads the log, else one of guesses with ``draft = true``,
    under which every run says that nobody has reviewed it."""
    if len(found.fits) == 1:
        text = (FOLDER / f"{found.fits[0]}.toml").read_text(encoding="utf-8")
        text = re.sub(r'^name = ".*"$', f"name = {json.dumps(name)}", text, count=1, flags=re.MULTILINE)
        return f"# The built-in profile {found.fits[0]} reads this log as it is; this is a copy, to be changed.\n{text}"
    lines = _as_built_in(found) or _from_names(found)
    header = [
        f"# Proposed by rovval from the names, units and values of {Path(found.path).name}. Lines with REVIEW are guesses:",
        f"# confirm or mend each, then `rovval profile check {name}.toml {Path(found.path).name}`, and delete the line `draft`.",
        f"name = {json.dumps(name)}",
        f"description = {_quoted(f'Logs such as {Path(found.path).name}')}",
        f"format = {json.dumps(found.format)}",
        'vehicle = ""  # REVIEW: a name of `rovval list vehicle`, or a file',
        *_axes(found.format),
        "draft = true  # every run says so until this line is deleted",
        "",
        "[time]",
        *_clock(found),
        "",
        "[channels]",
        *([_text(line) for line in lines] or ["# no name here says a channel: map what is left over by hand"]),
        *_markers(found),
    ]
    left = _left_over(found, lines)
    return "\n".join([*header, "", "# Left over, mapped to nothing:", *(f"#   {_printable(one)}" for one in left)] if left else header) + "\n"


def _axes(form: str) -> list[str]:
    """The axes that a source of this format has: an autopilot's own, else what is usual."""
    if form in ("ulog", "autopilot"):
        return ['frame = "fsd"  # forward-right-down, as PX4 and ArduPilot define it', 'world = "ned"  # north-east-down, as they define it']
    if form == "ros_bag":
        return [f'{key} = "{axes}"  # REVIEW: REP-103 of ROS; the log does not say it' for key, axes in (("frame", "flu"), ("world", "enu"))]
    return [
        'frame = "fsd"  # REVIEW: as most vehicles log; the log does not say it',
        'world = "ned"  # REVIEW: depth positive down, heading clockwise from north',
    ]


def _markers(found: Inspection) -> list[str]:
    """The first text that by its name says what happens: what `--from` and `--to` may name."""
    for topic in found.contents.topics.values():
        for f in topic.fields.values():
            if f.low is None and {*words(f.address), *words(topic.name)} & NOTES:
                place = [f"topic = {_quoted(topic.name)}", f"field = {_quoted(f.address)}"] if topic.clocks else [f"column = {_quoted(f.address)}"]
                return ["", "[markers]  # REVIEW: texts that --from and --to take in place of seconds", *place]
    return []


def _clock(found: Inspection) -> list[str]:
    topics = [t for t in found.contents.topics.values() if t.clocks]
    if topics:
        with_header = sum("header" in t.clocks for t in topics)
        kind = "header" if with_header else "record"
        why = f"{with_header} of {len(topics)} topics have stamps of their own" if with_header else "no message has a stamp of its own"
        return [f'kind = "{kind}"  # {why}; {"the others have" if with_header else ""} the recorder\'s'.replace(";  the", "; these are the")]
    several = max(found.stamps.values(), key=len, default=())
    if not several:
        return ['kind = "elapsed"  # REVIEW: no column rises with the rows', 'columns = ["?"]', 'unit = "s"']
    where = "" if len(found.stamps) < 2 else f"  # REVIEW: of each of {', '.join(found.stamps)}"
    return [*_stamp_lines(several[0], where), *(f"# or: {'; '.join(_stamp_lines(s))}" for s in several[1:3])]


def _stamp_lines(s: Stamps, where: str = "") -> list[str]:
    lines = [f'kind = "{s.kind}"  # {"" if s.sure else "REVIEW: "}{s.why}', f"columns = {_quoted(list(s.columns))}{where}"]
    lines += [f'unit = "{s.unit}"'] if s.kind in ("elapsed", "epoch") else []
    lines += [f'since = "{s.since}"'] if s.since != "unix" else []
    lines += [f'date_order = "{s.date_order}"'] if s.date_order else []
    zoned = s.kind == "datetime"
    return lines + (['# timezone = "Europe/Berlin"  # of stamps without their own; without it UTC'] if zoned else [])


def _as_built_in(found: Inspection) -> list[Line]:
    """What the built-in profile that finds most has found, for logs of messages whose types fix their meaning (autopilots)."""
    if found.format != "autopilot" or not found.matches or not found.matches[0].found:
        return []
    best = found.matches[0]
    profile = load_profile(best.profile)
    out = []
    for channel in best.found:
        source = profile.channels[channel]
        keys = {k: v for k, v in source.model_dump(exclude_defaults=True).items() if v is not None}
        out.append(Line(channel, keys, f"as in the profile {best.profile}", "thruster" if ":" in channel else ""))
    return out


def _from_names(found: Inspection) -> list[Line]:
    candidates = [c for topic in found.contents.topics.values() for c in _alike(list(_candidates(topic, found)))]
    lines: dict[str, Line] = {}
    families: dict[tuple[str, str], list[_Candidate]] = {}
    for c in candidates:
        if c.guess.channel in ("n", "n_cmd", "pwm"):
            families.setdefault((c.guess.channel, c.unit), []).append(c)
            continue
        if (channel := c.guess.channel) in lines:
            continue  # the first of several: the others are left over, and said to be
        lines[channel] = _line(channel, c)
    for (family, _), members in families.items():
        for line in _family(family, members, found):
            lines.setdefault(line.channel, line)
    return list(_complete(lines))


def _complete(lines: dict[str, Line]) -> Iterator[Line]:
    """Lines that a profile can have: velocities along the world only all three, latitude with longitude, a quaternion instead of angles."""
    along = [n for n in "uvw" if n in lines and lines[n].source.get("frame") == "world"]
    geodetic = [n for n in "xy" if n in lines and lines[n].source.get("unit") == "degree_latitude"]
    for channel, line in lines.items():
        alone = (channel in along and len(along) < 3) or (channel in geodetic and len(geodetic) < 2)
        if not alone and not (channel in ("phi", "theta", "psi") and "attitude" in lines):
            yield line


def _candidates(topic: TopicSummary, found: Inspection) -> Iterator[_Candidate]:
    stamps = {c for s in found.stamps.get(topic.name, ())[:1] for c in s.columns}
    typed = uorb_types.FIELDS.get(topic.kind, {}) if found.format == "ulog" else meaning(topic.kind)
    along_world = found.format == "ulog" and topic.kind in uorb_types.ALONG_WORLD
    angles = set(words(topic.name)) & {"angle", "angles", "euler", "rpy"}
    for address, (channel, unit) in typed.items():
        first = next((a for a in (f"{address}.w", f"{address}[0]") if a in topic.fields), "") if channel == "attitude" else address
        if first in topic.fields and angles and channel in "pqr" and not topic.fields[first].constant:
            channel, (unit, how) = dict(zip("pqr", ("phi", "theta", "psi"), strict=True))[channel], _by_values("phi", topic.fields[first])
            yield _Candidate(topic, topic.fields[first], Guess(channel, topic.name), unit, f"angles by the topic's name; {how}", "channel and unit")
        elif first in topic.fields and _filled(topic, first):
            review = "" if "Odometry" in topic.kind or found.format == "ulog" else "axes"
            defined = Guess(channel, topic.kind, world=along_world and channel in "uvw")
            yield _Candidate(topic, topic.fields[first], defined, unit, f"{topic.kind} defines it", review)
    array = (uorb_types.ARRAYS if found.format == "ulog" else ARRAYS).get(topic.kind.replace("/msg/", "/"))
    quaternion = _quaternion(topic)
    if quaternion and not typed:
        yield _Candidate(topic, topic.fields[quaternion[0]], Guess("attitude", "quaternion"), "quaternion", "four columns of norm one", "order and axes")
    for f in topic.fields.values():
        if f.low is None or f.address in stamps or f.address in quaternion or (typed and topic.kind):
            continue
        if array and f.address.startswith(f"{array[0]}["):
            yield _Candidate(topic, f, Guess(array[1], topic.kind), array[2], f"{topic.kind} defines it", "which thruster")
            continue
        said = [*words(topic.name), *words(f.address), *_axis(f.address, topic)]
        stated = unit_said(f.address, f.unit)
        if (guess := channel_guess(said, stated)) is None or (f.constant and not guess.channel.startswith(COMMANDS)):
            continue
        unit, how = (stated, "unit by its name") if stated else _by_values(guess.channel, f)
        if _likely(guess.channel, unit, f):
            yield _Candidate(topic, f, guess, unit, f"named {guess.word!r}; {how}", "channel" if stated else "channel and unit")


def _filled(topic: TopicSummary, address: str) -> bool:
    """Whether a vector of a message holds anything but zeros: many sources leave what they do not measure at zero."""
    vector = [f for a, f in topic.fields.items() if a.rpartition(".")[0] == address.rpartition(".")[0]]
    return any(f.low != 0.0 or f.high != 0.0 for f in vector)


def _axis(address: str, topic: TopicSummary) -> list[str]:
    """x, y or z for a member of an array of three (``velocity[0]``)."""
    found = re.fullmatch(r"(.*)\[([012])\]", address)
    return ["xyz"[int(found.group(2))]] if found and f"{found.group(1)}[2]" in topic.fields and f"{found.group(1)}[3]" not in topic.fields else []


def _alike(candidates: list[_Candidate]) -> list[_Candidate]:
    """Angles and rates of one topic in one unit: where one is surely degrees by its size or name, so are those that do not say theirs."""
    degrees = any(c.unit == "deg" for c in candidates)
    in_degrees = {"rad": "deg", "rad/s": "deg/s"}
    return [
        replace(c, unit=in_degrees[c.unit], why=f"{c.why}; taken as its neighbours are") if degrees and "may be" in c.why and c.unit in in_degrees else c
        for c in candidates
    ]


def _by_values(channel: str, f: FieldSummary) -> tuple[str, str]:
    size = max(abs(f.low or 0.0), abs(f.high or 0.0))
    said = f"{f.low:.4g} to {f.high:.4g}"
    if channel in ("phi", "theta", "psi"):
        unit = "rad" if size <= TURN_RAD else "deg"
        return unit, f"{said} {'may be rad, or small angles in deg' if unit == 'rad' else 'is deg'}"
    if channel in ("p", "q", "r"):
        unit = "rad/s" if size <= RATE_RAD else "deg/s"
        return unit, f"{said} {'may be rad/s, or slow turns in deg/s' if unit == 'rad/s' else 'is deg/s'}"
    if channel in ("n", "n_cmd"):
        unit = "rpm" if size > SHAFT_RPS else "rev/s"
        return unit, f"{said} {'is rpm' if unit == 'rpm' else 'may be rev/s, or slow rpm'}"
    if channel in ("x", "y") and f.address and set(words(f.address)) & {"lat", "latitude", "lon", "longitude", "lng"}:
        return "degree_latitude", f"{said} is degrees of latitude or longitude"
    if channel.startswith("stick"):
        return "1", f"{said} of 1"
    return BY_DEFAULT.get(channel, "1"), f"{said}, no unit said"


def _likely(channel: str, unit: str, f: FieldSummary) -> bool:
    """Whether values can be the channel's at all."""
    if channel == "pwm":
        return f.low is not None and f.high is not None and f.high >= PULSES_US[0] and f.high <= PULSES_US[1] and (f.low >= PULSES_US[0] or f.low == 0.0)
    return unit != "deg" or max(abs(f.low or 0.0), abs(f.high or 0.0)) <= 2 * TURN_DEG


def _quaternion(topic: TopicSummary) -> list[str]:
    """Four columns of a table that are a quaternion by their names: w, x, y, z in this order; [] where there are none."""
    for names in QUATERNIONS:
        hits = [next((a for a in topic.fields if re.sub(r"[^a-z0-9]", "", a.casefold()).endswith(n)), "") for n in names]
        if topic.kind or not all(hits):
            continue
        ends = [v for a in hits for v in (topic.fields[a].low, topic.fields[a].high)]
        if all(v is not None and abs(v) <= 1.001 for v in ends):
            return hits
    return []


def _line(channel: str, c: _Candidate) -> Line:
    keys: dict[str, object] = {**_address(c), "unit": c.unit}
    if channel == "attitude" and not c.topic.name:
        keys = {"columns": _quaternion(c.topic), "unit": c.unit}
    if c.guess.world:
        keys["frame"] = "world"
    if c.guess.against:
        keys["sign"] = -1
    if channel == "z" and (c.guess.up or ("position" not in c.field.address and c.topic.name)):
        keys["world"] = "enu" if c.guess.up else "ned"
    review = f"{c.review}, and its sign" if c.guess.against else c.review
    return Line(channel, keys, c.why, review)


def _address(c: _Candidate) -> dict[str, object]:
    if not c.topic.name:
        return {"column": re.sub(r"\s*(\(.*?\)|\[.*?\])\s*$", "", c.field.address) or c.field.address}
    field = re.sub(r"(\.w|\[0\])$", "", c.field.address) if c.guess.channel == "attitude" else c.field.address
    return {"topic": c.topic.name, "field": field}


def _family(family: str, members: list[_Candidate], found: Inspection) -> Iterator[Line]:
    """One pattern for all thrusters where one fits them and nothing else, else a line each."""
    places = [str(_address(c)["topic" if c.topic.name else "column"]) for c in members]
    why = members[0].why
    if len(set(places)) == len(places) > 1 and len({str(_address(c).get("field")) for c in members}) == 1:
        before, after = _shared(places), _shared([p[::-1] for p in places])[::-1]
        whole, tail = re.sub(r"[A-Za-z0-9]*$", "", before), re.sub(r"^[A-Za-z0-9]*", "", after)  # a member is a whole word
        before, after = (whole, tail) if whole or tail else (re.sub(r"\d+$", "", before), after)
        cores = [p[len(before) : len(p) - len(after)] for p in places]
        others = list(found.contents.topics if members[0].topic.name else members[0].topic.fields)
        hits = sum(bool(re.fullmatch(re.escape(before) + ".+" + re.escape(after), re.sub(r"\s*[\[(].*$", "", o))) for o in others)
        if all(cores) and hits == len(places):
            star = "T*" if all(c.isdigit() for c in cores) else "*"
            keys = {**_address(members[0]), ("topic" if members[0].topic.name else "column"): f"{before}*{after}", "unit": members[0].unit}
            review = "names of the thrusters, signs" + (", unit" if "unit" in members[0].review else "")
            yield Line(f"{family}:{star}", keys, f"{why}; {', '.join(cores)}", review)
            return
    for i, c in enumerate(members, 1):
        index = re.search(r"\[(\d+)\]$", c.field.address)
        said = [w for w in re.findall(r"[A-Za-z]+|\d+", places[i - 1]) if w.casefold() not in SHAFT | PULSE | THRUSTER | SPEED | DECORATION]
        member = f"T{int(index.group(1)) + 1}" if index else "_".join(said) or f"T{i}"
        yield Line(f"{family}:{f'T{member}' if member.isdigit() else member}", {**_address(c), "unit": c.unit}, c.why, "which thruster, its sign")


def _shared(names: list[str]) -> str:
    first, last = min(names), max(names)
    return first[: next((i for i, (a, b) in enumerate(zip(first, last, strict=False)) if a != b), min(len(first), len(last)))]


def _text(line: Line) -> str:
    key = line.channel if re.fullmatch(r"\w+", line.channel) else _quoted(line.channel)
    known = sorted(line.source, key=(*ADDRESS, *Source.model_fields).index)
    values = ", ".join(f"{k} = {_quoted(line.source[k])}" for k in known)
    return f"{key} = {{ {values} }}  # {f'REVIEW {line.review}: ' if line.review else ''}{_printable(line.why)}"


def _quoted(value: object) -> str:
    """A value as TOML writes it: as JSON, but for one character."""
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def _printable(text: str) -> str:
    """Text that may stand in a comment: a damaged header can hold anything."""
    return "".join(c if c.isprintable() else "?" for c in text)


def _left_over(found: Inspection, lines: list[Line]) -> list[str]:
    """Fields that no line maps and that are no stamps, with their range."""
    keys = {line.channel: Source.model_validate(dict(line.source)) for line in lines}
    used: set[tuple[str, str]] = set()
    if keys:
        draft = Profile.model_construct(name="draft", channels=keys, time=Clock(kind="record"))
        used = {place for places in match(draft, found.contents).found.values() for place in places}
    stamps = {(topic, c) for topic, several in found.stamps.items() for s in several[:1] for c in s.columns}
    left = []
    for topic in found.contents.topics.values():
        free = [f for f in topic.fields.values() if (topic.name, f.address) not in used | stamps]
        left += [f"{topic.name} {f.address}: {'text' if f.low is None else f'{f.low:.4g} to {f.high:.4g}'}".strip() for f in free if not f.constant]
        if idle := [f.address for f in free if f.constant]:
            left.append(f"{topic.name} of one value always: {', '.join(idle)}".strip())
        left += [f"{topic.name} {address}: {what}, not looked at".strip() for address, what in topic.left_out.items()]
    return left
