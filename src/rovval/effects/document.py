"""docs/effects.md, written out of the effects: ``python -m rovval.effects.document > docs/effects.md``."""

from __future__ import annotations

import sys
from collections.abc import Iterable

from rovval import effects
from rovval.effects.effect import GROWS, Effect, Parameter, Place
from rovval.effects.literature import REFERENCES, key

PLACES: dict[Place, tuple[str, str]] = {
    "vehicle": ("The vehicle", "A number of the vehicle's file differs."),
    "input": ("Thrusters", "What acts differs from the thruster speed that was logged, or from what that speed should give."),
    "water": ("The water", "The water moves."),
    "wrench": ("Forces", "A force is missing."),
    "sensor": ("Sensors and clocks", "The log, not the world, is off."),
}
HEAD = """# Effects

What can be wrong with a nominal simulator of an underwater vehicle: the library that `rovval diagnose` searches and that `rovval simulate --effect`
applies. Written by `python -m rovval.effects.document` out of the files in `src/rovval/effects/library`; change those.

Body axes point forward, to starboard and down; the world's frame is north-east-down; SI units and radians. An arrow `<-` reads "is replaced by".
Every parameter changes nothing at its *null*. *Typical* is the size that a cause is expected to have, one standard deviation; *tolerance* what a healthy
vehicle or sensor may be off by, one standard deviation; c stands for the relative calibration tolerance (`--calibration-slop`, 0.05 by default). A range
and typical size that go "times" a quantity are those of a BlueROV2, and are in proportion to that quantity on another vehicle. References stand at the
end; "chosen" is a judgement of the authors."""


def text() -> str:
    """The whole document, Markdown."""
    every = [effects.load(name) for name in effects.names()]
    parts = [HEAD, "\n".join(_contents(every))]
    for place, (title, meaning) in PLACES.items():
        parts += [f"## {title}", meaning, *(_section(e) for e in every if e.place == place)]
    cited = {key(c) for e in every for c in e.literature}
    parts += ["## References", "\n".join(f"- **{name}**: {reference}" for name, reference in REFERENCES.items() if name in cited | _in_sources(every))]
    return "\n\n".join(parts) + "\n"


def _in_sources(every: Iterable[Effect]) -> set[str]:
    """References that the sources of numbers name."""
    sources = " ".join(f"{p.source} {p.tolerance.source if p.tolerance else ''}" for e in every for p in e.parameters)
    return {name for name in REFERENCES if name in sources}


def _contents(every: list[Effect]) -> list[str]:
    """One line a place, with links to its effects."""
    return [f"- {title}: " + ", ".join(f"[{e.name}](#{e.name})" for e in every if e.place == place) for place, (title, _) in PLACES.items()]


def _section(effect: Effect) -> str:
    """One effect."""
    per = {"": "", "axis": f" One for each axis ({', '.join(effect.axes)}){_together(effect)}.", "thruster": " One for each thruster."}[effect.per]
    named = f" {effect.unnamed[0].upper()}{effect.unnamed[1:]}." if effect.unnamed else ""
    needs = f" Needs {', '.join(f'`{c}`' for c in effect.needs)} in the log." if effect.needs else ""
    needs += f" Needs one of {', '.join(f'`{c}`' for c in effect.needs_one_of)} in the log." if effect.needs_one_of else ""
    parts = [
        f"### {effect.name}",
        f"**{effect.title}.**{per}{needs}{named}",
        f"```\n{_wrapped(effect.equation)}\n```",
        "\n".join(f"- `{symbol}`: {meaning}" for symbol, meaning in effect.symbols.items()),
        _parameters(effect.parameters),
        f"*What one sees*: {effect.signature}.",
        f"*Confused with*: {', '.join(f'[{n}](#{n})' for n in effect.confused_with)}. *What separates them*: {effect.separates}.",
        "*Literature*: " + "; ".join(effect.literature) + ".",
    ]
    return "\n\n".join(parts)


def _together(effect: Effect) -> str:
    """Its groups of axes."""
    return "".join(f", and `{group}` for {', '.join(members)} as one" for group, members in effect.groups.items())


def _wrapped(words: str, width: int = 120) -> str:
    """Lines of at most ``width`` characters."""
    lines = [""]
    for word in words.split(" "):
        if lines[-1] and len(lines[-1]) + 1 + len(word) > width:
            lines.append("")
        lines[-1] += f" {word}" if lines[-1] else word
    return "\n".join(lines)


def _parameters(parameters: Iterable[Parameter]) -> str:
    """The table of an effect's parameters."""
    head = "| parameter | unit | range | null | typical | tolerance | source |\n|---|---|---|---|---|---|---|"
    return "\n".join([head, *(_row(p) for p in parameters)])


def _row(p: Parameter) -> str:
    name = f"`{p.name}`" + (f" of [{p.target}]" if p.target else "")
    sized = f", times {GROWS[p.sized]}" if p.sized else ""
    cells = (name, p.unit, f"{p.low:g} to {p.high:g}{sized}", f"{p.null:g}", f"{p.typical:g}", _tolerance(p), p.source)
    return "| " + " | ".join(cells) + " |"


def _tolerance(p: Parameter) -> str:
    t = p.tolerance
    if t is None:
        return "none"
    size = "by the vehicle" if callable(t.sd) else f"{t.sd:g} c".replace("1 c", "c", t.sd == 1.0) if t.calibrated else f"{t.sd:g}"
    return f"{size}: {t.source}"


if __name__ == "__main__":
    sys.stdout.write(text())
