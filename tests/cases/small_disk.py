"""A small disk of its own (tmpfs), which can be full and read-only: in a name space of mounts, for which nobody needs to be root."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import pytest


@dataclass(frozen=True)
class Disk:
    """The disk at ``place``, which only processes started by `run` see; ``seen`` is how others do."""

    place: Path
    holder: int

    @property
    def seen(self) -> Path:
        return Path(f"/proc/{self.holder}/root{self.place}")

    def run(self, command: Sequence[str]) -> subprocess.CompletedProcess[str]:
        """A process that has this disk."""
        enter = ["nsenter", f"--target={self.holder}", "--mount", "--user", "--preserve-credentials", *command]
        return subprocess.run(enter, check=False, capture_output=True, text=True, timeout=600)

    def mount(self, *options: str) -> None:
        assert (done := self.run(["mount", *options])).returncode == 0, done.stderr

    def resize(self, size: int) -> None:
        """Its size in bytes, in pages of which a tmpfs is made: rounded up."""
        self.mount("-o", f"remount,size={size}", str(self.place))

    def fill(self, free: int) -> None:
        """Leave that many bytes free."""
        used = int(self.run(["du", "--block-size=1", "--summarize", str(self.place)]).stdout.split()[0])
        self.resize(used + free)


@contextmanager
def disk(place: Path, size: int = 64 << 20) -> Iterator[Disk]:
    """A disk at ``place``; skips the test where this system gives none to an ordinary user."""
    if not (shutil.which("unshare") and shutil.which("nsenter")):
        pytest.skip("no unshare and nsenter (util-linux)")
    place.mkdir(parents=True, exist_ok=True)
    script = f"mount -t tmpfs -o size={size} tmpfs '{place}' && echo ready && exec sleep infinity"
    with subprocess.Popen(["unshare", "--map-root-user", "--mount", "sh", "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as holder:
        try:
            assert holder.stdout and holder.stderr
            if holder.stdout.readline() != "ready\n":
                pytest.skip(f"no disk of one's own here: {holder.stderr.read()}")
            yield Disk(place, holder.pid)
        finally:
            holder.kill()
