"""Workers of a Dask cluster: the same outcomes, and a missing library is said with how to get it."""

import sys

import batch_case
import pytest
from batch_case import counts

from rovval.core.errors import UsageProblem
from rovval.pipeline import batch
from rovval.pipeline.execution import cluster


def test_a_cluster_without_dask_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(UsageProblem) as refused:
        list(cluster.execute((), batch_case.paused, batch.died, "tcp://localhost:1"))
    assert "rovval[cluster]" in refused.value.hint


@pytest.mark.slow
def test_a_dask_cluster_gives_the_same_outcomes(site):
    """With real worker processes; needs the extra `cluster`."""
    distributed = pytest.importorskip("distributed", reason="pip install 'rovval[cluster]'")
    (site / "logs" / "bad.csv").write_text("this is,not a log\n1,2\n")
    path = batch_case.write_pipeline(site)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as dask:
        done = batch.run(path, scheduler=dask.scheduler_address)
    assert counts(done) == {"done": 3, "quarantined": 1}
    assert counts(batch.run(path, workers=1)) == {"unchanged": 3, "quarantined": 1}


@pytest.mark.slow
def test_a_scheduler_without_workers_is_not_waited_for(site, monkeypatch):
    """The batch waited in silence, for ever; needs the extra `cluster`."""
    distributed = pytest.importorskip("distributed", reason="pip install 'rovval[cluster]'")
    monkeypatch.setattr(cluster, "PATIENCE_S", 1.0)
    with distributed.LocalCluster(n_workers=0, dashboard_address=None) as dask, pytest.raises(UsageProblem, match="no worker for 1 s"):
        batch.run(batch_case.write_pipeline(site), scheduler=dask.scheduler_address)
    assert "Stopped before its end (1)" in (site / "reports" / "index.html").read_text()
