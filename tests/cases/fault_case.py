"""Nights that are disturbed: a small archive, what an undisturbed batch leaves of it, and what a disturbed one may have left at any moment."""

from __future__ import annotations

import hashlib
import io
import json
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import batch_case
import polars as pl

from rovval.storage import places

LOGS = 4
CATALOGUE = "archive/catalogue"
TRENDS = "reports/.trends.json"
NIGHTLY = ("index.html", "summary.json")  # written anew each night, with its time
KEPT_APART = (".lock", ".locks", ".shared", ".hashes.json", ".damaged")  # of one place and time, or of no night
OF_THE_TIME = ("when", "evaluated", "digest")  # the last is a record's own, of all its steps
WRITTEN = 1767225600  # 2026-01-01
PATIENCE_S = 600.0  # a batch of `LOGS` logs takes some seconds; more than so long, and it hangs


class Night:
    """A pipeline whose logs it shares with other nights, and whose archive and reports are its own."""

    def __init__(self, folder: Path, logs: Path, steps: str = '["ingest"]', *lines: str) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self.folder = folder
        self.path = batch_case.write_pipeline(folder, *lines, steps=steps)
        self.path.write_text(self.path.read_text().replace('"logs/*.csv"', f'"{logs}/*.csv"'))

    def command(self, *args: str) -> list[str]:
        return [sys.executable, "-m", "rovval", "run", str(self.path), "--quiet", "--json", *args]

    def start(self, *args: str) -> subprocess.Popen[bytes]:
        """The night as cron starts it, the leader of a group of processes."""
        return subprocess.Popen(self.command(*args), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True)

    def whole(self, *args: str) -> int:
        """A night to its end; its exit code."""
        return subprocess.run(self.command(*args), check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=PATIENCE_S).returncode

    def wipe(self) -> None:
        for part in ("archive", "reports"):
            places.remove(self.folder / part)

    def kept(self) -> dict[str, str]:
        """All that stands there as a result, by its name: the digest of its content, but for the time at which it was written."""
        return self.split(self.files())[0]

    def left_over(self) -> list[str]:
        """What a kill has left half-written."""
        return [name for name in self.files() if is_left_over(name)]

    def holder(self) -> str:
        """What the lock says of who has it."""
        lock = self.folder / "reports" / ".lock"
        return lock.read_text() if lock.exists() else ""

    def files(self) -> dict[str, bytes]:
        found = {}
        for part in ("archive", "reports"):
            for path in (self.folder / part).rglob("*"):
                with suppress(FileNotFoundError, IsADirectoryError):  # a worker that was left behind may still rename and remove its draft
                    if path.is_file() or path.name.endswith(".part"):
                        found[path.relative_to(self.folder).as_posix()] = b"" if path.is_dir() else path.read_bytes()
        return found

    def split(self, files: dict[str, bytes]) -> tuple[dict[str, str], int]:
        """Results by name, and the number of the catalogue's rows."""
        results, rows = {}, 0
        for name, content in files.items():
            if is_left_over(name) or set(name.split("/")) & set(KEPT_APART) or name.rpartition("/")[2] in NIGHTLY:
                continue
            if name.startswith(CATALOGUE):
                for row in pl.read_parquet(io.BytesIO(content)).to_dicts():
                    rows += 1
                    results[f"{CATALOGUE}/{row['run']}"] = digest(row)
            elif name.endswith("/record.json"):  # step by step, as it is written
                record = json.loads(content)
                results |= {f"{name}: {step}": digest(facts) for step, facts in record.pop("steps").items()}
                results[name] = digest(record)
            else:
                results[name] = digest(json.loads(content)) if "/quarantine/" in name else hashlib.sha256(content).hexdigest()
        return results, rows


def is_left_over(name: str) -> bool:
    return any(part.startswith(".") and part.endswith(".part") for part in name.split("/"))


def digest(document: dict[str, Any]) -> str:
    return repr({key: value for key, value in document.items() if key not in OF_THE_TIME})


def logs_in(folder: Path, number: int = LOGS) -> Path:
    """A folder of so many small logs, which know no date: their files' time of change stands for it."""
    for seed in range(number):
        os.utime(batch_case.write_log(folder / f"{seed}.csv", seed=seed), (WRITTEN, WRITTEN))
    return folder


def check_part(night: Night, undisturbed: dict[str, str]) -> None:
    """All that stands in place is whole and what an undisturbed night has there; a log that a death of its worker has set aside is on top, and without
    it the trends are those of fewer runs."""
    for name, content in night.kept().items():
        if not name.startswith(("reports/quarantine/", TRENDS)):
            assert undisturbed.get(name) == content, f"{name} is not as of an undisturbed night"


def check_all(night: Night, undisturbed: dict[str, str]) -> None:
    """Every result is there, once, and equal to an undisturbed night's; nothing is left half-written; summary and page are of this night."""
    files = night.files()
    results, rows = night.split(files)
    assert results == undisturbed
    assert rows == sum(name.startswith(CATALOGUE) for name in undisturbed), "a run has two rows"
    assert [name for name in files if is_left_over(name)] == []
    summary = json.loads(files["reports/summary.json"])
    assert summary["exit_code"] == 0 and summary["counts"]["done"] + summary["counts"]["unchanged"] == LOGS
    assert f"Runs ({LOGS})".encode() in files["reports/index.html"]


@dataclass
class Tally:
    """How many disturbances there were, and how many nights came to their end between them."""

    struck: int = 0
    ended: int = 0


Strike = Callable[[subprocess.Popen[bytes], random.Random], bool]


def disturb(night: Night, undisturbed: dict[str, str], strike: Strike, moments: int, seed: int, *args: str) -> Tally:
    """Strike a night at random moments of its work, ``moments`` times, each start going on from what the one before has left; begin from nothing
    whenever a night comes to its end. After every strike what stands there is held against the undisturbed night, and at every end all of it."""
    chance, tally, longest = random.Random(seed), Tally(), PATIENCE_S  # the first night is let alone, which says how long one takes
    night.wipe()
    while tally.struck < moments:
        process = night.start(*args)
        try:
            at_work(night, process)
            work = time.monotonic()
            with suppress(subprocess.TimeoutExpired):
                process.wait(longest if longest == PATIENCE_S else chance.uniform(0, 1.1 * longest))
            struck = process.poll() is None and strike(process, chance)
            code, said = process.wait(PATIENCE_S), process.stderr.read() if process.stderr else b""
        finally:
            end(process)
        tally.struck += struck
        check_part(night, undisturbed)
        if not struck:
            longest = time.monotonic() - work
        if code == 0:
            check_all(night, undisturbed)
            tally.ended += 1
            night.wipe()
        else:
            assert struck or code == 3, f"ended by itself with {code}: {said.decode()}"
    code = night.whole(*args)
    assert code == 0
    check_all(night, undisturbed)
    tally.ended += 1
    return tally


def at_work(night: Night, process: subprocess.Popen[bytes]) -> None:
    """Wait until the batch has begun: it has the lock, and has said so."""
    deadline = time.monotonic() + PATIENCE_S
    while process.poll() is None and time.monotonic() < deadline:
        if str(process.pid) in night.holder().split():
            return
        time.sleep(0.005)


def end(process: subprocess.Popen[bytes]) -> None:
    """Kill whatever is left of a night."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    if process.stderr:
        process.stderr.close()


def parent(process: subprocess.Popen[bytes], _chance: random.Random) -> bool:
    """Kill -9 of the batch itself; its workers learn of it."""
    process.kill()
    return True


def everything(process: subprocess.Popen[bytes], _chance: random.Random) -> bool:
    """Kill -9 of all its processes at once, as when a container goes."""
    os.killpg(process.pid, signal.SIGKILL)
    return True


def worker(process: subprocess.Popen[bytes], chance: random.Random) -> bool:
    """Kill -9 of one worker, if there is one; the batch goes on."""
    workers = [grandchild for child in children(process.pid) for grandchild in children(child)]
    return bool(workers) and killed(chance.choice(workers))


def killed(process: int) -> bool:
    """Whether that process was there to be killed."""
    try:
        os.kill(process, signal.SIGKILL)
    except ProcessLookupError:
        return False
    return True


def command_line(process: int) -> str:
    """How a process was started; "" where it is gone."""
    with suppress(FileNotFoundError, ProcessLookupError):
        return Path(f"/proc/{process}/cmdline").read_text()
    return ""


def children(process: int) -> list[int]:
    """The processes that one has started."""
    return [pid for pid, above in processes() if above == process]


def processes() -> Iterator[tuple[int, int]]:
    """Every process that is no zombie, with the one that started it."""
    for status in Path("/proc").glob("[0-9]*/stat"):
        with suppress(FileNotFoundError, ProcessLookupError):
            state, above = status.read_text().rpartition(")")[2].split()[:2]
            if state != "Z":
                yield int(status.parent.name), int(above)
