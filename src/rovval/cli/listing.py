"""`rovval list` and `rovval show`: what there is, and what stands in it."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rovval.cli import complete, options, output
from rovval.core.errors import UsageProblem

if TYPE_CHECKING:
    from rovval.effects import Effect

AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")


class Kind(StrEnum):
    """What can be listed."""

    vehicle = "vehicle"
    platform = "platform"
    effect = "effect"
    profile = "profile"
    metric = "metric"
    run = "run"


def _names_of_kind(ctx: typer.Context, incomplete: str) -> list[str]:
    return complete.named(str(ctx.params.get("kind", "")), incomplete)


def list_command(
    kind: Annotated[Kind, typer.Argument(help="What to list.")],
    archive: options.ArchiveOption = Path("archive"),
    where: Annotated[
        str, typer.Option("--where", metavar="SQL", help="Of the archive's catalogue, the runs for which this holds: SQL over its columns.")
    ] = "",
    since: Annotated[datetime | None, typer.Option("--since", help="Of the archive's catalogue, the runs that began since then (UTC).")] = None,
    json_: options.JsonFlag = False,
) -> None:
    """List vehicles, platforms, effects, profiles, metrics, or the archive's runs; with --where or --since, what batches found of them.

    \b
    Example:
      rovval list effect
      rovval list run --archive /data/archive --json
      rovval list run --where "vehicle = 'merlin' and surge > 0.1"
    """
    if where or since:
        if kind is not Kind.run:
            raise UsageProblem(f"--where and --since ask for runs, not for a {kind.value}", "write `rovval list run --where ...`")
        _say_runs(archive, where, since, json_)
        return
    names = _names(kind, archive)
    if json_:
        output.result_json(names)
    elif names:
        output.result("\n".join(names))
    else:
        output.say(f"no {kind.value} in {archive}" if kind is Kind.run else f"no {kind.value}")


def _say_runs(archive: Path, where: str, since: datetime | None, as_json: bool) -> None:
    """Rows of the catalogue: every column as JSON, the most asked for as a table."""
    from rovval.report.runs import documents, table
    from rovval.storage import catalogue

    rows = catalogue.find(archive, where, since)
    if as_json:
        output.result_json(documents(rows))
    elif rows:
        output.result(table(rows))
    else:
        output.say(f"no such run in the catalogue of {archive}, which `rovval run` keeps")


def show_command(
    kind: Annotated[Kind, typer.Argument(help="What kind of thing.")],
    name: Annotated[
        str, typer.Argument(help="Its name, or a path to a TOML file of one's own.", autocompletion=_names_of_kind)
    ],
    start: options.FromOption = None,
    end: options.ToOption = None,
    archive: options.ArchiveOption = Path("archive"),
    json_: options.JsonFlag = False,
) -> None:
    """Show one vehicle, platform, effect, profile, metric or run. A vehicle or profile is printed as TOML, to copy and to change; --from and
    --to are a run's.

    \b
    Example:
      rovval show vehicle merlin > my_vehicle.toml
      rovval show effect inflow_loss
      rovval show run RUN --json
      rovval show run RUN --from 60 --to 120
    """
    if kind is not Kind.run and not (start is None and end is None):
        raise UsageProblem(f"--from and --to cut a run, not a {kind.value}", "write `rovval show run RUN --from S --to S`")
    shown = {Kind.vehicle: _vehicle, Kind.platform: _platform, Kind.effect: _effect, Kind.profile: _profile, Kind.metric: _metric}
    text, document = _run(name, archive, start, end) if kind is Kind.run else shown[kind](name)
    output.result_json(document()) if json_ else output.result(text.rstrip("\n"))


def _names(kind: Kind, archive: Path) -> list[str]:
    if kind is Kind.run:
        from rovval.storage.archive import run_ids

        return [str(run) for run in run_ids(archive)]
    return complete.known(kind.value)


Shown = tuple[str, Callable[[], Any]]


def _vehicle(name: str) -> Shown:
    from rovval import vehicle
    from rovval.vehicle.audit import uncontrolled_axes

    loaded = vehicle.load(name)
    path = Path(name) if name.endswith(".toml") else vehicle.LIBRARY / f"{name}.toml"
    free = ", ".join(uncontrolled_axes(loaded)) or "none"
    output.say(
        f"weight {loaded.weight:.1f} N, buoyancy {loaded.buoyancy:.1f} N; "
        f"axes that the thrusters cannot push alone: {free}; hash {loaded.hash}"
    )
    return path.read_text(encoding="utf-8"), lambda: loaded.model_dump(mode="json") | {"hash": loaded.hash}


def _platform(name: str) -> Shown:
    from rovval.plant import platforms

    platform = platforms.load(name)
    lists = {"leaves out": platform.leaves_out, "assumed, for want of a printed figure": platform.assumed}
    lines = [f"{name}: {platform.title}", f"equations: {platform.equations}", f"source: {platform.source}"]
    lines += [line for head, items in lists.items() if items for line in (f"{head}:", *(f"  - {item}" for item in items))]
    document = {"name": name} | {k: getattr(platform, k) for k in ("title", "equations", "source")}
    return "\n".join(lines), lambda: document | {"leaves_out": list(platform.leaves_out), "assumed": list(platform.assumed)}


def _profile(name: str) -> Shown:
    from rovval.ingest import profile

    loaded = profile.load_profile(name)
    path = profile.FOLDER / f"{name}.toml"
    text = (path if path.is_file() else Path(name)).read_text(encoding="utf-8")
    return text, lambda: loaded.model_dump(mode="json")


def _effect(name: str) -> Shown:
    from rovval import effects
    from rovval.effects.effect import GROWS

    effect = effects.load(name.partition("[")[0])  # reports name it with its axis or thruster
    lines = [f"{effect.name}: {effect.title}", f"enters at: {effect.place}", f"equation: {effect.equation}"]
    lines += [f"  {symbol}: {meaning}" for symbol, meaning in effect.symbols.items()] + ["", "parameters"]
    lines += [
        f"  {p.target and f'[{p.target}] '}{p.name} [{p.unit}]  {p.low:g} to {p.high:g}, null {p.null:g}, typical {p.typical:g}"
        f"{p.sized and f' on a BlueROV2, in proportion to {GROWS[p.sized]} on another vehicle'} ({p.source})"
        for p in effect.parameters
    ]
    target = {"axis": (*(effect.axes or AXES), *effect.groups), "thruster": ("THRUSTER",), "": ()}[effect.per]
    lines += [f"  [{group}]: {', '.join(members)} as one" for group, members in effect.groups.items()]
    first = {p.target or next(iter(target), ""): p.name for p in reversed(effect.parameters)}  # one use a hypothesis
    uses = [f"--effect '{effect.name}{on and f'[{on}]'}:{first[on]}=VALUE'" for on in reversed(first)]
    lines += [
        "",
        f"signature: {effect.signature}",
        f"confused with: {', '.join(effect.confused_with) or 'none'}",
        f"what separates it: {effect.separates}",
        f"literature: {'; '.join(effect.literature)}",
    ]
    lines += [f"needs: {', '.join(effect.needs)}"] if effect.needs else []
    lines += [f"needs one of: {', '.join(effect.needs_one_of)}"] if effect.needs_one_of else []
    lines += [effect.unnamed] if effect.unnamed else []
    lines += ["", "use: " + ", ".join(uses) + (f"  (per {effect.per}: {', '.join(target)})" if target else "")]
    return "\n".join(lines), lambda: _effect_document(effect)


def _effect_document(effect: Effect) -> dict[str, Any]:
    plain = ("name", "title", "place", "equation", "signature", "separates", "per")
    listed = ("confused_with", "axes", "needs", "needs_one_of", "literature")
    numbers = ("name", "unit", "low", "high", "null", "typical", "source", "target")
    document: dict[str, Any] = {k: getattr(effect, k) for k in plain} | {k: list(getattr(effect, k)) for k in listed}
    return document | {"symbols": dict(effect.symbols), "parameters": [{k: getattr(p, k) for k in numbers} for p in effect.parameters]}


def _metric(name: str) -> Shown:
    from rovval.comparison import metrics

    metric = metrics.get(name)
    units = ", ".join(f"{metric.unit_of(u)} for {u}" for u in ("m/s", "rad/s", "rad"))
    text = f"{metric.name}: {metric.title}\n\n{metric.meaning}\n\nunit: {units}"
    return text, lambda: {"name": metric.name, "title": metric.title, "unit": metric.unit, "meaning": metric.meaning}


def _run(name: str, archive: Path, start: str | None, end: str | None) -> Shown:
    from rovval.alignment.stretch import stretch_of
    from rovval.storage.archive import open_run

    run = stretch_of(open_run(name, None, archive), start, end)
    document: dict[str, Any] = {
        "id": run.id,
        "source": run.source,
        "sha256": run.sha256,
        "profile": run.profile,
        "vehicle": run.vehicle,
        "seconds": run.duration_s,
        "rate_hz": 1.0 / run.dt,
        "channels": {
            n: {"method": r.method, "coverage": r.coverage, "largest_gap_s": r.largest_gap_s} for n, r in run.resampled.items()
        },
        "clock": {
            "stamp": run.clock.stamp,
            "samples": run.clock.samples,
            "matched": run.clock.matched,
            "largest_gap_s": run.clock.largest_gap_s,
            "offset_s": run.clock.offset_s,
            "correlation": run.clock.correlation,
            "note": run.clock.note,
        },
        "findings": [str(f) for f in run.findings],
        "markers": [{"t_s": m.t_s, "name": m.name} for m in run.markers],
        "properties": dict(run.properties),
    }
    lines = [f"{k:<10} {document[k]}" for k in ("id", "source", "sha256", "profile", "vehicle", "seconds", "rate_hz")]
    lines += [f"{'clock':<10} " + ", ".join(f"{k} {v}" for k, v in document["clock"].items() if v not in (None, ""))]
    lines += ["", f"{'channel':<16} {'to the grid':<12} {'coverage':>9} {'largest gap':>12}"]
    lines += [f"{n:<16} {r.method:<12} {100 * r.coverage:8.1f}% {r.largest_gap_s:10.2f} s" for n, r in run.resampled.items()]
    lines += ["", *(f"finding: {f}" for f in document["findings"])] if document["findings"] else []
    lines += ["", *(f"marker: {m.t_s:g} s {m.name}" for m in run.markers)] if run.markers else []
    lines += [f"{k}: {v}" for k, v in document["properties"].items()]
    return "\n".join(lines), lambda: document
