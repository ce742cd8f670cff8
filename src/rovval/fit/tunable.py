"""The parameters that a fit may tune, by name, pattern or family."""

from __future__ import annotations

import re
from collections.abc import Sequence

from rovval import effects
from rovval.core.did_you_mean import near
from rovval.core.errors import UsageProblem, all_at_once
from rovval.plant import Plant


def families() -> dict[str, tuple[str, ...]]:
    """Effects by the name under which they are tuned together."""
    every = [effects.load(name) for name in effects.names()]
    return {family: tuple(e.name for e in every if e.family == family) for family in effects.FAMILIES}


def chosen(plant: Plant, parameters: Sequence[str]) -> tuple[int, ...]:
    """Slots that the names mean, in the plant's order.

    Raises:
        UsageProblem: names every unknown one with near matches, and those that are not a matter of tuning.
    """
    found, problems, of_family = set[int](), [], families()
    for asked in parameters:
        slots = [s for one in of_family.get(asked, (asked,)) for s in _meant(plant, one)]
        searched = sorted({plant.slots[s].hypothesis for s in slots if effects.load(plant.slots[s].effect).searched})
        if not slots:
            problems.append(f"{asked!r}: no such parameter{_near(plant, asked)}")
        elif searched:
            problems.append(f"{asked!r}: {', '.join(searched)} begins or turns at a place or time that is searched for, not tuned; see `rovval diagnose`")
        found.update(slots)
    if not parameters:
        problems.append("none was named")
    if problems:
        hint = f"`rovval list effect` has the names; families: {', '.join(of_family)}; * stands for any axis or thruster"
        raise UsageProblem(all_at_once(problems, "parameters to tune"), hint)
    return tuple(sorted(found))


def _meant(plant: Plant, one: str) -> list[int]:
    """Slots of a name or pattern; of a group of axes only where it is named as such, since its axes are there one by one."""
    pattern = re.compile(".*".join(re.escape(part) for part in one.split("*")))
    found = (i for i, s in enumerate(plant.slots) if any(pattern.fullmatch(name) for name in (s.key, s.hypothesis, s.effect)))
    named = (s.key for s in plant.slots), (s.hypothesis for s in plant.slots)
    by_name = any(one in names for names in named)
    return [i for i in found if by_name or plant.slots[i].target not in effects.load(plant.slots[i].effect).groups]


def _near(plant: Plant, asked: str) -> str:
    names = dict.fromkeys([*effects.FAMILIES, *(n for s in plant.slots for n in (s.effect, s.hypothesis, s.key))])
    close = near(asked, names)
    return f", perhaps {' or '.join(close)}" if close else ""
