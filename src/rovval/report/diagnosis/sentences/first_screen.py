"""What a reader sees first, in at most sixty words for one cause and ninety for two: what, where, which, how far, and what to do next."""

from __future__ import annotations

from typing import NamedTuple

from rovval.diagnose.result.diagnosis import Cause, Diagnosis
from rovval.report.common.numbers import listed, per_cent, probability, quantity
from rovval.report.diagnosis.sentences import no_cause
from rovval.report.diagnosis.sentences.plain import falls, falls_to, of_what, when
from rovval.report.diagnosis.sentences.words import alone, group, moved, parameter, shown_to_shrink, unmoved

MOST_VALUES = 2  # parameters of a cause that fit the first screen
COUNTED = {1: "One effect", 2: "Two effects", 3: "Three effects"}


class FirstScreen(NamedTuple):
    """The five answers; empty where there is none."""

    what: str
    where: str
    which: str
    how_far: str
    next: str


def first_screen(d: Diagnosis) -> FirstScreen:
    """The five answers of a diagnosis."""
    return FirstScreen(what(d), where(d), which(d), how_far(d), next_step(d))


def what(d: Diagnosis) -> str:
    """Whether there is a gap, and what makes it."""
    if d.verdict == "no_gap":
        return no_cause.nothing(d)
    if not d.causes:
        return no_cause.unknown(d)
    names = listed(of_what(c.effect) for c in d.causes)
    some = COUNTED.get(len(d.causes), f"{len(d.causes)} effects")
    verb, is_found, it = ("explain", "are found", "them") if len(d.causes) > 1 else ("explains", "is found", "it")
    if not shown_to_shrink(d):
        return f"{some} {is_found}, but the gap is not shown to shrink with {it}: {names}."
    if d.verdict == "explained":
        return f"{some} {verb} the gap: {names}."
    rest = f"acts in {d.left.axes[0]}" if d.left and d.left.axes else "is at work"
    return f"{some} {verb} part of the gap: {names}. Something else {rest}."


def where(d: Diagnosis) -> str:
    """The axis with the largest share of the gap, and when it is worst there."""
    if d.verdict == "no_gap" or not d.gap.axes:
        return "" if d.gap.axes else "Nothing was measured on any axis."
    axis = max(d.gap.axes, key=lambda one: d.gap.axes[one].share)
    at = next((f", most {when(one.regime)}" for one in d.gap.where if one.axis == axis), "")
    return f"{axis.capitalize()}: {per_cent(d.gap.axes[axis].share)} of the gap{at}."


def which(d: Diagnosis) -> str:
    """The causes with their values, and what this log does not tell from them; without any, what came nearest."""
    return " ".join(_cause(c) for c in d.causes) if d.causes else no_cause.nearest(d)


def how_far(d: Diagnosis) -> str:
    """How much of the error is left with the causes."""
    if not d.causes:
        return ""
    if unmoved(d.shrinkage):
        return f"The error stays as it is: {alone(d.causes[0])}."
    worst = max(d.causes[0].shrinkage.axes.items(), key=lambda item: item[1], default=("", 0.0))
    most = f" (that in {worst[0]} {falls(worst[1])})" if len(d.causes) == 1 and worst[1] > 2.0 * d.shrinkage.total > 0 else ""
    return f"The error {falls_to(d.shrinkage)}{most}{', checked on unused data' if d.shrinkage.held_out else ''}."


def next_step(d: Diagnosis) -> str:
    """What to do next; empty where there is nothing to do."""
    if plan := d.next_experiment:
        return f"Fly {d.manoeuvre.name if d.manoeuvre else plan.manoeuvre.rstrip('.')}: it tells them apart."
    if d.calibration:
        return "Calibrate the vehicle's file (the command stands below) and diagnose again with it."
    if d.causes and all(c.kind == "file" for c in d.causes):
        these, them = ("these numbers", "them") if len(d.causes) > 1 else ("this number", "it")
        return f"Correct {these} in the vehicle's file: `--write-vehicle FILE.toml` writes {them}."
    if d.causes:
        return "Write the mended vehicle with `--write-vehicle FILE.toml` and compare again."
    return no_cause.next_step(d)


def _cause(cause: Cause) -> str:
    """inflow_loss: loss = 0.302 [0.243, 0.361], probability 0.71, or tether_drag. Of several parameters the values alone."""
    told = list(moved(cause.parameters).items())
    values = [parameter(*told[0])] if len(told) == 1 else [f"{name} = {quantity(p.value, p.unit)}" for name, p in told[:MOST_VALUES]]
    onset = f" from {cause.onset_s:.0f} s on" if cause.onset_s is not None else ""
    others = f", or {listed(rest, 'or')}" if (rest := group(cause)[1:]) else ""
    return f"{cause.effect}{onset}: {', '.join([*values, f'probability {probability(cause.probability)}'])}{others}."
