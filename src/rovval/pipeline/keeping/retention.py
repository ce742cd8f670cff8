"""How long reports on a log's former content stay: ``keep_replaced_days`` after the log changed, for ever without it.

The runs of the archive and the rows of the catalogue stay in any case, and so does every report on a log that is gone.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from rovval.ingest.files import files_of
from rovval.pipeline.planning.config import Pipeline
from rovval.pipeline.planning.records import RECORD, read_record
from rovval.storage import places

DAY_S = 86400.0


def sweep(pipeline: Pipeline, folders: Mapping[str, Sequence[str]]) -> list[str]:
    """Remove the report folders of the pipeline that are about a log of ``folders`` and none of its own (its content, or its vehicle or profile, was
    another) and whose time is over; hold the lock of the reports. Returns their names, for the summary."""
    if pipeline.keep_replaced_days is None:
        return []
    over = [folder for folder in (path.parent for path in pipeline.reports.glob(f"*/{RECORD}")) if _is_over(folder, folders, pipeline.keep_replaced_days)]
    for folder in over:
        places.remove(folder)
    return sorted(folder.name for folder in over if not folder.exists())


def _is_over(folder: Path, folders: Mapping[str, Sequence[str]], days: float) -> bool:
    record = read_record(folder)
    if record is None or folder.name in folders.get(record["log"], (folder.name,)):
        return False
    with suppress(OSError):  # a log that cannot be looked at tells nothing
        return time.time() - max(part.stat().st_mtime for part in files_of(places.place(record["log"]))) > days * DAY_S
    return False
