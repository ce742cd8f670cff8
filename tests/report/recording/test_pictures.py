"""Camera and sonar pictures of a bag stand in the recording at their own times, as they were."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from report_cases import make_run, make_sim
from rosbags.rosbag1 import Writer as Bag1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Bag2
from rosbags.typesys import Stores, get_typestore

from rovval import vehicle
from rovval.comparison import compare
from rovval.report.recording import write as recording

MERLIN = vehicle.load("merlin")
START_NS = 1_700_000_000_000_000_000
PNG = b"\x89PNG\r\n\x1a\n and what follows, which nobody looks into"
SONAR = np.arange(12, dtype=np.uint8).reshape(3, 4)
RAW, FILE = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"


def bag(kind: str, path: Path) -> Path:
    """A camera's PNG 2 s after the start and 100 s before it, a sonar's raw picture with padded rows at 5 s, and one in an encoding that no viewer has."""
    store = get_typestore(Stores.ROS1_NOETIC if kind == "bag" else Stores.ROS2_HUMBLE)
    T: Mapping[str, Any] = store.types

    def header(t: float) -> Any:
        ns = START_NS + round(t * 1e9)
        stamp = T["builtin_interfaces/msg/Time"](sec=ns // 10**9, nanosec=ns % 10**9)
        return T["std_msgs/msg/Header"](stamp=stamp, frame_id="", **({"seq": 0} if kind == "bag" else {}))

    def raw(t: float, encoding: str, rows: Any) -> Any:
        return T[RAW](header=header(t), height=3, width=4, encoding=encoding, is_bigendian=0, step=rows.shape[1], data=rows.ravel())

    padded = np.pad(SONAR, ((0, 0), (0, 2)))
    messages = [
        ("/camera/compressed", FILE, T[FILE](header=header(2.0), format="png", data=np.frombuffer(PNG, dtype=np.uint8))),
        ("/camera/compressed", FILE, T[FILE](header=header(-100.0), format="png", data=np.frombuffer(PNG, dtype=np.uint8))),
        ("/sonar", RAW, raw(5.0, "mono8", padded)),
        ("/sonar", RAW, raw(6.0, "yuv422_yuy2", padded)),
    ]
    plugin = StoragePlugin.MCAP if kind == "mcap" else StoragePlugin.SQLITE3
    writer: Any = Bag1(path) if kind == "bag" else Bag2(path, version=9, storage_plugin=plugin)
    with writer as out:
        at = {topic: out.add_connection(topic, of, typestore=store) for topic, of in {topic: of for topic, of, _ in messages}.items()}
        for topic, of, message in messages:
            content = store.serialize_ros1(message, of) if kind == "bag" else store.serialize_cdr(message, of)
            out.write(at[topic], START_NS, content)
    return path


@pytest.mark.parametrize("kind", ["bag", "db3", "mcap"])
def test_pictures_stand_at_their_own_times_untouched(kind: str, tmp_path: Path) -> None:
    from rerun.chunk import RrdReader

    run = replace(make_run(300), t0_ns=START_NS)
    recording.write(compare(run, make_sim(run)), tmp_path / "run.rrd", MERLIN, log=bag(kind, tmp_path / f"dive.{kind}"))
    seen: dict[str, list[tuple[float, bytes]]] = {}
    notes = ""
    for chunk in RrdReader(str(tmp_path / "run.rrd")).stream():
        batch = chunk.to_record_batch()
        for column in ("EncodedImage:blob", "Image:buffer"):
            if column in batch.schema.names:
                times = batch.column("run_time").to_numpy(zero_copy_only=False).astype(np.int64) / 1e9
                content = [bytes(np.asarray(one.as_py()[0], dtype=np.uint8)) for one in batch.column(column)]
                seen.setdefault(chunk.entity_path, []).extend(zip(times.tolist(), content, strict=True))
        if "TextDocument:text" in batch.schema.names:
            notes = batch.column("TextDocument:text").flatten()[0].as_py()
    assert seen == {"/picture/camera/compressed": [(2.0, PNG)], "/picture/sonar": [(5.0, SONAR.tobytes())]}
    assert "pictures left out: 1 on /sonar in yuv422_yuy2, which the viewer does not show" in notes


def test_a_log_that_is_no_bag_has_none(tmp_path: Path) -> None:
    log = tmp_path / "dive.csv"
    log.write_text("t,u\n0,1\n")
    run = make_run(100)
    recording.write(compare(run, make_sim(run)), tmp_path / "run.rrd", MERLIN, log=log)
    assert (tmp_path / "run.rrd").stat().st_size
