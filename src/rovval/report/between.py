"""Simulator against simulator, as text, as a page and as JSON: B minus A of each axis."""

from __future__ import annotations

from typing import Any

from rovval.comparison.between import RESOLUTION, ChannelDifference, Difference
from rovval.core.channels import AXES, POSE
from rovval.core.frames import wrap
from rovval.core.units import DEGREES, in_degrees, integral_unit
from rovval.report.common.markdown import grid
from rovval.report.common.numbers import MISSING, listed, number, per_cent
from rovval.report.common.page import render
from rovval.report.common.versions import foot
from rovval.report.drawings.chart import chart
from rovval.report.drawings.drawing import Drawing

CLAIM = 0.10  # thesis 6.1: "a 10% variation in ROV dynamics across the platforms"
PLATFORMS = ("fossen", "uuv")  # the thesis's two: its Simulink and its ROS model
LONGEST_LABEL = 20  # characters: two of them, and the axis, stand above a figure
FOOT = f"of A: integral of |B - A| over that of |A|; a tie: no difference above {RESOLUTION:g} of the fastest motion of its kind, the integration's accuracy"
HEAD = ("", "unit", "mean", "rms", "largest", "IAE", "of A", "rows", "")


def text(difference: Difference, what: str) -> str:
    """The table of ``what`` both were driven by, angles in degrees, and what it says of the thesis's claim."""
    d = difference
    rows = [HEAD, *lines(d)]
    widths = [max(len(r[j]) for r in rows) for j in range(len(HEAD))]
    aligned = ["  ".join(c.ljust(w) if j < 2 else c.rjust(w) for j, (c, w) in enumerate(zip(r, widths, strict=True))).rstrip() for r in rows]
    head = [f"{d.b.name} minus {d.a.name}: {what}", said(d), ""]
    return "\n".join([*head, *aligned, "", FOOT])


def markdown(difference: Difference, what: str) -> str:
    """The same as Markdown."""
    d = difference
    return "\n\n".join([f"# {d.b.name} minus {d.a.name}", what, said(d), grid(HEAD, lines(d), 2), FOOT]) + "\n"


def html(difference: Difference, what: str) -> str:
    """The same as one page, self-contained, with the figures."""
    a, b = difference.a, difference.b
    return render(
        "difference.html", title=f"{b.name} minus {a.name} · rovval", eyebrow="Simulator against simulator", name=f"{b.name} minus {a.name}", banner="",
        said=[said(difference)], facts={"driven by": what, "A": a.name, "B": b.name, "length": f"{(len(a.nu) - 1) * a.dt:g} s"},
        header=HEAD, rows=lines(difference), foot=FOOT, figures=figures(difference), footer=foot(),
    )  # fmt: skip


def figures(difference: Difference) -> dict[str, list[Drawing]]:
    """Drawings by their heading: each velocity of both and what lies between them, then the differences of the pose."""
    a, b = difference.a, difference.b
    velocities = []
    for j, axis in enumerate(AXES):
        if axis in difference.velocities:
            factor, unit = (1.0, "m/s") if j < 3 else (DEGREES, "deg/s")
            both = {_label("A", a.name): factor * a.nu[:, j], _label("B", b.name): factor * b.nu[:, j]}
            velocities += [chart(axis, unit, a.dt, both), chart(f"{axis}, B minus A", unit, a.dt, {"": factor * (b.nu[:, j] - a.nu[:, j])})]
    place = {name: b.eta[:, j] - a.eta[:, j] for j, name in enumerate(("north", "east", "down")) if POSE[j] in difference.pose}
    turn = {name: DEGREES * wrap(b.eta[:, 3 + j] - a.eta[:, 3 + j]) for j, name in enumerate(("roll", "pitch", "heading")) if POSE[3 + j] in difference.pose}
    pose = [chart(title, unit, a.dt, curves) for title, unit, curves in (("position", "m", place), ("attitude", "deg", turn)) if curves]
    return {title: drawings for title, drawings in (("Velocities", velocities), ("Pose, B minus A", pose)) if drawings}


def _label(letter: str, name: str) -> str:
    """A curve's name; a long one stands at the head of the page alone."""
    return f"{letter}: {name}" if len(name) <= LONGEST_LABEL else letter


def lines(difference: Difference) -> list[tuple[str, ...]]:
    """Its rows under `HEAD`, velocities by axis and then the pose, angles in degrees."""
    rows = (*difference.velocities.items(), *difference.pose.items())
    return [_cells(name, row) for name, row in rows]


def said(difference: Difference) -> str:
    """The answer in a sentence: a tie, or the axes that differ most, beside the thesis's 10 %."""
    d = difference
    if d.tie:
        return "A tie: the two move alike within the accuracy of the integration."
    moving = {axis: row.share for axis, row in d.velocities.items() if row.share is not None and not row.tie}
    if not moving:
        return "They differ, and A stands still on every axis that differs: there is no per cent of it."
    within = [axis for axis, share in moving.items() if share <= CLAIM]
    beyond = [f"{axis} ({per_cent(share)})" for axis, share in sorted(moving.items(), key=lambda item: -item[1]) if share > CLAIM]
    ties = [axis for axis, row in d.velocities.items() if row.tie]
    parts = [f"Within 10 %: {listed(within) or 'no axis'}", f"beyond: {listed(beyond) or 'no axis'}", *([f"tie: {listed(ties)}"] if ties else [])]
    sentence = "; ".join(parts) + "."
    if {d.a.name, d.b.name} == set(PLATFORMS):
        sentence += f" The thesis finds 10 % across its two platforms (6.1): here that {'does not hold' if beyond else 'holds'} on every axis that moves."
    return sentence


def document(difference: Difference, what: str) -> dict[str, Any]:
    """The machine-readable result: SI and radians, per axis and pose channel."""
    d = difference
    return {
        "schema": "rovval.between/1", "a": d.a.name, "b": d.b.name, "driven_by": what, "seconds": (len(d.a.nu) - 1) * d.a.dt, "tie": d.tie,
        "resolution": RESOLUTION, "axes": {axis: _row(row) for axis, row in d.velocities.items()},
        "pose": {name: _row(row) for name, row in d.pose.items()},
    }  # fmt: skip


def _row(row: ChannelDifference) -> dict[str, Any]:
    names = ("channel", "unit", "n", "mean", "iae", "rms", "largest", "share", "tie")
    return {name: getattr(row, name) for name in names} | {"per_cent": None if row.share is None else 100.0 * row.share}


def _cells(name: str, row: ChannelDifference) -> tuple[str, ...]:
    factor, unit = in_degrees(1.0, row.unit)
    numbers = [number(v * factor) for v in (row.mean, row.rms, row.largest)]
    whole = f"{number(row.iae * factor)} {integral_unit(unit)}"
    return (name, unit, *numbers, whole, MISSING if row.share is None else per_cent(row.share), str(row.n), "tie" if row.tie else "")
