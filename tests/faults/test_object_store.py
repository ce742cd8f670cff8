"""Kill -9 at random moments, and two batches at once, where logs, archive and reports are in an object store: the guarantees of a disk."""

from __future__ import annotations

import os
import subprocess
import sys

import fault_case
import pytest

pytest.importorskip("moto", reason="pip install 'moto[server]'")
pytest.importorskip("s3fs", reason="pip install 'rovval[object-store]'")

import store_case

pytestmark = pytest.mark.slow

MOMENTS = 10
LEASE_S = 3.0  # in place of the half minute that the next start waits for a batch that was killed
ROVVAL = f"from rovval.storage import lease; lease.LEASE_S = {LEASE_S}\nfrom rovval.cli import main\nmain()"


class Stored(fault_case.Night):
    """A night whose logs, archive and reports are in the store."""

    def __init__(self, folder, prefix) -> None:
        folder.mkdir()
        self.folder, self.prefix = folder, prefix
        self.path = store_case.write_site(folder, prefix, fault_case.LOGS)

    def command(self, *args: str) -> list[str]:
        return [sys.executable, "-c", ROVVAL, "run", str(self.path), "--quiet", "--json", *args]

    def wipe(self) -> None:
        for name in self.names():
            store_case.remove(f"{self.prefix}/{name}")

    def names(self) -> list[str]:
        found = [name.removeprefix(f"{self.prefix}/") for name in store_case.objects(self.prefix)]
        return [name for name in found if not name.startswith("logs/")]

    def files(self) -> dict[str, bytes]:
        read = {name: store_case.content(f"{self.prefix}/{name}") for name in self.names()}
        return {name: content for name, content in read.items() if content is not None}

    def holder(self) -> str:
        return (store_case.content(f"{self.prefix}/reports/.lock") or b"").decode()


@pytest.fixture(scope="module")
def server():
    with store_case.server() as address:
        yield address


@pytest.fixture(scope="module")
def whole(server, tmp_path_factory):
    """An undisturbed night, of the same logs at the same addresses."""
    night = Stored(tmp_path_factory.mktemp("undisturbed") / "night", "site")
    assert night.whole() == 0
    kept = night.kept()
    assert sum(name.endswith("/manifest.json") for name in kept) == fault_case.LOGS
    return kept


@pytest.mark.parametrize("strike", [fault_case.parent, fault_case.everything], ids=lambda strike: strike.__name__)
def test_killed_at_random_moments(tmp_path, whole, strike):
    tally = fault_case.disturb(Stored(tmp_path / "night", "site"), whole, strike, MOMENTS, 1, "--workers", "2")
    print(f"\n{strike.__name__}, object store: {tally.struck} kills, {tally.ended} nights came to their end, all equal")
    assert tally.struck == MOMENTS and tally.ended >= 1


def test_two_at_once(tmp_path, whole):
    night = Stored(tmp_path / "night", "site")
    for _ in range(3):
        night.wipe()
        started = [night.start("--workers", "1") for _ in range(2)]
        ends = [(process.communicate(timeout=fault_case.PATIENCE_S)[1].decode(), process.returncode) for process in started]
        assert {code for _, code in ends} <= {0, 2} and any(code == 0 for _, code in ends)
        assert all("another run is at work" in said for said, code in ends if code == 2)
        fault_case.check_all(night, whole)


def test_damage_is_found_and_healed(tmp_path, whole):
    """`archive check` and `repair` as on a disk: a changed byte, an object that is gone."""
    night = Stored(tmp_path / "night", "site")
    night.wipe()
    assert night.whole() == 0 and archive(night, "check") == 0
    table, record = (next(name for name in night.names() if name.endswith(end)) for end in ("run.parquet", "record.json"))
    content = night.files()[table]
    store_case.put(f"{night.prefix}/{table}", content[:-1] + bytes([content[-1] ^ 1]))
    store_case.remove(f"{night.prefix}/{record}")
    assert archive(night, "check") == 3
    archive(night, "repair")
    assert night.whole("--verify") == 0 and archive(night, "check") == 0
    fault_case.check_all(night, whole)


def archive(night: Stored, action: str) -> int:
    """The exit code of `rovval archive`."""
    where = [f"--{part}=s3://{store_case.BUCKET}/{night.prefix}/{part}" for part in ("archive", "reports")]
    return subprocess.run([sys.executable, "-m", "rovval", "archive", action, *where], check=False, capture_output=True, timeout=300).returncode


def test_a_store_that_goes_away_is_said(tmp_path):
    """No log is to blame, and no traceback comes."""
    with store_case.server():
        night = Stored(tmp_path / "night", "site")
        gone = subprocess.run([*night.command()[:2], ROVVAL, "run", str(night.path)], check=False, capture_output=True, text=True,
                              env={**os.environ, "AWS_ENDPOINT_URL": "http://127.0.0.1:9"}, timeout=300)  # fmt: skip
    assert gone.returncode == 2 and "object store cannot be used" in gone.stderr and "Traceback" not in gone.stderr
