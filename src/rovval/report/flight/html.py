"""A flight as one page (templates/flight.html): the answer, how set-points were held, the way seen from above, then the curves."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from rovval.core.channels import VELOCITIES
from rovval.core.data import Array
from rovval.fly.flight import Flight
from rovval.fly.mission import WayPoints
from rovval.fly.record import ASKED
from rovval.report.common.page import render
from rovval.report.common.versions import foot
from rovval.report.drawings import columns, curves
from rovval.report.drawings.curves import Place
from rovval.report.drawings.drawing import Curve, Dot, Drawing, Shape, Text
from rovval.report.flight.json import document
from rovval.report.flight.terminal import sentences

DEGREES = 180.0 / np.pi
SHOWN = {"z": ("depth", "m", 1.0), "altitude": ("altitude", "m", 1.0), "psi": ("heading", "deg", DEGREES), "u": ("speed ahead", "m/s", 1.0),
         "v": ("speed to starboard", "m/s", 1.0), "phi": ("roll", "deg", DEGREES), "theta": ("pitch", "deg", DEGREES)}  # fmt: skip
SIDE_PX, MARGIN_PX = 520.0, 46.0


def text(flight: Flight) -> str:
    """The page, self-contained."""
    drawn, places = _motion(flight)
    hues = {name: round(360 * j / len(flight.thrusters) + 15) % 360 for j, name in enumerate(flight.thrusters)}
    speeds = [curves.series("thruster", name, flight.speed[:, j] * 60.0, hue=hues[name]) for j, name in enumerate(flight.thrusters)]
    return render(
        "flight.html",
        {"x": {"run": curves.times(len(flight), flight.dt)}, "plots": [*drawn, curves.plot("thrusters", speeds)]},
        title=f"{flight.mission.name} · rovval flight",
        eyebrow="Mission flown",
        name=flight.mission.title or flight.mission.name,
        banner="SYNTHETIC: flown by the simulator, nothing was measured",
        said=sentences(flight),
        facts={"vehicle": flight.vehicle, "platform": flight.model, "effects": ", ".join(flight.effects), "seed": str(flight.seed),
               "vehicles drawn": str(flight.draws or "")},
        result=document(flight),
        keys=_keys(flight),
        chart=_chart(flight),
        places=places,
        thrusters=hues,
        thruster_places=[Place("thrusters", "thruster speed", "rpm", css="short")],
        legs=flight.phases,
        notes=[*flight.notes, *flight.stops],
        footer=foot(),
    )  # fmt: skip


def _keys(flight: Flight) -> dict[str, str]:
    """The curves by the name of their colour."""
    keys = {"measured": "set-point", "windowed": "true"} if flight.set_points else {"windowed": "true"}
    keys |= {"free": "as the filter has it"} if flight.on_sensors else {}
    return keys | ({"other": "5 % and 95 % of the vehicles drawn"} if flight.spread else {})


def _motion(flight: Flight) -> tuple[list[dict[str, Any]], list[Place]]:
    """Set-point, truth, what the filter believed and the spread, a picture a channel."""
    drawn, places, asked = [], [], {channel: flight.set_points[name] for name, channel in ASKED.items() if name in flight.set_points}
    truth, seen = _channels(flight.nu, flight.eta, flight.altitude), _channels(flight.seen_nu, flight.seen_eta, flight.seen_altitude)
    for channel, (title, unit, factor) in SHOWN.items():
        if channel not in truth:
            continue
        values, base = _followed(truth[channel], channel), truth[channel]
        lines = [curves.series("measured", "set-point", factor * _beside(asked[channel], base, values, channel))] if channel in asked else []
        for j, label in ((0, "5 %"), (2, "95 %")):
            if channel in flight.spread:
                lines.append(curves.series("other", label, factor * _beside(flight.spread[channel][j], base, values, channel)))
        if flight.on_sensors and channel in seen:
            lines.append(curves.series("free", "filter", factor * _beside(seen[channel], base, values, channel)))
        lines.append(curves.series("windowed", "true", factor * values))
        drawn.append(curves.plot(f"m-{channel}", lines))
        places.append(Place(f"m-{channel}", title, unit, css="short"))
    return drawn, places


def _channels(nu: Array, eta: Array, altitude: Array | None) -> Mapping[str, Array]:
    found = {n: nu[:, i] for i, n in enumerate(VELOCITIES)} | {n: eta[:, i] for i, n in enumerate(("x", "y", "z", "phi", "theta", "psi"))}
    return found | ({} if altitude is None else {"altitude": altitude})


def _followed(values: Array, channel: str) -> Array:
    """A heading without jumps at half a turn."""
    return np.unwrap(values) if channel == "psi" else values


def _beside(other: Array, base: Array, followed: Array, channel: str) -> Array:
    """Another heading drawn beside the followed one; everything else as it is."""
    return followed + np.angle(np.exp(1j * (other - base))) if channel == "psi" else other


def _chart(flight: Flight) -> Drawing:
    """The way seen from above, north up, with the way points and where the vehicle began and ended."""
    points = np.array([p for phase in flight.phases if isinstance(phase.leg, WayPoints) for p in phase.leg.points]).reshape(-1, 3)
    track = flight.eta[:: max(1, len(flight) // 1500), :2]
    both = np.concatenate([track, points[:, :2]])
    middle, span = 0.5 * (both.min(axis=0) + both.max(axis=0)), max(float(np.ptp(both, axis=0).max()), 1.0)
    scale = (SIDE_PX - 2 * MARGIN_PX) / span

    def at(place: Array) -> tuple[float, float]:
        return (SIDE_PX / 2 + scale * float(place[1] - middle[1]), SIDE_PX / 2 - scale * float(place[0] - middle[0]))

    shapes: list[Shape] = [Curve((at(flight.eta[0]), *(at(p) for p in points)), "way")] if len(points) else []
    shapes.append(Curve(tuple(at(p) for p in track), "growth"))
    for number, p in enumerate(points, 1):
        x, y = at(p)
        shapes += [Dot(x, y, 4, "step"), Text(x + 7, y - 6, f"{number}", "b")]
    for words, place in (("begin", flight.eta[0]), ("end", flight.eta[-1])):
        x, y = at(place)
        shapes += [Dot(x, y, 3, "growth-mark"), Text(x + 7, y + (14 if words == "begin" else 27), words, "m")]
    shapes.append(Text(8, 16, f"north up; {span:.3g} m from edge to edge of the way", "m"))
    values = columns.along(flight.dt, {f"{way}, m": flight.eta[:, j] for j, way in enumerate(("north", "east", "down"))})
    return Drawing(SIDE_PX, SIDE_PX, "The way seen from above", tuple(shapes), values)
