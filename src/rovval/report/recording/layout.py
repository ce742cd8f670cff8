"""What the viewer shows when a recording is opened: 3-D beside the curves, the whole run in view."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from rovval.core.channels import AXES
from rovval.core.data import Comparison
from rovval.report.comparison import words

GROUND = (16, 21, 27)  # of all views, as the page's in the dark: the viewer may be light, and the measured motion is white
NONE: Mapping[str, str] = MappingProxyType({})
EYE = (-1.6, -1.4, -1.1)  # of the vehicle's longest side: from astern, to port and above, with room for its arrows (chosen)


def blueprint(comparison: Comparison, body: str, corrected: bool, longest: float, diagnosed: bool = False, pictures: Mapping[str, str] = NONE) -> Any:
    """World, vehicle with its thrusts (the ``body`` that they are drawn on, ``longest`` m) and notes left; the curves in tabs right, and ``pictures``
    by their topics, each the entity that they stand in."""
    import rerun.blueprint as rrb

    c = comparison
    measured = [a for a in AXES if a not in c.not_measured]
    velocities = [_curves(f"/velocity/{a}", a if a in measured else f"{a} (not measured)") for a in AXES]
    tabs: list[Any] = [
        rrb.Grid(*velocities, grid_columns=2, name="Velocities"),
        rrb.Grid(*[_curves(f"/error/{a}", f"{a} error") for a in measured], grid_columns=2, name="Errors"),
    ]
    if c.pose:
        titles = [words.TITLES[n] for n in c.pose]
        pose = [_curves(f"/pose/{t.replace(' ', '_')}", t) for t in titles]
        tabs.append(rrb.Grid(*pose, grid_columns=1, name="Depth and attitude"))
    if c.sim.thrusters:
        thrusters = [_curves("/thruster/speed", "speed, rpm"), _curves("/thruster/force", "force, N")]
        tabs.append(rrb.Vertical(*thrusters, name="Thrusters"))
    if pictures:
        views = [rrb.Spatial2DView(origin=place, name=topic) for topic, place in pictures.items()]
        tabs.append(rrb.Grid(*views, name="Pictures"))
    if diagnosed:
        lanes = rrb.StateTimelineView(origin="/state", name="What holds when", time_view=_whole_run())
        log = rrb.TextLogView(origin="/log", name="In words")
        forces = [_curves(f"/force/{a}", f"{a}: missing force") for a in measured]
        tabs = [rrb.Vertical(lanes, log, name="Diagnosis"), rrb.Grid(*forces, grid_columns=2, name="Missing force"), *tabs]
    third = ", corrected (green)" if corrected else ""
    tracks = "Measured (white), windows (orange), free run (blue)" if body == "measured" else "Free run (blue)"
    world = rrb.Spatial3DView(origin="/world", name=f"{tracks}{third}: north-east-down", background=GROUND)
    eye = rrb.EyeControls3D(position=[longest * x for x in EYE], look_target=(0.0, 0.0, 0.0), eye_up=(0.0, 0.0, -1.0))
    near = rrb.Spatial3DView(origin=f"/world/{body.replace(' ', '_')}", name=f"Thrusts on the vehicle ({body})", eye_controls=eye, background=GROUND)
    left = rrb.Vertical(world, near, rrb.TextDocumentView(origin="/notes", name="Notes"), row_shares=[5, 4, 2])
    return rrb.Blueprint(
        rrb.Horizontal(left, rrb.Tabs(*tabs, active_tab=0), column_shares=[2, 3]),
        rrb.TimePanel(timeline="run_time", state="collapsed"),
        rrb.SelectionPanel(state="hidden"),
        rrb.BlueprintPanel(state="collapsed"),
        auto_views=False,
    )


def _curves(origin: str, name: str) -> Any:
    """A plot of the whole run; the viewer's own default would show half a minute round the cursor."""
    import rerun.blueprint as rrb

    return rrb.TimeSeriesView(origin=origin, name=name, axis_x=_whole_run(), background=rrb.archetypes.PlotBackground(color=GROUND))


def _whole_run() -> Any:
    """An axis of all the time there is."""
    import rerun as rr
    import rerun.blueprint as rrb

    return rrb.TimeAxis(view_range=rr.TimeRange(start=rr.TimeRangeBoundary.infinite(), end=rr.TimeRangeBoundary.infinite()))
