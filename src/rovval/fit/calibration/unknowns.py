"""The unknowns of a calibration: numbers of a vehicle's file that files get wrong, each with a prior about what the file says.

What cannot be negative is a factor, whose logarithm has a normal prior about 0; what can is an offset. Shared factors come before single
ones: one gain of all thrusters, the ratio of the vertical to the horizontal ones, that of thrust astern to ahead, and then, where they are
asked for, each thruster by itself.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from math import exp, log
from typing import Literal

import numpy as np

from rovval import effects
from rovval.core.channels import AXES
from rovval.core.data import Array
from rovval.effects import Effect, Parameter
from rovval.plant.slots import grown, sizes, slots
from rovval.vehicle.model import Body, Thruster, Vehicle, as_matrix, inertia

Diagonal = tuple[float, ...]

WIDE = log(3.0)  # gain, lag and drag: two published sets of one vehicle differ by as much (Wu 2018; von Benzon et al. 2022)
ADDED = log(1.5)  # added mass: spread of strip theory, panel codes and tests of one hull
SPREAD = log(1.3)  # second moments of mass: from weighed parts they are known to a third (chosen)
SINGLE = 0.1  # one thruster's gain about the others': spread of a batch (chosen)
ASTERN = 0.1  # ratio of thrust astern to ahead about the thruster's table (chosen)
VERTICAL = log(1.5)  # ratio of vertical to horizontal thrusters: shrouding by frame and buoyancy (chosen)
ARM = 0.2  # of the longest thruster arm: height of thrusters, and how far ahead they are (chosen; von Benzon prints 85 mm where 4 mm act)
CENTRE = 0.05  # of the longest thruster arm: where buoyancy acts (chosen)
TRIM = 0.02  # of the weight: what an operator trims to with ballast of some hundred grams (chosen)
TILT = 0.05  # rad: a frame that is measured by eye, 3 degrees (chosen)
LEVER = 0.05  # m: a sensor, or the centre of a motion-capture body, whose place was measured with a tape (chosen)
LAG_S = 0.1  # s: where neither file nor data sheet states one; T200: 0.05 to 0.08 s (von Benzon et al. 2022)
SPLIT = 0.1  # m/s, rad/s: speed at which a linear drag that a file leaves out is taken to equal the quadratic one, and 1 / SPLIT the other way round
SPHERE = 0.5  # added mass of a sphere over the mass that it displaces (Lamb 1932, art. 92), where a file has none

# What a log must hold for an unknown to show by itself, as pilots call it.
KNOWN_FORCE = "a known force against the thrusters (depth held with a weighed bag hung on, or a spring balance): motion shows thrust only over mass and drag"
GROUPS = "steps in heave by the vertical thrusters alone, beside steps in surge and sway by the horizontal ones alone"
BOTH_WAYS = "one axis ahead and astern at the same command, each until the speed is steady"
STEPS = "steps of command from rest and back to none, each held for some seconds"
FREE_TURN = "steps in sway and heave with yaw and pitch left free (no attitude hold)"
FREE_TILT = "steps in surge and sway with roll and pitch left free (no attitude hold)"
COAST = "a coast-down in {0}, thrusters off until it stands: at the slow end linear drag is all that is left"
STEADY = "steady motion in {0} at two speeds or more, the fastest near full command"
FROM_REST = "accelerations in {0} from rest, beside steady speeds: before it moves there is no drag, and thrust over mass is all that shows"
RIGHTED = (  # the same three where weight and buoyancy bring the vehicle back
    "let go from a held {0} with all thrusters off: how its last, small swings die away",
    "let go from as much {0} as the thrusters can hold: how its first, large swings die away",
    "let go from a held {0} with all thrusters off: the period of its swings",
)
PENDULUM = "no motion in water, which shows moments of inertia only with the added mass: swing the vehicle in air, or add up weighed parts"
DRIFT = "half a minute submerged and level with all thrusters off: how it rises or sinks"
LEVEL = "fast steady {0} with a depth sensor: a false angle is depth that changes where the attitude says it should not"
STRAIGHT = "fast straight runs in {0} and in {1}: in a turned frame one of them shows in the other"
SPOT = "turns on the spot in {0} and {1}: a sensor off the centre goes round it"
TETHER = "the same runs and turns with much tether out and with little"
SETTLES = {  # by the axis of the centre of buoyancy
    "x": "rest with all thrusters off until pitch settles",
    "y": "rest with all thrusters off until roll settles",
    "z": "let go from a roll or pitch held by thrusters, all off: how fast it swings back",
}
TURNED = {"roll": ("sway", "heave"), "pitch": ("surge", "heave"), "yaw": ("surge", "sway")}  # axes that a turn of the sensor's frame mixes
SWUNG = {"x": ("pitch", "yaw"), "y": ("roll", "yaw"), "z": ("roll", "pitch")}  # turns that move a sensor which is off along this axis

EFFECTS_WIDE = 2.0  # typical sizes of an effect that may be in every vehicle and in no file: its prior's standard deviation (chosen)

SENSORS = {  # unknown: effect and parameter that say it in a vehicle's file
    **{f"attitude.{c}": ("attitude_bias", c) for c in ("phi", "theta")},
    **{f"velocity.{c}": ("dvl_misalignment", c) for c in ("roll", "pitch", "yaw")},
    **{f"velocity.lever.{c}": ("dvl_lever_arm", c) for c in "xyz"},
}


@dataclass(frozen=True, slots=True)
class Unknown:
    """``key`` says what and where; ``sd`` of its normal prior about 0, of the logarithm for a ``factor``, in ``unit`` for an ``offset``. ``manoeuvre``
    is what a log must hold for it to show by itself. ``optional`` ones are free only where they are asked for."""

    key: str
    kind: Literal["factor", "offset"]
    sd: float
    unit: str
    meaning: str
    manoeuvre: str
    optional: bool = False


def unknowns(vehicle: Vehicle, channels: Sequence[str]) -> tuple[Unknown, ...]:
    """What a log with these measured ``channels`` can be asked about a vehicle."""
    arm = vehicle.longest_arm
    found = [Unknown("thrust.gain", "factor", WIDE, "1", "thrust of all thrusters", KNOWN_FORCE)]
    if 0 < sum(t.vertical for t in vehicle.thruster) < len(vehicle.thruster):
        found.append(Unknown("thrust.vertical", "factor", VERTICAL, "1", "thrust of the vertical thrusters beside the horizontal ones", GROUPS))
    found.append(Unknown("thrust.astern", "factor", ASTERN, "1", "thrust astern beside ahead", BOTH_WAYS))
    found += [
        Unknown(f"thrust.single[{t}]", "factor", SINGLE, "1", f"thrust of {t} beside the others", f"{t} alone, ahead and astern, the others off", True)
        for t in vehicle.thrusters
    ]
    found.append(Unknown("thrust.lag", "factor", WIDE, "1", "time constant of the thrusters' speed", STEPS))
    found.append(Unknown("thrust.height", "offset", ARM * arm, "m", "height of the horizontal thrusters, down", FREE_TILT))
    found.append(Unknown("thrust.ahead", "offset", ARM * arm, "m", "place of all thrusters, ahead of the vehicle's centre", FREE_TURN))
    for axis in AXES:
        slow, fast, jerk = (how.format(axis) for how in (RIGHTED if axis in ("roll", "pitch") else (COAST, STEADY, FROM_REST)))
        found.append(Unknown(f"linear_drag[{axis}]", "factor", WIDE, "1", f"linear drag in {axis}", slow))
        found.append(Unknown(f"quadratic_drag[{axis}]", "factor", WIDE, "1", f"quadratic drag in {axis}", fast))
        found.append(Unknown(f"added_mass[{axis}]", "factor", ADDED, "1", f"added mass in {axis}", jerk))
    found += [Unknown(f"mass.spread.{c}", "factor", SPREAD, "1", f"second moment of mass along {c}", PENDULUM) for c in "xyz"]
    found.append(Unknown("trim.buoyancy", "offset", TRIM * vehicle.weight, "N", "buoyancy beyond the file's", DRIFT))
    found += [Unknown(f"trim.centre.{c}", "offset", CENTRE * arm, "m", f"centre of buoyancy, {c}", how) for c, how in SETTLES.items()]
    if {"phi", "theta"} & set(channels):
        found += [
            Unknown(f"attitude.{c}", "offset", TILT, "rad", f"{c} of the attitude sensor beside the vehicle's", LEVEL.format(axis))
            for c, axis in (("phi", "sway"), ("theta", "surge"))
        ]
    if {"u", "v", "w"} <= set(channels):
        found += [Unknown(f"velocity.{c}", "offset", TILT, "rad", f"{c} of the velocity sensor's frame", STRAIGHT.format(*of)) for c, of in TURNED.items()]
        found += [Unknown(f"velocity.lever.{c}", "offset", LEVER, "m", f"place of the velocity sensor, {c}", SPOT.format(*of)) for c, of in SWUNG.items()]
    found.append(Unknown("tether.drag", "factor", WIDE, "1", "quadratic drag of the tether where it is made fast", TETHER))
    for key, effect, p in _options():
        meaning = f"{effect.title.lower()}, {p.name}"
        found.append(Unknown(key, "offset", EFFECTS_WIDE * p.typical, p.unit, meaning, effect.separates, True))
    return tuple(found)


def _options() -> Iterator[tuple[str, Effect, Parameter]]:
    """Keys, effects and parameters of what the library has as an effect, every vehicle to some degree, and no file (`effects.Effect.option`)."""
    for name in effects.names():
        effect = effects.load(name)
        if effect.option:
            yield from ((f"{effect.option}[{name}.{p.name}]", effect, p) for p in effect.parameters)


@cache
def said_by() -> Mapping[str, tuple[str, str]]:
    """Effect and parameter that say an unknown of the sensors, or of an option of the library's effects, in a vehicle's file, by its key."""
    return {**SENSORS, **{key: (effect.name, p.name) for key, effect, p in _options()}}


def bounds(vehicle: Vehicle, asked: Sequence[Unknown]) -> tuple[Array, Array]:
    """Least and largest values (k,) of the unknowns ``asked``: those that the library holds; infinite where it has none."""
    of, said = {s.key: s.parameter for s in slots(vehicle, "fossen")}, said_by()
    low, high = np.full(len(asked), -np.inf), np.full(len(asked), np.inf)
    for i, one in enumerate(asked):
        if one.key in said:
            name, parameter = said[one.key]
            carried, p = vehicle.effects.get(name, {}).get(parameter, 0.0), of[f"{name}.{parameter}"]
            low[i], high[i] = (p.null if p.vanishes_at == "high" else p.low) - carried, p.high - carried  # a loss is no gain
    return low, high


def applied(vehicle: Vehicle, asked: Sequence[Unknown], values: Array) -> Vehicle:
    """The vehicle with ``values`` (k,) of the unknowns ``asked``: logarithms of factors, offsets as they are. Zeros leave it as it is, but for
    drag and added mass that the file has not, which are there with a first guess."""
    at = {one.key: exp(value) if one.kind == "factor" else float(value) for one, value in zip(asked, values, strict=True)}
    thruster, body = tuple(_thruster(t, at) for t in vehicle.thruster), _body(vehicle, at)
    table = vehicle.pulse_table
    if table is not None and not table.k_pos:  # the table is of the thruster as the file has it: a gain is beside it
        table = table.model_copy(update={"k_pos": tuple(t.k_pos for t in vehicle.thruster), "k_neg": tuple(t.k_neg for t in vehicle.thruster)})
    moved = {one.key: vehicle.calibration.get(one.key, 0.0) + float(value) for one, value in zip(asked, values, strict=True)}
    return vehicle.model_copy(
        update={
            "body": body, "thruster": thruster, "pulse_table": table, "effects": _effects(vehicle, body, at),
            "calibration": {**vehicle.calibration, **moved},
        }
    )  # fmt: skip


def _thruster(one: Thruster, at: Mapping[str, float]) -> Thruster:
    gain = at.get("thrust.gain", 1.0) * at.get(f"thrust.single[{one.name}]", 1.0) * (at.get("thrust.vertical", 1.0) if one.vertical else 1.0)
    x, y, z = one.position
    height = 0.0 if one.vertical else at.get("thrust.height", 0.0)
    astern = at.get("thrust.astern", 1.0)
    return one.model_copy(update={"k_pos": one.k_pos * gain, "k_neg": one.k_neg * gain * astern, "position": (x + at.get("thrust.ahead", 0.0), y, z + height)})


def _body(vehicle: Vehicle, at: Mapping[str, float]) -> Body:
    body = vehicle.body
    linear, quadratic, added = (np.diag(as_matrix(m)).copy() for m in (body.linear_drag, body.quadratic_drag, body.added_mass))
    rigid = np.concatenate([np.full(3, body.mass), np.diag(inertia(body))])
    guess = {
        "linear_drag": np.where(linear > 0, linear, SPLIT * quadratic),
        "quadratic_drag": np.where(quadratic > 0, quadratic, SPLIT * linear),
        "added_mass": np.where(added > 0, added, SPHERE * rigid),
    }
    changed: dict[str, object] = {
        name: _scaled(getattr(body, name), diagonal, np.array([at.get(f"{name}[{axis}]", 1.0) for axis in AXES]))
        for name, diagonal in guess.items()
    }
    changed |= _inertia(body, np.array([at.get(f"mass.spread.{c}", 1.0) for c in "xyz"]))
    centre = tuple(was + at.get(f"trim.centre.{c}", 0.0) for was, c in zip(body.centre_of_buoyancy, "xyz", strict=True))
    volume = body.volume + at.get("trim.buoyancy", 0.0) / (vehicle.water.density * vehicle.water.gravity)
    return body.model_copy(update={**changed, "centre_of_buoyancy": centre, "volume": volume})


def _inertia(body: Body, factor: Array) -> dict[str, float]:
    """Moments and products of inertia of a body whose second moments of mass along the axes are larger by a ``factor`` (3,) each: of these none is negative,
    whatever the factors, so that no moment of inertia exceeds the sum of the others."""
    if (factor == 1.0).all():
        return {}
    tensor = inertia(body)
    spread = (0.5 * np.trace(tensor) * np.eye(3) - tensor) * np.sqrt(np.outer(factor, factor))
    found = np.trace(spread) * np.eye(3) - spread
    return {f"I{a}{b}": float(found[i, j] if i == j else -found[i, j]) for i, a in enumerate("xyz") for j, b in enumerate("xyz") if i <= j}


def _scaled(was: tuple[float, ...] | tuple[tuple[float, ...], ...], diagonal: Array, factor: Array) -> Diagonal | tuple[Diagonal, ...]:
    """A diagonal or a matrix with each axis scaled; S^1/2 A S^1/2 keeps a matrix symmetric and definite."""
    matrix = as_matrix(was)
    if not (matrix != np.diag(np.diag(matrix))).any():
        return tuple(float(x) for x in diagonal * factor)
    root = np.sqrt(factor)
    whole = (matrix - np.diag(np.diag(matrix)) + np.diag(diagonal)) * root[:, None] * root
    return tuple(tuple(float(x) for x in row) for row in whole)


def _effects(vehicle: Vehicle, body: Body, at: Mapping[str, float]) -> dict[str, dict[str, float]]:
    """The [effects] of the calibrated file, which has the ``body``: lag, sensors and tether. What the file carries of them is where their unknowns are
    counted from."""
    found = {name: dict(values) for name, values in vehicle.effects.items()}
    if "thrust.lag" in at:
        found["thrust_lag"] = found.get("thrust_lag", {})
        found["thrust_lag"]["tau"] = (found["thrust_lag"].get("tau") or LAG_S) * at["thrust.lag"]
    if "tether.drag" in at:
        carried = found.get("tether_drag", {})
        first = carried.get("coefficient") or SPLIT * float(np.diag(as_matrix(vehicle.body.quadratic_drag))[0])
        most, after = _most_tether_drag(vehicle), _most_tether_drag(vehicle.model_copy(update={"body": body}))
        drag = at["tether.drag"] * first
        found["tether_drag"] = {**carried, "coefficient": after * drag / (most - first + drag)}
    for key, (effect, parameter) in said_by().items():
        if key in at:
            found[effect] = {**found.get(effect, {}), parameter: found.get(effect, {}).get(parameter, 0.0) + at[key]}
    return found


def _most_tether_drag(vehicle: Vehicle) -> float:
    """The most drag (N s2/m2) that the library holds for a tether of such a vehicle: the factor of a tether's drag is one of its odds against it, which are in
    proportion to the drag while that is small, and never come to it."""
    coefficient = next(p for p in effects.load("tether_drag").parameters if p.name == "coefficient")
    return grown(coefficient, sizes(vehicle)[coefficient.sized]).high
