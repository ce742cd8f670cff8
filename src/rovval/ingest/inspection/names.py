"""What the name of a column, topic or field makes one think of: a channel, and a unit. A guess, to be marked as one."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from rovval.core.units import SI
from rovval.ingest.table.text_table import stated_unit
from rovval.ingest.table.unit_names import unit_of

COMMAND = {"cmd", "command", "commanded", "setpoint", "sp", "set", "desired", "target", "demand", "ref", "reference", "soll"}
SPEED = {"vel", "velocity", "speed", "linvel", "geschwindigkeit", "fahrt"}
TURNING = {"ang", "rate", "rates", "angvel", "angular", "gyro", "gyr", "omega", "dot", "drehrate"} | SPEED
SHAFT = {"rpm", "drehzahl", "revs", "rps", "erpm", "umdrehungen"}
THRUSTER = {"thruster", "thrusters", "motor", "motors", "esc", "prop", "propeller", "thr", "antrieb"}
PULSE = {"pwm", "servo", "rcout", "pulse"}
STICK = {"stick", "joy", "joystick", "rc", "pilot"}
DECORATION = {"raw", "pv", "meas", "measured", "act", "actual", "feedback", "fb", "state", "input", "output", "data", "value", "ist", "channel", "channels"}
ANGLES = {"phi": {"roll", "phi", "rollwinkel", "kraengung", "rollen"}, "theta": {"pitch", "theta", "nick", "nicken", "stampfen", "trim"},
          "psi": {"yaw", "heading", "hdg", "psi", "kurs", "compass", "gier", "head"}}  # fmt: skip
RATES = {"phi": "p", "theta": "q", "psi": "r"}
AXES = {
    "u": {"x", "surge", "forward", "fwd", "ahead", "vor", "voraus", "u", "bow", "vx"},
    "v": {"y", "sway", "lateral", "starboard", "right", "stbd", "v", "vy", "quer", "left", "port"},
    "w": {"z", "heave", "down", "vertical", "w", "vz", "up"},
}
AGAINST = {"left", "port", "up", "back", "aft"}  # words of a direction against forward, starboard and down
WORLD_AXES = {"u": {"north", "nord", "n", "vn", "northing"}, "v": {"east", "ost", "e", "ve", "easting"}, "w": {"down", "d", "vd"}}
STICK_AXES = {
    "surge": {"surge", "forward", "fwd"}, "sway": {"sway", "lateral"}, "heave": {"heave", "throttle", "vertical"},
    "roll": {"roll"}, "pitch": {"pitch"}, "yaw": {"yaw"},
}  # fmt: skip
DEPTH = {"depth", "tiefe", "teufe", "dpt"}
ALTITUDE = {"altitude", "altimeter", "bodenabstand", "hoehe", "height"}
SINGLE = {**{n: n for n in "pqruvwxyz"}, "wx": "p", "wy": "q", "wz": "r", "vx": "u", "vy": "v", "vz": "w"}
SUFFIXES = {
    "mps": "m/s", "radps": "rad/s", "rad": "rad", "deg": "deg", "dps": "deg/s", "degps": "deg/s", "kn": "knot", "kts": "knot", "knots": "knot", "rpm": "rpm",
    "rps": "rev/s", "m": "m", "cm": "cm", "mm": "mm", "us": "pwm_us", "volt": "V", "mv": "mV", "degs": "deg/s", "rads": "rad/s",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Guess:
    """A channel that a name makes one think of, by which word; ``world``: along the world's axes; ``against``: the name says the other direction;
    ``up``: it counts upwards."""

    channel: str
    word: str
    world: bool = False
    against: bool = False
    up: bool = False


def words(name: str) -> list[str]:
    """``LinVelX [m/s]`` -> lin, vel, x; ``/thrusters/T1/rpm`` -> thrusters, t, 1, rpm."""
    plain = re.sub(r"\(.*?\)|\[[^\d\]][^\]]*\]", " ", name)
    for umlaut, letters in (("ä", "ae"), ("ö", "oe"), ("ü", "ue"), ("ß", "ss")):
        plain = plain.replace(umlaut, letters)
    return [w.casefold() for w in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", plain)]


def unit_said(name: str, stated: str) -> str | None:
    """The unit that the log or the name says, in the words of a profile; None where neither does."""
    for said in (stated, stated_unit(name) or ""):
        unit = unit_of(said)
        if unit in SI and unit != "1":
            return "pwm_us" if unit == "us" else unit
    said_words = words(name)
    if set(said_words) & {"rpm", "drehzahl"}:
        return "rpm"
    return SUFFIXES.get(said_words[-1]) if len(said_words) > 1 else None


def channel_guess(said: Sequence[str], unit: str | None) -> Guess | None:
    """The channel of a field whose name has these words; a thruster's is its family alone (``n``, ``n_cmd``, ``pwm``)."""
    w = set(said)
    for family in (_thruster, _stick, _angle, _velocity, _place, _other):
        if (guess := family(w, list(said), unit)) is not None:
            return guess
    return None


def _first(w: set[str], known: set[str]) -> str:
    return next(iter(sorted(w & known)), "")


def _thruster(w: set[str], said: list[str], unit: str | None) -> Guess | None:
    if (word := _first(w, SHAFT)) or unit in ("rpm", "rev/s") or (w & THRUSTER and w & {"speed", "velocity", "omega"}):
        return Guess("n_cmd" if w & COMMAND else "n", word or unit or "speed")
    if (word := _first(w, PULSE)) or unit == "pwm_us":
        return Guess("pwm", word or "us")
    return None


def _stick(w: set[str], said: list[str], unit: str | None) -> Guess | None:
    if not (word := _first(w, STICK)):
        return None
    axis = next((a for a, names in STICK_AXES.items() if w & names), None)
    return Guess(f"stick:{axis}", word) if axis else None


def _angle(w: set[str], said: list[str], unit: str | None) -> Guess | None:
    for channel, names in ANGLES.items():
        if word := _first(w, names):
            if w & COMMAND:
                return None
            turning = bool(w & TURNING) or unit in ("deg/s", "rad/s", "mrad/s") or f"{word}speed" in w
            return Guess(RATES[channel] if turning else channel, word)
    for word, channel in (("rollspeed", "p"), ("pitchspeed", "q"), ("yawspeed", "r"), ("turn", "r")):
        if word in w:
            return Guess(channel, word)
    return None


def _velocity(w: set[str], said: list[str], unit: str | None) -> Guess | None:
    if w & COMMAND or w & {"acc", "accel", "acceleration", "covariance", "variance", "std"}:
        return None
    turning = w & (TURNING - SPEED) or unit in ("deg/s", "rad/s")
    if turning and (axis := next((a for a in "xyz" if a in w), None)):
        return Guess({"x": "p", "y": "q", "z": "r"}[axis], f"{_first(w, TURNING)} {axis}".strip())
    moving = bool(w & SPEED) or unit in ("m/s", "cm/s", "mm/s", "knot", "km/h")
    if not moving and not w & {"vn", "ve", "vd"}:
        return None
    for channel, names in WORLD_AXES.items():
        if (word := _first(w, names)) and (w & {"vn", "ve", "vd"} or w & {"north", "east", "nord", "ost"}):
            return Guess(channel, word, world=True)
    for channel, names in AXES.items():
        if word := _first(w, names):
            return Guess(channel, word, against=word in AGAINST)
    return None


def _place(w: set[str], said: list[str], unit: str | None) -> Guess | None:
    if w & COMMAND:
        return None
    for channel, known in (("z", DEPTH), ("altitude", ALTITUDE), ("x", {"lat", "latitude"}), ("y", {"lon", "longitude", "lng"})):
        if word := _first(w, known):
            return Guess(channel, word)
    if w & {"pos", "position", "northing", "easting", "north", "east"}:
        for channel, known in (("x", {"x", "north", "northing"}), ("y", {"y", "east", "easting"}), ("z", {"z", "down"})):
            if word := _first(w, known):
                return Guess(channel, word)
    return None


def _other(w: set[str], said: list[str], unit: str | None) -> Guess | None:
    if w & {"voltage", "volt", "spannung"} or unit in ("V", "mV"):
        return Guess("voltage", _first(w, {"voltage", "volt", "spannung"}) or str(unit))
    if {"rel", "alt"} <= w:
        return Guess("z", "rel_alt", up=True)
    for word, family in (("pv", "n"), ("sp", "n_cmd")):  # process value and set-point, as controllers of drives call them
        if word in w and len(said) > 1:
            return Guess(family, word)
    if w & {"tether", "cable"} and w & {"length", "out", "laenge"}:
        return Guess("tether_length", "tether")
    bare = [s for s in said if s not in SUFFIXES and s not in {"m", "s"}]
    if len(bare) == 1 and bare[0] in SINGLE:
        return Guess(SINGLE[bare[0]], bare[0])
    return None
