"""Camera and sonar pictures of the log beside the run, at their own times and untouched."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from rovval.core.data import Run
from rovval.ingest.bags.pictures import Picture, picture_topics, pictures

# Encodings of ROS (sensor_msgs/image_encodings.h) that the viewer shows as they are: colour model, type of a number, numbers a pixel.
RAW: dict[str, tuple[Any, str, int]] = {
    "rgb8": ("RGB", "u1", 3), "bgr8": ("BGR", "u1", 3), "rgba8": ("RGBA", "u1", 4), "bgra8": ("BGRA", "u1", 4),
    "mono8": ("L", "u1", 1), "8UC1": ("L", "u1", 1), "mono16": ("L", "u2", 1), "16UC1": ("L", "u2", 1), "32FC1": ("L", "f4", 1),
}  # fmt: skip
FILES = {b"\xff\xd8\xff": "image/jpeg", b"\x89PNG": "image/png"}  # by their first bytes


def entity(topic: str) -> str:
    """Where the pictures of a topic stand in a recording."""
    return f"/picture/{topic.strip('/')}"


def topics(log: Path | None) -> tuple[str, ...]:
    """Topics of a ``log`` that hold pictures; none without a log."""
    return picture_topics(log) if log else ()


def draw(stream: Any, run: Run, log: Path) -> list[str]:
    """Every picture of the ``log`` within the run, and notes on what is left out, each why and how often."""
    if run.t0_ns is None:
        return ["pictures of the log are left out: the run does not know what time its first sample is of"]
    left, end_ns = Counter[str](), round(run.duration_s * 1e9)
    for one in pictures(log):
        if one is None:
            left["that cannot be read"] += 1
        elif 0 <= one.time_ns - run.t0_ns <= end_ns:
            shown = _shown(one)
            if shown is None:
                left[f"on {one.topic} in {one.encoding or 'no stated encoding'}, which the viewer does not show"] += 1
                continue
            stream.set_time("run_time", duration=(one.time_ns - run.t0_ns) / 1e9)
            stream.set_time("utc", timestamp=np.datetime64(one.time_ns, "ns"))
            stream.log(entity(one.topic), shown)
    stream.reset_time()
    return [f"pictures left out: {count} {why}" for why, count in left.items()]


def _shown(one: Picture) -> Any:
    """The picture as rerun has it; None in an encoding that it has not."""
    import rerun as rr

    if not one.height:
        kind = next((kind for begin, kind in FILES.items() if one.content.startswith(begin)), None)
        return rr.EncodedImage(contents=one.content, media_type=kind) if kind else None
    if one.encoding not in RAW:
        return None
    model, number, count = RAW[one.encoding]
    item = np.dtype(number).newbyteorder(">" if one.big_endian else "<")
    used = one.width * count * item.itemsize
    if one.step < used or len(one.content) < one.height * one.step:
        return None
    rows = np.frombuffer(one.content, dtype=np.uint8, count=one.height * one.step).reshape(one.height, one.step)[:, :used]
    image = np.ascontiguousarray(rows).view(item).astype(np.dtype(number)).reshape(one.height, one.width, count)
    return rr.Image(image[..., 0] if count == 1 else image, color_model=model)
