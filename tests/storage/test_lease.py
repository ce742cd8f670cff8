"""A lock in an object store: one holder at a time, and a dead one's is taken over. Against an S3 server by another hand, on loopback."""

from __future__ import annotations

import threading
import time

import pytest

pytest.importorskip("moto", reason="pip install 'moto[server]'")
pytest.importorskip("s3fs", reason="pip install 'rovval[object-store]'")

import store_case

from rovval.core.errors import UsageProblem
from rovval.storage import lease, places

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def server():
    with store_case.server() as address:
        yield address


@pytest.fixture
def path(server, request, monkeypatch):
    monkeypatch.setattr(lease, "LEASE_S", 3.0)
    return places.place(f"s3://{store_case.BUCKET}/{request.node.name}/.lock")


def test_a_second_holder_is_refused_and_the_object_goes_with_the_first(path):
    with lease.held(path), pytest.raises(UsageProblem, match="another run is at work"), lease.held(path):
        pass
    assert not path.exists()
    with lease.held(path):
        assert path.exists()


def test_those_that_wait_come_one_after_the_other(path):
    inside, most = [], []

    def one() -> None:
        with lease.held(path, wait=True):
            inside.append(1)
            most.append(len(inside))
            time.sleep(0.3)
            inside.pop()

    threads = [threading.Thread(target=one) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert most == [1] * 4


def test_a_dead_holders_is_taken_over_and_it_learns_of_it(path):
    dead = lease.Lease(path)
    dead.take(wait=False)  # renews nothing, as a process that was killed or sleeps
    with lease.held(path) as living:
        living.check()
        dead.keep()
        with pytest.raises(UsageProblem, match="another run took over"):
            dead.check()
        dead.give_back()
        assert path.exists(), "it is not his any more"


def test_a_bucket_that_is_not_there_and_a_store_that_is_away_are_said(path, monkeypatch):
    with pytest.raises(UsageProblem, match="bucket"), lease.held(places.place("s3://no-such-bucket/x/.lock")):
        pass
