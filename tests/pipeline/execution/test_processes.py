"""Workers of this machine: one that dies or hangs costs its own log and no other."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import batch_case
import pytest
from batch_case import counts, tasks_of

from rovval.pipeline import batch
from rovval.pipeline.execution.processes import THREADS, execute


def test_a_worker_that_dies_takes_only_its_own_log_with_it(site):
    for number, name in enumerate(("killer", "leaver", "z1", "z2")):
        batch_case.write_log(site / "logs" / f"{name}.csv", seed=50 + number)
    tasks = tasks_of(batch_case.write_pipeline(site))
    ended = {task.log.stem: outcome for task, outcome in execute(tasks, batch_case.deadly, batch.died, workers=2)}
    assert len(ended) == len(tasks) == 7
    assert sorted(n for n, o in ended.items() if o["status"] != "done") == ["killer", "leaver"]
    assert "SIGKILL" in ended["killer"]["record"]["reason"]
    assert "code 9" in ended["leaver"]["record"]["reason"]


def test_a_log_whose_worker_died_is_tried_again_by_the_next_run(site):
    """It may have lacked memory that is there now."""
    batch_case.write_log(site / "logs" / "killer.csv", seed=50)
    path = batch_case.write_pipeline(site)
    list(execute(tasks_of(path), batch_case.deadly, batch.died, workers=1))
    assert [t.log.stem for t in tasks_of(path)] == ["killer"]
    assert counts(batch.run(path, workers=1)) == {"done": 1, "unchanged": 3}
    assert not list((site / "reports" / "quarantine").iterdir())


def test_a_log_that_takes_too_long_is_set_aside(site):
    batch_case.write_log(site / "logs" / "hanger.csv", seed=50)
    tasks = [t for t in tasks_of(batch_case.write_pipeline(site)) if t.log.stem == "hanger"]
    began = time.monotonic()
    [(_, outcome)] = execute(tasks, batch_case.slow, batch.died, workers=2, timeout_s=1.0)
    assert time.monotonic() - began < 30
    assert "timeout_s = 1 s" in outcome["record"]["reason"]


def test_a_worker_does_not_outlive_a_killed_batch(site):
    """It went on with its log while the next batch held the lock."""
    batch_case.write_log(site / "logs" / "hanger.csv", seed=50)
    path = batch_case.write_pipeline(site)
    path.write_text(path.read_text().replace("logs/*.csv", "logs/hanger.csv"))
    code = f"import sys; sys.path.insert(0, {str(Path(batch_case.__file__).parent)!r})\nimport batch_case\nfrom pathlib import Path\n"
    code += f"from rovval.pipeline import batch\nbatch.work = batch_case.telling\nbatch.run(Path({str(path)!r}), workers=1)\n"
    with subprocess.Popen([sys.executable, "-c", code]) as process:
        told, deadline = site / "logs" / "hanger.pid", time.monotonic() + 60
        while not (told.exists() and told.read_text()) and time.monotonic() < deadline:
            time.sleep(0.02)
        process.send_signal(signal.SIGKILL)
        process.wait()
    worker, deadline = int(told.read_text()), time.monotonic() + 10
    while is_alive(worker) and time.monotonic() < deadline:
        time.sleep(0.02)
    assert not is_alive(worker)


def is_alive(process: int) -> bool:
    """Whether that process is there and no zombie that waits for its parent."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    status = Path(f"/proc/{process}/stat")
    return not status.exists() or status.read_text().rpartition(")")[2].split()[0] != "Z"


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="threads are counted as Linux tells them")
def test_a_worker_computes_with_one_thread(site):
    """With one a core each, as many workers as cores are in each other's way."""
    before = dict(os.environ)
    code = "import sys, batch_case; from pathlib import Path; from rovval.pipeline.execution.processes import execute\n"
    code += "[(_, done)] = execute(batch_case.tasks_of(Path(sys.argv[1]))[:1], batch_case.counting_threads, None, 1); print(done['record']['threads'])"
    path = [str(Path(batch_case.__file__).parent), *sys.path]
    environment = {name: value for name, value in before.items() if name not in THREADS} | {"PYTHONPATH": os.pathsep.join(path)}
    done = subprocess.run([sys.executable, "-c", code, str(batch_case.write_pipeline(site))], env=environment, capture_output=True, text=True, check=True)
    assert int(done.stdout) == 2, "the one that works, and the one that waits for the end of the batch"
    assert os.environ == before
