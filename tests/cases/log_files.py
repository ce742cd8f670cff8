"""A log of every format that is read, written by the format's own library where it has one, with the profile that reads it."""

from __future__ import annotations

import bz2
import gzip
import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import merlin_case
import numpy as np
import polars as pl
import zstandard
from bag_case import write as write_bag
from mcap.writer import CompressionType, Writer
from pynmeagps import NMEAMessage
from pyulog import ULog
from real_data import real
from rosbags.rosbag1 import Writer as Bag1
from scipy.io import savemat

N = 100
START_NS = 1_700_000_000_000_000_000
OWN = """
name = "own"
description = "of the tests"
format = "{format}"
frame = "fsd"
world = "ned"
[time]
kind = "{kind}"
[channels]
{channels}
"""


def own(folder: Path, form: str, kind: str, channels: str) -> str:
    """A profile of the tests, as a file."""
    path = folder / f"own_{form}.toml"
    path.write_text(OWN.format(format=form, kind=kind, channels=channels), encoding="utf-8")
    return str(path)


def table(n: int = 300) -> dict[str, Any]:
    """Merlin's columns as numbers."""
    return {name: np.array(cells, dtype=float) for name, cells in merlin_case.columns(n).items()}


def text(n: int = 300) -> bytes:
    """Merlin's table as text."""
    return merlin_case.text(merlin_case.columns(n)).encode()


def _file(path: Path, content: bytes) -> Path:
    path.write_bytes(content)
    return path


def workbook(path: Path) -> Path:
    """As an export has it: a banner, an empty row, and a second sheet that is no table."""
    import openpyxl

    book = openpyxl.Workbook()
    sheet: Any = book.active
    columns = table(60)
    for row in ([], ["Merlin, dive 7"], [], list(columns), *zip(*(c.tolist() for c in columns.values()), strict=True)):
        sheet.append(row)
    book.create_sheet("remarks").append(["the tether was caught"])
    book.save(path)
    return path


def hdf5(path: Path) -> Path:
    """A dataset a column."""
    with h5py.File(path, "w") as file:
        for name, values in table().items():
            file[name] = values
    return path


def parquet(path: Path) -> Path:
    """One table."""
    pl.DataFrame(table()).write_parquet(path)
    return path


def matlab(path: Path) -> Path:
    """Version 5, compressed, a structure."""
    savemat(path, {"log": table(), "mass": 11.5}, do_compression=True)
    return path


def matlab_73(path: Path) -> Path:
    """What Matlab's `save -v7.3` writes of a structure: HDF5 behind 512 bytes of its own, arrays transposed, their class an attribute."""
    with h5py.File(path, "w", userblock_size=512) as file:
        group = file.create_group("log")
        group.attrs["MATLAB_class"] = np.bytes_("struct")
        for name, values in table().items():
            group.create_dataset(name, data=values[None, :]).attrs["MATLAB_class"] = np.bytes_("double")
    with path.open("r+b") as raw:
        raw.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")
    return path


def _ulog_message(kind: str, body: bytes) -> bytes:
    return struct.pack("<HB", len(body), ord(kind)) + body


def ulog(path: Path) -> Path:
    """A vehicle that heads east and moves north: to port. PX4 developer guide, ULog file format; written out by pyulog."""
    out = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 5_000_000) + _ulog_message("B", bytes(40))
    formats = (
        "vehicle_attitude:uint64_t timestamp;float[4] q;",
        "vehicle_local_position:uint64_t timestamp;float vx;float vy;float vz;",
        "esc_status:uint64_t timestamp;float[2] rpm;",
    )
    for said in formats:
        out += _ulog_message("F", said.encode())
    for at, (said, instance) in enumerate(zip((*formats, formats[2]), (0, 0, 0, 1), strict=True)):
        out += _ulog_message("A", struct.pack("<BH", instance, at) + said.partition(":")[0].encode())
    half = np.sqrt(0.5)
    for i in range(N):
        us = 5_000_000 + i * 100_000
        out += _ulog_message("D", struct.pack("<HQ4f", 0, us, half, 0, 0, half)) + _ulog_message("D", struct.pack("<HQ3f", 1, us, 0.5, 0, 0.1))
        out += _ulog_message("D", struct.pack("<HQ2f", 2, us, 0, 0)) + _ulog_message("D", struct.pack("<HQ2f", 3, us, 60 * i, 0))
    path.write_bytes(out)
    ULog(str(path)).write_ulog(str(path))
    return path


ULOG_CHANNELS = """attitude = { topic = "vehicle_attitude", field = "q", unit = "quaternion" }
u = { topic = "vehicle_local_position", field = "vx", unit = "m/s", frame = "world" }
v = { topic = "vehicle_local_position", field = "vy", unit = "m/s", frame = "world" }
w = { topic = "vehicle_local_position", field = "vz", unit = "m/s", frame = "world" }
"n:T1" = { topic = "esc_status[1]", field = "rpm[0]", unit = "rpm" }"""


def mcap_json(path: Path) -> Path:
    """Messages as JSON, in chunks without compression."""
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=4096, compression=CompressionType.NONE)
        writer.start(profile="", library="tests")
        channel = writer.register_channel("/nav", "json", writer.register_schema("Nav", "jsonschema", b"{}"))
        for i in range(3 * N):
            ns = START_NS + i * 100_000_000
            writer.add_message(channel, ns, json.dumps({"timestamp": {"sec": ns // 10**9, "nsec": ns % 10**9}, "u": 0.01 * i}).encode(), ns)
        writer.finish()
    return path


def dvl(path: Path) -> Path:
    """Velocity reports as the instrument sends them, one a line."""
    lines = [
        {"vx": 0.01 * i, "vy": 0.0, "vz": 0.0, "altitude": 0.5, "velocity_valid": True, "type": "velocity", "format": "json_v3",
         "time_of_validity": START_NS // 1000 + 100_000 * i}
        for i in range(3 * N)
    ]  # fmt: skip
    return _file(path, "".join(json.dumps(line) + "\n" for line in lines).encode())


def nmea(path: Path) -> Path:
    """Heading at 5 Hz and depth at 1 Hz behind a logger's stamps."""
    lines = []
    for i in range(3 * N):
        stamp = f"{START_NS * 1e-9 + 0.2 * i:.3f} "
        lines.append(stamp + NMEAMessage("HE", "HDT", 0, headingT=10.0 + 0.2 * i, headingTu="T").serialize().decode().strip())
        if i % 5 == 0:
            lines.append(stamp + NMEAMessage("SD", "DPT", 0, depth=5.0 + 0.1 * i, offset=0.0, rangescale=100.0).serialize().decode().strip())
    return _file(path, "".join(f"{line}\n" for line in lines).encode())


NMEA_CHANNELS = """psi = { topic = "HDT", field = "headingT", unit = "deg" }
z = { topic = "DPT", field = "depth", unit = "m", optional = true }"""


def bag(folder: Path, compression: Any = None) -> Path:
    """A ROS 1 bag of some ten chunks."""
    prepare = None if compression is None else lambda writer: writer.set_compression(compression)
    return write_bag("bag", folder / "a.bag", 20_000, prepare)


Case = tuple[Callable[[Path], Path], Callable[[Path], str]]  # folder -> the file, folder -> its profile


def _of(profile: str) -> Callable[[Path], str]:
    return lambda folder: profile


CASES: dict[str, Case] = {
    "csv": (lambda folder: _file(folder / "a.csv", text()), _of("merlin")),
    "csv utf-16": (lambda folder: _file(folder / "a.csv", text().decode().encode("utf-16")), _of("merlin")),
    "csv.gz": (lambda folder: _file(folder / "a.csv.gz", gzip.compress(text())), _of("merlin")),
    "csv.bz2": (lambda folder: _file(folder / "a.csv.bz2", bz2.compress(text())), _of("merlin")),
    "csv.zst": (lambda folder: _file(folder / "a.csv.zst", zstandard.compress(text())), _of("merlin")),
    "xlsx": (lambda folder: workbook(folder / "a.xlsx"), _of("merlin")),
    "parquet": (lambda folder: parquet(folder / "a.parquet"), _of("merlin")),
    "mat v5": (lambda folder: matlab(folder / "a.mat"), _of("merlin")),
    "mat v7.3": (lambda folder: matlab_73(folder / "b.mat"), _of("merlin")),
    "hdf5": (lambda folder: hdf5(folder / "a.h5"), _of("merlin")),
    "bag": (bag, _of("ros_odometry")),
    "bag lz4": (lambda folder: bag(folder, Bag1.CompressionFormat.LZ4), _of("ros_odometry")),
    "bag bz2": (lambda folder: bag(folder, Bag1.CompressionFormat.BZ2), _of("ros_odometry")),
    "db3": (lambda folder: next(write_bag("db3", folder / "b").glob("*.db3")), _of("ros_odometry")),
    "mcap ros2": (lambda folder: next(write_bag("mcap", folder / "m").glob("*.mcap")), _of("ros_odometry")),
    "mcap json": (
        lambda folder: mcap_json(folder / "a.mcap"),
        lambda folder: own(folder, "mcap", "header", 'u = { topic = "/nav", field = "u", unit = "m/s" }'),
    ),
    "ulg": (lambda folder: ulog(folder / "a.ulg"), lambda folder: own(folder, "ulog", "header", ULOG_CHANNELS)),
    "json lines": (lambda folder: dvl(folder / "a.jsonl"), _of("dvl_a50")),
    "nmea": (lambda folder: nmea(folder / "a.nmea"), lambda folder: own(folder, "nmea", "record", NMEA_CHANNELS)),
    "bin": (lambda folder: _file(folder / "a.BIN", real("ardusub/small.BIN").read_bytes()), _of("ardusub_vectored")),
    "tlog": (lambda folder: _file(folder / "a.tlog", real("ardusub/small.tlog").read_bytes()[:200_000]), _of("ardusub_tlog")),
}
