"""ROS 1 bag, format 2.0, by rosbags: for `rosbag`, `rqt_bag`, evo and MATLAB."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rovval.export.content import Content
from rovval.export.messages import messages
from rovval.storage.atomic import drafts

SUFFIX = ".bag"


def write(content: Content, path: Path) -> tuple[Path, ...]:
    """One bag. Raises as `messages` and `drafts` do."""
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC)
    if "tf2_msgs/msg/TFMessage" not in store.fielddefs:
        store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", "tf2_msgs/msg/TFMessage"))
    with drafts(path) as [draft]:
        writer: Any = Writer(draft)
        with writer:
            connections: dict[str, Any] = {}
            for topic, kind, ns, message in messages(content, store.types, ros1=True):
                if topic not in connections:
                    connections[topic] = writer.add_connection(topic, kind, typestore=store)
                writer.write(connections[topic], ns, store.serialize_ros1(message, kind))
    return (path,)
