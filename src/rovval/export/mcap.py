"""MCAP with messages of ROS 2, by the format's own library: for Foxglove, PlotJuggler, `mcap` and `ros2 bag`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rovval.core.version import __version__
from rovval.export.content import Content
from rovval.export.messages import messages
from rovval.storage.atomic import drafts

SUFFIX = ".mcap"


def write(content: Content, path: Path) -> tuple[Path, ...]:
    """One file, its chunks with CRCs. Raises as `messages` and `drafts` do."""
    from mcap.writer import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    with drafts(path) as [draft], draft.open("wb") as file:
        writer: Any = Writer(file)
        writer.start(profile="ros2", library=f"rovval {__version__}")
        schemas: dict[str, int] = {}
        channels: dict[str, int] = {}
        for count, (topic, kind, ns, message) in enumerate(messages(content, store.types, ros1=False)):
            if kind not in schemas:
                text: Any = store.generate_msgdef(kind, ros_version=2)[0]
                schemas[kind] = writer.register_schema(kind, "ros2msg", text.encode())
            if topic not in channels:
                channels[topic] = writer.register_channel(topic, "cdr", schemas[kind])
            writer.add_message(channels[topic], ns, bytes(store.serialize_cdr(message, kind)), ns, count)
        writer.finish()
    return (path,)
