"""Trends of a batch: the same as those of its rows, and known from one night to the next."""

import batch_case
import numpy as np
from catalogue_case import NOW, row

from rovval import trend
from rovval.pipeline.keeping.catalogue import rows_of
from rovval.pipeline.keeping.trends import KNOWN, trends
from rovval.pipeline.planning import config
from rovval.storage import catalogue


def test_they_are_those_of_its_rows_also_when_they_are_known(tmp_path):
    batch_case.write_log(tmp_path / "logs" / "a.csv")
    pipeline = config.load(batch_case.write_pipeline(tmp_path))
    rng = np.random.default_rng(1)
    rows = [row(n, surge=float(0.05 * np.exp(0.1 * rng.standard_normal()) * (1 + (n >= 20))), causes=[]) for n in range(40)]
    catalogue.update(pipeline.archive, [*rows, row(99, pipeline="another", surge=9.0)], NOW)
    pipeline.reports.mkdir()
    wanted = trend.trends(rows_of(pipeline))
    assert [t.series.name for t in wanted if t.changes] == ["surge"]
    assert trends(pipeline) == wanted
    stamp = (pipeline.reports / KNOWN).stat().st_mtime_ns
    assert trends(pipeline) == wanted and (pipeline.reports / KNOWN).stat().st_mtime_ns == stamp
    for damage in ("{", '{"x": 1}', (pipeline.reports / KNOWN).read_text().replace("sure_of_kind", "sure")):
        (pipeline.reports / KNOWN).write_text(damage)
        assert trends(pipeline) == wanted
