"""A pipeline file: which logs, which vehicle and profile, which steps, which tolerances. Checked whole before anything runs."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, PlainValidator, ValidationError, field_validator

from rovval.core.errors import RovvalError, UsageProblem, all_at_once
from rovval.pipeline import tolerances
from rovval.plant.platforms import USUAL
from rovval.plant.platforms import names as platforms
from rovval.storage import places

Place = Annotated[Path, PlainValidator(places.place)]
Step = Literal["ingest", "simulate", "compare", "diagnose"]
STEPS: tuple[Step, ...] = ("ingest", "simulate", "compare", "diagnose")


class Strict(BaseModel):
    """Immutable, and a misspelt key is an error rather than ignored."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Source(Strict):
    """Logs of one kind. Patterns are globs relative to the pipeline file; ``vehicle`` "" is the one that the profile names."""

    logs: Annotated[tuple[str, ...], Field(min_length=1, description="globs of log files, bag folders or dive files, or `s3://bucket/prefix/*.csv`")]
    profile: str | None = Field(None, description="name of `rovval list profile`, or a TOML file; without it the one that fits each log")
    vehicle: str = Field("", description="name of `rovval list vehicle`, or a TOML file; without it the one that the profile names")

    @field_validator("logs")
    @classmethod
    def _readable(cls, patterns: tuple[str, ...]) -> tuple[str, ...]:
        for pattern in patterns:
            places.place(pattern)
        return patterns


class Pipeline(Strict):
    """Folders are relative to the file, so that it works from any working directory (cron has its own)."""

    name: str = Field(description="of the batch, in its reports and in the catalogue")
    source: Annotated[tuple[Source, ...], Field(min_length=1, description="the logs, one table a kind of them")]
    steps: Annotated[tuple[Step, ...], Field(min_length=1)] = Field(
        ("ingest", "simulate", "compare"), description="what is done with each log; `diagnose` is the long one"
    )
    archive: Place = Field(Path("../archive"), description="where runs are kept: a folder, or `s3://bucket/prefix`")
    reports: Place = Field(Path("../reports"), description="where pages, records and the summary are written: a folder, or `s3://bucket/prefix`")
    model: str = Field(USUAL, description="platform whose simulator is judged")
    effects: tuple[str, ...] = Field((), description="settings such as `inflow_loss:loss=0.3` that the simulator is given")
    window_s: Annotated[float, Field(ge=0.5)] = Field(10.0, description="length of the restarted windows")
    calibration_slop: Annotated[float, Field(ge=0, le=0.5)] = Field(
        0.05, description="relative standard deviation that a healthy simulator's coefficients may have"
    )
    workers: Annotated[int, Field(ge=1, le=1024)] | None = Field(None, description="processes; without it one a core")
    timeout_s: Annotated[float, Field(gt=0)] | None = Field(None, description="a log that takes longer is set aside; without it none is")
    settle_s: Annotated[float, Field(ge=0)] = Field(0.0, description="a log that changed so shortly ago is still being copied, and waits for the next run")
    tolerances: tuple[str, ...] = Field((), description='limits on errors, `AXIS[.METRIC]=VALUE` of the free run or `window.AXIS.METRIC=VALUE`, in SI, '
        "and `trend.AXIS=SIGMAS` against the vehicle's 20 dives before; one that is exceeded makes exit code 1")  # fmt: skip
    recordings: bool = Field(
        False, description="whether the reports have a recording for the viewer, two thirds of their bytes; `rovval view` makes one of any run"
    )
    most_redone: Annotated[int, Field(ge=0)] | None = Field(
        None, description="how many logs that older code of rovval has judged are judged anew a night, the newest first; without it all"
    )
    keep_replaced_days: Annotated[float, Field(ge=0)] | None = Field(
        None, description="how long the reports on a log's former content stay after it changed; without it for ever"
    )

    @field_validator("tolerances")
    @classmethod
    def _parsed(cls, texts: tuple[str, ...]) -> tuple[str, ...]:
        try:
            tolerances.parse(tolerances.of_one_run(texts))
            tolerances.parse_trends(texts)
        except UsageProblem as problem:
            raise ValueError(problem.message) from None
        return texts

    @field_validator("model")
    @classmethod
    def _platform(cls, model: str) -> str:
        if model not in platforms():
            raise ValueError(f"no platform of that name: use one of {', '.join(platforms())}")
        return model

    @field_validator("steps")
    @classmethod
    def _in_order(cls, steps: tuple[Step, ...]) -> tuple[Step, ...]:
        return tuple(step for step in STEPS if step in steps)


def load(path: Path) -> Pipeline:
    """The pipeline of a TOML file with its folders made absolute; every problem is named at once (UsageProblem)."""
    if not path.is_file():
        raise UsageProblem(f"pipeline file {path} does not exist", "pipelines/nightly.toml is one to copy")
    try:
        pipeline = Pipeline.model_validate(tomllib.loads(path.read_text(encoding="utf-8")))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise UsageProblem(f"{path} is not TOML: {error}", "mend the line that is named") from None
    except ValidationError as error:
        lines = [_problem(e) for e in error.errors()]
        raise UsageProblem(all_at_once(lines, str(path)), "compare with pipelines/nightly.toml") from None
    base = path.resolve().parent
    sources = tuple(
        s.model_copy(update={"vehicle": _path(s.vehicle, base), "profile": s.profile and _path(s.profile, base)})
        for s in pipeline.source
    )
    pipeline = pipeline.model_copy(
        update={"archive": places.below(base, pipeline.archive), "reports": places.below(base, pipeline.reports), "source": sources}
    )
    if problems := _unknown(pipeline):
        raise UsageProblem(all_at_once(problems, str(path)), "see `rovval list vehicle|profile`")
    return pipeline


def _problem(error: Any) -> str:
    got = "" if error["type"] == "missing" else f" (is {error['input']!r:.60})"
    return f"{'.'.join(map(str, error['loc']))}: {error['msg']}{got}"


def _path(name: str, base: Path) -> str:
    return str(base / name) if name.endswith(".toml") else name


def _unknown(pipeline: Pipeline) -> list[str]:
    """Vehicles and profiles that do not load, before the first log is touched."""
    from rovval import vehicle
    from rovval.ingest.profile import load_profile

    problems = []
    for number, source in enumerate(pipeline.source):
        for loader, name in ((vehicle.load, source.vehicle), (load_profile, source.profile)):
            try:
                if name:
                    loader(name)
            except RovvalError as error:
                problems.append(f"source.{number}: {error.message}")
    return problems
