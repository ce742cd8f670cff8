"""The comparison as one HTML file (templates/comparison.html): the answer first, then a table, then the curves, then what it rests on."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from rovval.comparison.tolerance import Tolerance
from rovval.core.channels import AXES
from rovval.core.data import Comparison
from rovval.report.common.numbers import number
from rovval.report.common.page import render
from rovval.report.common.versions import foot
from rovval.report.comparison import figures, residuals, tolerances, track, uncertainty, words
from rovval.report.drawings import curves


def text(comparison: Comparison, recording: bool = True, limits: Sequence[Tolerance] = (), links: Mapping[str, str] | None = None) -> str:
    """The page; ``recording`` says that run.rrd lies beside it, ``limits`` are the tolerances that were stated, ``links`` lead to pages that belong to it."""
    c, run = comparison, comparison.run
    velocity_curves, velocity_places = figures.velocities(c, limits)
    pose_curves, pose_places = figures.pose(c)
    thruster_curves, thruster_places, hues = figures.thrusters(c)
    track_curves, track_places = track.error(c)
    residual_axes, residual_curves, residual_places = residuals.drawn(c)
    judged = tolerances.rows(c, limits)
    return render(
        "comparison.html",
        {
            "x": {"run": curves.times(len(run), run.dt), **residual_axes},
            "plots": [*velocity_curves, *track_curves, *pose_curves, *thruster_curves, *residual_curves],
        },
        links,
        title=f"{run.id} · rovval comparison",
        eyebrow="Simulated against measured",
        name=run.id,
        banner=words.synthetic(c),
        said=[*words.sentences(c), *filter(None, [tolerances.sentence(judged)])],
        facts=words.facts(c),
        found=_counted(c),
        windows=words.windows(c),
        axes=_axes(c),
        not_measured=c.not_measured,
        no_velocity=words.NO_VELOCITY,
        notes=words.notes(c),
        unsure=uncertainty,
        intervals=uncertainty.interval_rows(c),
        validated=uncertainty.validation_rows(c),
        other=c.other,
        other_name=c.other_name,
        keys=_keys(c),
        drawn=_drawn(c),
        tolerated=judged,
        about_tolerances=tolerances.LEAD,
        velocities=velocity_places,
        plan=track.plan(c),
        about_track=track.LEAD,
        tracks=track_places,
        about_residuals=residuals.LEAD,
        residuals=residual_places,
        growth=figures.growth_panels(c),
        pose={words.TITLES[name]: row for name, row in c.pose.items()},
        poses=pose_places,
        thrusters=hues,
        thruster_places=thruster_places,
        clock=_clock(c),
        findings=run.findings,
        recording=recording,
        assumed=[*c.sim.assumptions, *c.sim.stops],
        footer=foot(f"sha256 {run.sha256[:16]}"),
    )


def _axes(c: Comparison) -> list[dict[str, Any]]:
    """Per axis the rows of free run and windows; empty where no velocity was measured."""
    if len(c.not_measured) == len(AXES):
        return []
    rows = []
    for axis in dict.fromkeys((*c.free, *c.windowed)):
        free, windowed = c.free.get(axis), c.windowed.get(axis)
        row = next(r for r in (free, windowed) if r is not None)
        told = windowed or row
        rows.append({"name": axis, "free": free, "windowed": windowed, "row": row, "motion": words.relative(told), "misleads": told.misleads})
    return rows


def _keys(c: Comparison) -> dict[str, str]:
    """The curves, by the name of their colour."""
    keys = {"measured": "measured", "windowed": f"simulated, {words.windows(c)}", "free": "simulated, free run"}
    return keys | ({"other": c.other_name} if c.other_nu is not None else {})


def _drawn(c: Comparison) -> str:
    """How the curves are drawn, and what one can do with them."""
    k = curves.bucket(len(c.run))
    thinned = "" if k == 1 else f" Drawn as the lowest and highest of every {k} rows ({number(k * c.run.dt)} s), so that peaks stay."
    mouse = "Drag to zoom into all of them, double-click for the whole run, press a name to hide its curve."
    return f"{mouse} By keys: arrows read, + and - zoom, 0 shows all. The strip under each plot is the error.{thinned}"


def _clock(c: Comparison) -> dict[str, str]:
    """What the time stamps are worth."""
    k = c.run.clock
    offset = "could not be had" if k.offset_s is None else f"{number(k.offset_s)} s (positive: navigation is stamped late)"
    return {
        "stamps taken from": f"{k.stamp} clock",
        "samples matched to the grid": f"{k.matched} of {k.samples}",
        "largest gap": f"{number(k.largest_gap_s)} s",
        "offset between thrusters and navigation": offset,
        "its correlation": "" if k.correlation is None else number(k.correlation),
        "note": k.note,
    }


def _counted(c: Comparison) -> dict[str, Any]:
    """How many findings there are and of which kinds; empty for none."""
    kinds = Counter(f.code.replace("_", " ") for f in c.run.findings)
    said = ", ".join(f"{kind} ({count})" if count > 1 else kind for kind, count in kinds.items())
    return {"count": kinds.total(), "kinds": said} if kinds else {}
