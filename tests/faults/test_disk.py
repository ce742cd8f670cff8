"""A disk that is full after so many bytes, and places that are read-only: the night says so, nothing half-written stands, and the next one goes on."""

from __future__ import annotations

import random

import fault_case
import pytest
import small_disk

from rovval.storage import places

pytestmark = pytest.mark.slow

STEPS = '["ingest", "simulate"]'
MOMENTS = 10  # a part; two parts make the twenty
ROOM = 64 << 20  # enough for everything


@pytest.fixture
def disk(tmp_path):
    with small_disk.disk(tmp_path / "disk", ROOM) as made:
        yield made


def on_disk(disk, logs) -> fault_case.Night:
    """A night whose archive and reports are on that disk."""
    night = fault_case.Night(disk.seen, logs, STEPS)
    night.path = disk.place / night.path.name
    return night


@pytest.mark.parametrize("seed", range(2))
def test_full_after_so_many_bytes(disk, logs, undisturbed, seed):
    """The page of the night before does not stay: it says what stopped this one."""
    chance, whole, night, stopped = random.Random(seed), undisturbed(STEPS), on_disk(disk, logs), 0
    empty = sum(map(len, night.files().values()))
    assert disk.run(night.command("--workers", "1")).returncode == 0
    fault_case.check_all(night, whole)
    needed = sum(4096 * (1 + len(content) // 4096) for content in night.files().values()) - empty
    page = night.folder / "reports" / "index.html"
    for _ in range(MOMENTS):
        before = {name: (night.folder / "reports" / name).read_bytes() for name in fault_case.NIGHTLY}
        night.wipe()
        page.parent.mkdir()
        for name, content in before.items():
            page.with_name(name).write_bytes(content)
        free = chance.randrange(needed)
        disk.fill(free)
        done = disk.run(night.command("--workers", "1"))
        fault_case.check_part(night, whole)
        assert done.returncode == 2 or (done.returncode == 0 and free > needed / 2), f"{free} bytes free: {done.returncode}, {done.stderr}"
        if done.returncode == 2:
            stopped += 1
            assert "No space left on device" in done.stderr and "free space on its disk" in done.stderr
            assert "Stopped before its end" in page.read_text()
            assert not list((night.folder / "reports").glob("quarantine/*")), "a full disk is no log's fault"
        disk.resize(ROOM)
        assert disk.run(night.command("--workers", "1")).returncode == 0
        fault_case.check_all(night, whole)
    print(f"\n{MOMENTS} disks of 0 to {needed} bytes free: {stopped} nights stopped and said so, all equal when there was space")
    assert stopped >= MOMENTS / 2


@pytest.mark.parametrize("part", ["archive", "archive/catalogue", "reports"])
def test_read_only_places(disk, logs, undisturbed, part):
    night, whole = on_disk(disk, logs), undisturbed(STEPS)
    assert disk.run(night.command()).returncode == 0
    places.remove(next((night.folder / "reports").glob("0-*")))  # something to do
    place = str(disk.place / part)
    disk.mount("--bind", place, place)
    disk.mount("-o", "remount,bind,ro", place)
    done = disk.run(night.command())
    assert done.returncode == 2 and "Read-only file system" in done.stderr and str(disk.place / part) in done.stderr, done.stderr
    assert "mend the path or its permissions" in done.stderr
    fault_case.check_part(night, whole)
    if part != "reports":
        assert "Stopped before its end" in (night.folder / "reports" / "index.html").read_text()
    assert not list((night.folder / "reports").glob("quarantine/*"))
    assert disk.run(["umount", place]).returncode == 0
    assert disk.run(night.command()).returncode == 0
    fault_case.check_all(night, whole)


def test_logs_that_are_read_only_are_enough(disk, logs, undisturbed, tmp_path):
    """A volume of logs that nobody may write on is how it should be."""
    night = fault_case.Night(tmp_path / "night", logs, STEPS)
    disk.mount("--bind", str(logs), str(logs))
    disk.mount("-o", "remount,bind,ro", str(logs))
    assert disk.run(night.command()).returncode == 0
    fault_case.check_all(night, undisturbed(STEPS))
