"""docs/profiles.md is what the model says, and its examples come out as it says they do."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_typestore

from conftest import ROOT
from rovval.core.channels import CHANNELS
from rovval.core.units import SI
from rovval.ingest import read, readers
from rovval.ingest.documentation.document import text
from rovval.ingest.documentation.examples import examples
from rovval.ingest.profile import Clock, Profile, Source
from rovval.ingest.profile.model import Markers

PAGE = ROOT / "docs" / "profiles.md"
EXAMPLES = {e.title: e for e in examples()}


def test_the_page_is_current():
    assert PAGE.read_text(encoding="utf-8") == text(), "write it anew: python -m rovval.ingest.documentation.document > docs/profiles.md"


def test_every_key_channel_unit_and_format_is_explained():
    page = PAGE.read_text(encoding="utf-8")
    for model in (Profile, Clock, Source, Markers):
        for name, info in model.model_fields.items():
            assert info.description and f"| `{name}` |" in page, name
    assert all(f"`{name}" in page for name in (*CHANNELS, *SI, *readers()))


def test_there_are_ten_examples_of_what_was_asked_for():
    assert len(EXAMPLES) >= 10


@pytest.mark.parametrize("title", EXAMPLES)
def test_an_example_comes_out_as_it_says(title, tmp_path):
    example = EXAMPLES[title]
    path, profile = tmp_path / example.file, tmp_path / "mine.toml"
    profile.write_text(example.profile, encoding="utf-8")
    bag(path, example.log) if path.suffix == ".bag" else path.write_text(example.log.lstrip("\n"), encoding="utf-8")
    raw = read(path, str(profile))
    for name, values in example.comes_out.items():
        assert np.allclose(raw.channels[name].values, values, rtol=1e-5, atol=1e-6), name
    if example.t:
        assert np.allclose(next(iter(raw.channels.values())).t, example.t, atol=1e-6)
    if example.t0:
        assert raw.t0_ns == round(datetime.fromisoformat(example.t0).timestamp() * 1000) * 10**6


def bag(path: Path, log: str) -> None:
    """One message a line: topic, type, stamp, and the fields that are not zero."""
    store: Any = get_typestore(Stores.ROS1_NOETIC)
    with Writer(path) as writer:
        connections: dict[str, Any] = {}
        for line in log.strip().splitlines():
            topic, kind, stamp, *fields = line.split()
            ns = round(float(stamp) * 10) * 10**8
            given = {"header.stamp.sec": ns // 10**9, "header.stamp.nanosec": ns % 10**9} | {f.partition("=")[0]: float(f.partition("=")[2]) for f in fields}
            message = build(store, kind, given)
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=store)
            writer.write(connections[topic], ns, store.serialize_ros1(message, kind))


def build(store: Any, kind: str, given: dict[str, Any], at: str = "") -> Any:
    """A message of a type, zero but for the fields given by their address."""
    values: dict[str, Any] = {}
    for name, (node, what) in store.get_msgdef(kind).fields:
        address = f"{at}{name}"
        if node.name == "NAME":
            values[name] = build(store, what, given, f"{address}.")
        elif node.name == "BASE":
            values[name] = given.get(address, "" if what[0] == "string" else 0)
        else:
            values[name] = np.zeros(what[1])
    return store.types[kind](**values)
