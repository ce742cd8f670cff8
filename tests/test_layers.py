"""Imports point down, between rooms and inside them, in no circle, and heavy libraries stand only in the rooms that need them.

The tables are the design's lists of rooms. Imports inside functions and those for type checking count: a lazy import hides no circle.
"""

import ast
from functools import cache
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parent.parent / "src" / "rovval"

# Top first: a room may import itself and what stands below it. Rooms on one line may not import each other.
ROOMS = (
    ("__main__",),
    ("__init__",),
    ("cli",),
    ("demo",),
    ("pipeline",),
    ("report",),
    ("blind",),
    ("fit", "trend"),
    ("diagnose",),
    ("fly",),
    ("comparison",),
    ("simulation",),
    ("plant",),
    ("effects",),
    ("vehicle",),
    ("storage",),
    ("alignment",),
    ("ingest",),
    ("core",),
)
# The same inside a room; "" are the files that lie in the room itself.
INSIDE = {
    "diagnose": (("",), ("result",), ("decision",), ("search",), ("hypotheses",), ("inference",), ("problem",), ("residuals",), ("windows",), ("criteria",)),
    "blind": (("",), ("scoring",), ("sealed",), ("baselines", "cases"), ("planted",), ("missions",), ("plant",)),
    "report": (("",), ("batch", "blind", "diagnosis", "recording"), ("comparison",), ("common",)),
    "effects": (("library",), ("",)),
    "plant": (("reference",), ("",), ("codegen",)),
}
DEEPEST = 4  # files in the longest chain of imports inside a room of `diagnose`
MOST_FILES = 12  # in a room of `diagnose`
# Third-party libraries and the rooms that may import them; numpy may be imported by every room that computes.
ALLOWED = {
    "typer": {"cli"},
    "pydantic": {"vehicle", "ingest", "pipeline", "diagnose"},
    "jinja2": {"report"},
    "polars": {"ingest", "storage", "simulation", "report"},
    "rosbags": {"ingest"},
    "mcap": {"ingest"},
    "pymavlink": {"ingest"},
    "fastexcel": {"ingest"},
    "h5py": {"ingest"},
    "pyulog": {"ingest"},
    "pynmeagps": {"ingest"},
    "mcap_protobuf": {"ingest"},
    "zstandard": {"ingest"},
    "rerun": {"report"},
    "numba": {"plant", "effects"},
    "llvmlite": {"plant"},
    "scipy": {"alignment", "blind", "diagnose", "ingest", "plant", "report", "simulation"},
