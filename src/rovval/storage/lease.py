"""A lock in an object store: an object that only one can create, and that its holder renews for as long as it lives.

A holder that was killed renews no more; whoever has watched the object stand still for `LEASE_S` takes it over. Nobody's clock is trusted: each
watches by its own. (Conditional writes, If-None-Match and If-Match, are Amazon's since 2024, and MinIO's, Ceph's and others'.)
"""

from __future__ import annotations

import os
import socket
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from rovval.core.errors import Unwritable, UsageProblem
from rovval.storage import places

LEASE_S = 30.0  # a holder that is not heard of for so long is dead: ten times what a store takes to answer when it is slow
RENEWALS = 5  # in that time, so that some may fail


class Lease:
    """One holder's side of the object at ``path``."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.store = places.store(path)
        self.tag = ""
        self.count = 0
        self.lost = False
        self.ended = threading.Event()

    def take(self, wait: bool) -> None:
        """Create the object. Raises `UsageProblem` where somebody alive holds it, unless that is to be waited for."""
        while not self._written(IfNoneMatch="*"):
            tag, who = self.seen()
            if not tag:
                continue
            if not self.changes(tag):
                if self._written(IfMatch=tag):
                    return
            elif not wait and self.seen()[0]:
                raise UsageProblem(f"{self.path.parent}: another run is at work ({who})", "wait for it, or end it")

    def keep(self) -> None:
        """Renew it until it is given back."""
        while not self.ended.wait(LEASE_S / RENEWALS):
            with suppress(OSError, Unwritable):
                self.lost = not self._written(IfMatch=self.tag)
            if self.lost:
                return

    def check(self) -> None:
        """Raises `UsageProblem` where another has taken it over, since this process was not heard of."""
        if self.lost:
            raise UsageProblem(
                f"{self.path.parent}: another run took over while this one was not heard of for {LEASE_S:g} s", "the other one goes on from here"
            )

    def give_back(self) -> None:
        """Remove the object, if it is still ours."""
        self.ended.set()
        with suppress(OSError, Unwritable):
            if not self.lost and self.seen()[0] == self.tag:
                self.store.rm_file(str(self.path))

    def changes(self, tag: str) -> bool:
        """Whether the object changes within `LEASE_S`."""
        deadline = time.monotonic() + LEASE_S
        while time.monotonic() < deadline:
            if self.seen()[0] != tag:
                return True
            time.sleep(LEASE_S / RENEWALS / 4)
        return False

    def seen(self) -> tuple[str, str]:
        """Tag of the object that stands there, and who wrote it; "" where there is none."""
        with places.reached():
            try:
                return str(self.store.info(str(self.path), refresh=True)["ETag"]), self.store.cat_file(str(self.path)).decode()
            except FileNotFoundError:
                return "", ""

    def _written(self, **condition: str) -> bool:
        """Write the object if the condition holds."""
        bucket, _, key = str(self.path).partition("://")[2].partition("/")
        self.count += 1
        text = f"process {os.getpid()} of {socket.gethostname()}, {id(self):x}, renewed {self.count} times"
        with places.reached():
            try:
                written: dict[str, Any] = self.store.call_s3("put_object", Bucket=bucket, Key=key, Body=text.encode(), **condition)
            except FileNotFoundError as error:
                if "IfMatch" in condition:
                    return False
                raise UsageProblem(f"{self.path.parent}: {error}", "make the bucket, or mend its name") from None
            except OSError as error:
                if "pre-condition" not in str(error) and "conflict" not in str(error).lower():
                    raise
                there, who = self.seen()
                if who == text:  # ours: the store's answer to the first try was lost on its way
                    self.tag = there
                return who == text
        self.tag = str(written["ETag"])
        return True


@contextmanager
def held(path: Path, wait: bool = False) -> Iterator[Lease]:
    """Hold the lease at ``path``. Raises `UsageProblem` as `Lease.take` does, and where the store cannot be used."""
    lease = Lease(path)
    with _said(path):
        lease.take(wait)
    threading.Thread(target=lease.keep, daemon=True).start()
    try:
        yield lease
    finally:
        lease.give_back()


def refuse_held(paths: Iterable[Path]) -> None:
    """Raises `UsageProblem` where somebody alive holds one of these."""
    for path in paths:
        other = Lease(path)
        with _said(path):
            tag, who = other.seen()
            if tag and other.changes(tag) and other.seen()[0]:
                raise UsageProblem(f"{path.parent}: another run is at work ({who})", "wait for it, or end it")


@contextmanager
def _said(path: Path) -> Iterator[None]:
    """A store that cannot be used, as `UsageProblem`."""
    try:
        yield
    except OSError as error:
        raise UsageProblem(f"{path.parent}: {error.strerror or error}", "look at AWS_ENDPOINT_URL, the credentials and the bucket's name") from None
