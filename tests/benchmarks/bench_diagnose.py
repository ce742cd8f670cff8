"""What a diagnosis costs, and how it grows with the log and with the library:  pytest -m benchmark -s tests/benchmarks/bench_diagnose.py

CPU seconds of the whole process (all threads), kernels compiled before, on logs of the independent plant with one effect planted. BLAS
has one thread, as it has in batch and in the blind check: its matrices here are small, and threads of its own mostly wait for one another.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from math import log2
from pathlib import Path
from statistics import median
from typing import Any

import pytest

HERE = Path(__file__).parent
MINUTES = (2.5, 5.0, 10.0, 20.0)
LIMIT_CPU_S = 20.0  # target for a log of 10 minutes against the whole library, half of such logs,
MOST_CPU_S = 90.0  # and for the worst of them
PLANTED: tuple[tuple[tuple[str, str, float], ...], ...] = (
    (), (("inflow_loss", "", 1.5),), (("thruster_degraded", "HFP", 1.5),), (("buoyancy_error", "", 1.5),), (("quadratic_drag", "surge", 1.5),),
    (("dvl_scale", "", 1.5),), (("current_constant", "", 1.5),), (("cg_offset", "", 1.5),), (("thrust_lag", "", 1.5),),
    (("inflow_loss", "", 1.5), ("cg_offset", "", 1.5)),
)  # fmt: skip
HOUR_MB = 1000.0  # target: own memory of the process while it diagnoses an hour
MOST_GROWTH = 1.2  # chosen: exponent of the cost in the length; 1 is linear, 2 would say that some step compares all windows
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}

pytestmark = pytest.mark.benchmark


def measured(folder: str, minutes: list[float]) -> list[dict[str, Any]]:
    """A row a diagnosis: minutes, windows, hypotheses, CPU and wall seconds, what was named. Runs in a process of its own."""
    from time import perf_counter, process_time

    from diagnose_case import foreign, merlin

    from rovval import effects
    from rovval.diagnose import diagnose

    logs = {m: foreign(Path(folder), (("inflow_loss", "", 1.5),), 5, 60.0 * m, 0.03) for m in minutes}
    diagnose([logs[minutes[0]]], merlin())
    half = tuple(name for name in effects.names()[::2] if name != "inflow_loss")
    rows = []
    for m, without in [*((m, ()) for m in minutes), (10.0, half)]:
        cpu, wall = process_time(), perf_counter()
        document = diagnose([logs[m]], merlin(), without=without).document()
        rows.append({
            "minutes": m, "windows": document["windows"], "hypotheses": len(document["ranking"]), "cpu_s": process_time() - cpu,
            "wall_s": perf_counter() - wall, "rounds": len(document["finalists"]), "named": [c["effect"] for c in document["causes"]],
        })  # fmt: skip
    return rows


def of_each(folder: str) -> list[dict[str, Any]]:
    """A row a log of ten minutes: what is planted, CPU seconds, rounds, what was named. Runs in a process of its own."""
    from time import process_time

    from diagnose_case import foreign, merlin

    from rovval.diagnose import diagnose

    rows = list[dict[str, Any]]()
    for i, planted in enumerate(PLANTED):
        log = foreign(Path(folder) / str(i), planted, 5, 600.0, 0.03)
        if not rows:
            diagnose([log], merlin())
        cpu = process_time()
        document = diagnose([log], merlin()).document()
        rows.append({
            "planted": " and ".join(name for name, _, _ in planted) or "healthy", "cpu_s": process_time() - cpu, "rounds": len(document["finalists"]),
            "named": [c["effect"] for c in document["causes"]],
        })  # fmt: skip
    return rows


def own_memory(seconds: float) -> dict[str, Any]:
    """The most memory (MB) that is the process's own, not a file's that the system may put away, while a log is diagnosed; and what that named."""
    from threading import Event, Thread

    from diagnose_case import merlin, own

    from rovval.diagnose import diagnose

    log, most, done = own(("inflow_loss:loss=0.3",), 5, seconds), [0], Event()

    def watch() -> None:
        while not done.wait(0.05):
            status = Path("/proc/self/status").read_text(encoding="utf-8")
            most.append(int(next(line.split()[1] for line in status.splitlines() if line.startswith("RssAnon"))))

    watching = Thread(target=watch)
    watching.start()
    try:
        document = diagnose([log], merlin()).document()
    finally:
        done.set()
        watching.join()
    return {"windows": document["windows"], "named": [c["effect"] for c in document["causes"]], "mb": max(most) / 1e3}


def in_a_process(call: str) -> Any:
    """What a function of this file returns in a process of its own."""
    code = f"import json, bench_diagnose as b; print(json.dumps(b.{call}))"
    environment = {**os.environ, **ONE_THREAD, "PYTHONPATH": os.pathsep.join([str(HERE), str(HERE.parent / "cases"), os.environ.get("PYTHONPATH", "")])}
    done = subprocess.run([sys.executable, "-c", code], env=environment, check=True, capture_output=True, text=True)
    return json.loads(done.stdout.splitlines()[-1])


def test_memory_of_an_hour():
    """Sensitivities and normal equations of a long log lie in files: what the process holds by itself grows with the motion that was measured alone."""
    short, hour = in_a_process("own_memory(600.0)"), in_a_process("own_memory(3600.0)")
    print(f"\nten minutes take {short['mb']:.0f} MB, an hour {hour['mb']:.0f} MB (at most {HOUR_MB:g}); named: {hour['named']}")
    assert hour["named"] == short["named"] == ["inflow_loss"]
    assert hour["mb"] < HOUR_MB


def test_ten_minutes_of_each_kind(tmp_path):
    rows = sorted(in_a_process(f"of_each({str(tmp_path)!r})"), key=lambda r: r["cpu_s"])
    print("\n   CPU s  rounds  planted")
    for r in rows:
        print(f"{r['cpu_s']:8.1f}{r['rounds']:8}  {r['planted']}; named: {', '.join(r['named']) or 'nothing'}")
    middle, worst = median(r["cpu_s"] for r in rows), rows[-1]["cpu_s"]
    print(f"median {middle:.1f} s (at most {LIMIT_CPU_S:g}), worst {worst:.1f} s (at most {MOST_CPU_S:g})")
    assert middle < LIMIT_CPU_S
    assert worst < MOST_CPU_S


def test_ten_minutes_against_the_whole_library(tmp_path):
    rows = in_a_process(f"measured({str(tmp_path)!r}, {list(MINUTES)})")
    print(f"\n{'log':>8}{'windows':>9}{'hypotheses':>12}{'rounds':>8}{'CPU s':>8}{'wall s':>8}  named")
    for r in rows:
        print(f"{r['minutes']:>4g} min{r['windows']:>9}{r['hypotheses']:>12}{r['rounds']:>8}{r['cpu_s']:>8.1f}{r['wall_s']:>8.1f}  {', '.join(r['named'])}")
    *whole, half = rows
    cost = {r["minutes"]: r["cpu_s"] for r in whole}
    growth = log2(cost[20.0] / cost[10.0])
    print(f"from 10 to 20 minutes it grows with the power {growth:.2f} of the length; half the library takes {half['cpu_s'] / cost[10.0]:.0%}")
    assert half["hypotheses"] < 0.7 * whole[2]["hypotheses"]
    assert growth < MOST_GROWTH
    assert cost[10.0] < LIMIT_CPU_S
