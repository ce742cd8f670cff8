"""Camera and sonar pictures of a recording as they lie in it: neither decoded nor resampled. Imaging sonars publish the same two messages as cameras."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rovval.core.errors import BadInput
from rovval.ingest.bags.recording import recording

RAW, COMPRESSED = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"


@dataclass(frozen=True, slots=True)
class Picture:
    """One message of ``topic``: ``time_ns`` of its header, of its record where that holds none (ns since 1970); ``content`` is a whole image file of
    what ``encoding`` says where ``height`` is 0, else ``height`` rows of ``step`` bytes, ``width`` pixels in ``encoding`` (ROS's name, as "rgb8")."""

    topic: str
    time_ns: int
    encoding: str
    content: bytes
    width: int = 0
    height: int = 0
    step: int = 0
    big_endian: bool = False


def picture_topics(path: Path) -> tuple[str, ...]:
    """Topics with pictures, in the order of their names; none where ``path`` is no bag."""
    with tempfile.TemporaryDirectory(prefix="rovval-") as scratch:
        try:
            connections = recording(path, Path(scratch), []).connections()
        except BadInput:  # another kind of log, which holds no pictures
            return ()
        return tuple(sorted({one.topic for one in connections if one.kind in (RAW, COMPRESSED)}))


def pictures(path: Path) -> Iterator[Picture | None]:
    """The pictures of the bag at ``path`` in the order of each file; None for a message that cannot be read."""
    from rosbags.typesys import Stores, get_typestore

    stores = {"ros1": get_typestore(Stores.ROS1_NOETIC), "cdr": get_typestore(Stores.ROS2_HUMBLE)}
    with tempfile.TemporaryDirectory(prefix="rovval-") as scratch:
        bag = recording(path, Path(scratch), [])
        for block in bag.blocks(frozenset(one.topic for one in bag.connections() if one.kind in (RAW, COMPRESSED))):
            one, store = block.connection, stores[block.connection.encoding]
            for start, size, record_ns in zip(block.start.tolist(), block.size.tolist(), block.record_ns.tolist(), strict=True):
                content = block.data[start : start + size].tobytes()
                try:
                    m: Any = store.deserialize_ros1(content, one.kind) if one.encoding == "ros1" else store.deserialize_cdr(content, one.kind)
                except Exception:  # a damaged message makes the library raise a dozen unrelated types
                    yield None
                    continue
                stamp = m.header.stamp.sec * 10**9 + m.header.stamp.nanosec or record_ns
                if one.kind == COMPRESSED:
                    yield Picture(one.topic, stamp, m.format, m.data.tobytes())
                else:
                    yield Picture(one.topic, stamp, m.encoding, m.data.tobytes(), m.width, m.height, m.step, bool(m.is_bigendian))
