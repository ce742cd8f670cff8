"""The folder of a sealed set, what lies where in it, and in which order things may happen to it.

make -> ``manifest.json``, the vehicle's file, ``labels.sealed``, ``logs/``; answer -> ``answers/``, then ``answers.sha256`` commits them; score ->
``opened.json`` first, then the labels are read. What was committed before the seal was opened is all that is ever scored.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rovval.blind.sealed.sealing import digest, digest_of_files
from rovval.core.code_version import source_hash
from rovval.core.errors import BadInput, UsageProblem
from rovval.storage.atomic import drafts

MANIFEST = "rovval.blind-set/1"
COMMIT = "rovval.blind-answers/1"
NOT_ENGINE = {"blind", "cli", "report", "pipeline", "demo", "fly"}


@dataclass(frozen=True, slots=True)
class Folder:
    """One set. Paths are functions of ``root``."""

    root: Path

    @property
    def logs(self) -> Path:
        """The logs, one CSV each."""
        return self.root / "logs"

    @property
    def answers(self) -> Path:
        """One JSON a log."""
        return self.root / "answers"

    @property
    def labels(self) -> Path:
        """The truth, sealed."""
        return self.root / "labels.sealed"

    @property
    def key(self) -> Path:
        """Where the key lies unless another place was given: beside the folder, not in it."""
        return self.root.with_name(self.root.name + ".key")

    @property
    def opened(self) -> Path:
        """There once the labels were read."""
        return self.root / "opened.json"

    @property
    def commit(self) -> Path:
        """Digest and time of the answers."""
        return self.root / "answers.sha256"

    def manifest(self) -> dict[str, Any]:
        """What the set is. Raises `UsageProblem` where there is none."""
        path = self.root / "manifest.json"
        if not path.is_file():
            raise UsageProblem(f"{self.root} holds no sealed set", f"make one: `rovval blind make {self.root}`")
        found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        if found.get("schema") != MANIFEST:
            raise BadInput(f"{path} is not a manifest of this version", "make the set again with this version of rovval")
        return found

    def vehicle(self) -> Path:
        """The vehicle's file as it was when the set was made: beside the logs, so that a set is whole wherever it is taken."""
        return self.root / str(self.manifest()["vehicle"])

    def check_logs(self) -> None:
        """Logs and labels are those that were sealed. Raises `BadInput` naming the first that is not."""
        manifest = self.manifest()
        if digest(self.labels) != manifest["labels_sha256"]:
            raise BadInput(f"{self.labels} is not what was sealed", "restore it, or make a new set")
        for name, row in manifest["logs"].items():
            path = self.logs / name
            if not path.is_file() or digest(path) != row["sha256"]:
                raise BadInput(f"{path} is missing or is not what was sealed", "restore it, or make a new set")

    def answer_files(self) -> list[Path]:
        """Answers that are there, whole."""
        return sorted(self.answers.glob("*.json"))

    def committed(self) -> dict[str, Any]:
        """What was committed. Raises `UsageProblem` where answers are missing and `BadInput` where they were changed since."""
        if not self.commit.is_file():
            raise UsageProblem(f"{self.root}: the answers are not committed", f"finish them: `rovval blind answer {self.root}`")
        found: dict[str, Any] = json.loads(self.commit.read_text(encoding="utf-8"))
        if digest_of_files(self.answer_files()) != found["sha256"]:
            raise BadInput(f"{self.answers} was changed after it was committed", "restore the answers that were committed")
        return found

    def refuse_if_opened(self) -> None:
        """No answers are made once the labels have been seen."""
        if self.opened.exists():
            when = json.loads(self.opened.read_text(encoding="utf-8"))["opened"]
            raise UsageProblem(
                f"{self.root}: the seal was opened at {when}; answers made now would not be blind",
                "make a new set: `rovval blind make DIR --seed N` with another seed",
            )


def write(path: Path, document: object) -> None:
    """A JSON file, whole or not at all."""
    with drafts(path) as [draft]:
        draft.write_text(json.dumps(document, indent=1, allow_nan=False) + "\n", encoding="utf-8")


def engine_hash() -> str:
    """Hash over the source of everything that an answer depends on."""
    return source_hash(NOT_ENGINE, (".py", ".toml"))
