"""A flight, or the dry run of one, to be read in a terminal."""

from __future__ import annotations

from rovval.core.counts import counted
from rovval.core.data import Array
from rovval.fly.dry_run import DryRun
from rovval.fly.flight import Flight, Held
from rovval.report.common.numbers import duration, per_cent, quantity
from rovval.report.common.terminal import fitted
from rovval.report.flight.json import spread


def sentences(flight: Flight) -> list[str]:
    """What was flown and how well, in words."""
    loop = "on sensors through an INS-like filter" if flight.on_sensors else "on the true state"
    said = [f"{flight.vehicle} flew {flight.mission.name} for {duration((len(flight) - 1) * flight.dt)} on platform {flight.model}, its loop closed {loop}."]
    if flight.held:
        worst: dict[str, Held] = {}
        for h in flight.held:
            worst[h.quantity] = h if h.quantity not in worst or abs(h.error) > abs(worst[h.quantity].error) else worst[h.quantity]
        said.append("Largest errors at the end of a leg: " + ", ".join(f"{name} {quantity(abs(h.error), h.unit)}" for name, h in worst.items()) + ".")
    if flight.passed:
        said.append(f"Way points are passed within {quantity(max(p.distance for p in flight.passed), 'm')}.")
    if flight.draws:
        said.append(f"{flight.draws} vehicles within tolerance flew beside it, {flight.draws_stopped} left sane limits.")
    if (share := float(flight.saturated().mean())) > 0:
        said.append(f"The thrusters were at their limit in {per_cent(share)} of the time.")
    return [*said, *(f"Stopped: {stop}." for stop in flight.stops)]


def text(flight: Flight) -> str:
    """Sentences, then a line for each set-point and way point; with draws the 5 % and 95 % quantiles of its error over them."""
    lines = sentences(flight)
    if flight.held:
        lines += ["", f"{'leg':<13}{'set-point':<10}{'asked':>11}{'step':>12}{'error at end':>13}{'overshoot':>12}{'settled':>9}" + _head(flight)]
    for h in flight.held:
        settled = "-" if h.settled_s is None or abs(h.step) < 1e-3 else f"{h.settled_s:.1f} s"
        values = (quantity(h.set_point, h.unit), quantity(h.step, h.unit, 2), quantity(h.error, h.unit, 2), quantity(h.overshoot, h.unit, 2))
        asked, step, error, over = values
        lines.append(f"{h.leg:<13}{h.quantity:<10}{asked:>11}{step:>12}{error:>13}{over:>12}{settled:>9}" + _draws(h.draws, h.unit))
    if flight.passed:
        lines += ["", f"{'leg':<14}{'way point (north, east, depth)':<34}{'passed within':>14}{'at':>10}" + _head(flight)]
    for p in flight.passed:
        point = ", ".join(f"{c:g}" for c in p.point)
        lines.append(f"{p.leg:<14}{point:<34}{quantity(p.distance, 'm'):>14}{p.at_s:>8.1f} s" + _draws(p.draws, "m"))
    return fitted("\n".join([*lines, *(f"note: {n}" for n in flight.notes)]))


def _head(flight: Flight) -> str:
    return f"   {'5 % to 95 % of draws':<24}" if flight.draws else ""


def _draws(values: Array | None, unit: str) -> str:
    found = spread(values)
    return "" if found is None else f"   {quantity(found['q05'], unit, 2)} to {quantity(found['q95'], unit, 2)}"


def dry_run_text(dry: DryRun) -> str:
    """The timeline, under each phase what it would exceed."""
    lines = [f"{dry.mission} on {dry.vehicle}: {duration(dry.duration_s)}, nothing was flown", ""]
    for e in dry.entries:
        lines.append(f"{e.start_s:8.1f} to {e.end_s:8.1f} s  {e.label:<16} {e.does}")
        lines += [f"{'':24}exceeds: {problem}" for problem in e.exceeds]
    return fitted("\n".join([*lines, "", f"{counted(len(dry.exceeds), 'thing')} would be exceeded" if dry.exceeds else "nothing would be exceeded"]))
