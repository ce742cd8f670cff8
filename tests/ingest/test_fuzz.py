"""Mutants of logs of every format: each is read or refused in one sentence, in bounded time and memory, and never printed about."""

from __future__ import annotations

import resource
import time
from collections import Counter

import numpy as np
import pytest
from log_files import CASES

from rovval.core.errors import RovvalError
from rovval.ingest import read

MUTANTS = 500
LONGEST_S = 5.0  # CPU time of one mutant; a whole file takes a twentieth of it
MOST_BYTES = 300_000_000  # by which all of them raise the most that the process ever held; the files have less than 1 MB


def memory() -> int:
    """The most that the process ever held, bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def mutant(whole: bytes, rng: np.random.Generator) -> bytes:
    """Cut, flipped, a block of zeros or noise, a piece lost, doubled or moved; one to three of these, beyond the first bytes by which it is known."""
    content = bytearray(whole)
    for _ in range(int(rng.integers(1, 4))):
        size = len(content)
        at, span = int(rng.integers(16, max(size - 1, 17))), int(2 ** rng.uniform(0, 13))
        kind = rng.integers(7)
        if kind == 0:
            del content[at:]
        elif kind == 1:
            for k in rng.integers(16, max(size, 17), int(rng.integers(1, 20))):
                content[min(int(k), size - 1)] ^= 1 << int(rng.integers(8))
        elif kind == 2:
            content[at : at + span] = bytes(len(content[at : at + span]))
        elif kind == 3:
            content[at : at + span] = rng.bytes(len(content[at : at + span]))
        elif kind == 4:
            del content[at : at + span]
        elif kind == 5:
            content[at:at] = content[at : at + span]
        else:
            number = b"\xff\xff\xff\xff" if rng.integers(2) else b"\xff\xff\xff\x7f"  # what lengths overflow with
            content[at : at + 4] = number
    return bytes(content) if len(content) > 16 else bytes(whole[:20])


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_every_mutant_is_read_or_refused(name, tmp_path, capfd):
    write, profile_of = CASES[name]
    whole, profile = write(tmp_path), profile_of(tmp_path)
    content, rng = whole.read_bytes(), np.random.default_rng(sum(name.encode()))
    path = tmp_path / ("mutant" + "".join(whole.suffixes))
    became: Counter[str] = Counter()
    slowest = 0.0
    before = memory()
    for number in range(MUTANTS):
        path.write_bytes(mutant(content, rng))
        start = time.process_time()
        try:
            raw = read(path, profile)
            became["read, said" if raw.findings else "read, nothing found"] += 1
        except RovvalError as refused:
            assert refused.message and refused.hint and len(refused.message) < 5000, number
            became["refused"] += 1
        slowest = max(slowest, time.process_time() - start)
    biggest = memory() - before
    printed = capfd.readouterr()
    assert printed.out == printed.err == ""
    print(f"\n{name}: {dict(became)}, slowest {slowest:.2f} s, {biggest / 1e6:.0f} MB more than before")
    assert slowest < LONGEST_S and biggest < MOST_BYTES
