"""A result as one page that a notebook shows and a file keeps: nothing is fetched, nothing lies beside it."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from rovval.core.channels import AXES, POSE, VELOCITIES, channel
from rovval.core.counts import counted
from rovval.core.data import Array, Comparison, Run, SimResult
from rovval.core.units import in_degrees
from rovval.report import fit
from rovval.report.common.files import write_all
from rovval.report.common.numbers import duration, number
from rovval.report.common.page import render
from rovval.report.common.versions import foot
from rovval.report.drawings import curves
from rovval.report.drawings.curves import Place
from rovval.report.drawings.hues import hues

HEIGHT_PX = 720  # of the page in a notebook's cell; it scrolls


@dataclass(frozen=True, slots=True)
class Page:
    """A self-contained HTML page. ``html`` is the whole document."""

    html: str

    def _repr_html_(self) -> str:
        """What a notebook shows: the page in a frame of its own, so that neither's style touches the other's."""
        return f'<iframe srcdoc="{escape(self.html)}" style="width:100%;height:{HEIGHT_PX}px;border:0"></iframe>'

    def save(self, path: str | Path) -> Path:
        """Write the page, whole or not at all; returns where it lies."""
        place = Path(path)
        return write_all(place.parent, {place.name: self.html})[place.name]


def page_of(result: object) -> Page:
    """The page of a `Run`, `SimResult`, `Comparison`, `Diagnosis`, `FitResult` or `Flight`; raises `TypeError` for anything else."""
    from rovval.diagnose import Diagnosis
    from rovval.fit import FitResult
    from rovval.fly.flight import Flight
    from rovval.report.comparison import html as comparison_html
    from rovval.report.diagnosis import html as diagnosis_html
    from rovval.report.diagnosis.json import worded
    from rovval.report.flight import html as flight_html

    match result:
        case Comparison():
            return Page(comparison_html.text(result, recording=False))
        case Diagnosis():
            return Page(diagnosis_html.text(worded(result)))
        case FitResult():
            return Page(fit.html(result.document))
        case SimResult():
            return Page(_simulation(result))
        case Flight():
            return Page(flight_html.text(result))
        case Run():
            return Page(_run(result))
        case _:
            raise TypeError(f"no page of a {type(result).__name__}: give what load, simulate, compare, diagnose, fit or fly returned")


def _run(run: Run) -> str:
    """Every channel of the log, with gaps where it holds nothing."""
    shown = {name: (channel(name).unit, [curves.series("measured", name, _drawn(run.get(name), channel(name).unit))]) for name in run.values}
    facts = {"vehicle": run.vehicle, "profile": run.profile, "length": duration(run.duration_s)}
    banner = f"SYNTHETIC DATA: {run.properties['synthetic']}" if "synthetic" in run.properties else ""
    said = [f"{counted(len(run.values), 'channel')} at {number(1.0 / run.dt)} Hz."]
    return _curves("Log", run.id, banner, said, facts, shown, len(run), run.dt, [str(finding) for finding in run.findings])


def _simulation(sim: SimResult) -> str:
    """Velocities and pose, free and in windows, and the thruster speeds that drove them."""
    shown: dict[str, tuple[str, list[dict[str, Any]]]] = {}
    for names, free, windowed in ((VELOCITIES, sim.free.nu, sim.windowed.nu), (POSE, sim.free.eta, sim.windowed.eta)):
        titles = AXES if names is VELOCITIES else names
        for j, (title, name) in enumerate(zip(titles, names, strict=True)):
            unit = channel(name).unit
            pair = (("free", "free run", free), ("windowed", "windows", windowed))
            shown[title] = (unit, [curves.series(key, label, _drawn(values[:, j], unit)) for key, label, values in pair])
    speeds = zip(sim.thrusters, sim.thruster_speed.T * 60.0, hues(len(sim.thrusters)), strict=True)
    shown["thruster speed"] = ("rpm", [curves.series("thruster", name, values, hue=hue) for name, values, hue in speeds])
    facts = {"vehicle": sim.vehicle, "model": sim.model, "effects": ", ".join(sim.effects), "driven by": sim.input_source}
    said = [f"Free run, and windows of {number(sim.window_s)} s restarted from the measured state."]
    notes = [*sim.assumptions, *sim.stops]
    return _curves("Simulation", sim.run_id, "", said, facts, shown, len(sim.free.ok), sim.dt, notes)


def _curves(
    eyebrow: str, name: str, banner: str, said: list[str], facts: dict[str, str],
    shown: dict[str, tuple[str, list[dict[str, Any]]]], n: int, dt: float, notes: list[str],
) -> str:  # fmt: skip
    """A page of curves on one axis of ``n`` samples every ``dt`` s; ``shown`` maps a title to unit and curves."""
    drawn = [curves.plot(f"c{k}", series) for k, (_, series) in enumerate(shown.values())]
    places = [Place(f"c{k}", title, in_degrees(1.0, unit)[1], css="short") for k, (title, (unit, _)) in enumerate(shown.items())]
    return render(
        "curves.html",
        {"x": {"run": curves.times(n, dt)}, "plots": drawn},
        title=f"{name} · rovval",
        eyebrow=eyebrow,
        name=name,
        banner=banner,
        said=said,
        facts=facts,
        places=places,
        notes=notes,
        footer=foot(),
    )


def _drawn(values: Array, unit: str) -> Array:
    """Angles and rates in degrees, as every page shows them."""
    return np.asarray(values * in_degrees(1.0, unit)[0])
