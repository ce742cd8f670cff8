"""An S3 server (moto's) on loopback, and a batch whose logs, archive and reports are in it."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import batch_case

from rovval.storage.places import place

BUCKET = "dives"


@contextmanager
def server() -> Iterator[str]:
    """The address of a server that has the bucket `BUCKET`; the credentials stand in the environment while the block lasts."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    address = f"http://127.0.0.1:{port}"
    mine = {"AWS_ACCESS_KEY_ID": "a", "AWS_SECRET_ACCESS_KEY": "b", "AWS_DEFAULT_REGION": "us-east-1", "AWS_ENDPOINT_URL": address}
    before = {name: os.environ.get(name) for name in mine}
    process = subprocess.Popen(
        [sys.executable, "-m", "moto.server", "-H", "127.0.0.1", "-p", str(port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        os.environ.update(mine)
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", port)) == 0:
                    break
            time.sleep(0.1)
        make_bucket()
        yield address
    finally:
        process.kill()
        process.wait()
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})


def make_bucket() -> None:
    import boto3

    boto3.client("s3").create_bucket(Bucket=BUCKET)


def objects(prefix: str = "") -> dict[str, int]:
    """Every object below a prefix, with its size, as Amazon's own client lists them."""
    import boto3

    pages = boto3.client("s3").get_paginator("list_objects_v2").paginate(Bucket=BUCKET, Prefix=prefix)
    return {found["Key"]: found["Size"] for page in pages for found in page.get("Contents", ())}


def content(key: str) -> bytes | None:
    """What an object holds; None where it is not there."""
    import boto3

    store = boto3.client("s3")
    try:
        held: bytes = store.get_object(Bucket=BUCKET, Key=key)["Body"].read()
    except store.exceptions.NoSuchKey:
        return None
    return held


def put(key: str, content: bytes) -> None:
    import boto3

    boto3.client("s3").put_object(Bucket=BUCKET, Key=key, Body=content)


def remove(key: str) -> None:
    import boto3

    boto3.client("s3").delete_object(Bucket=BUCKET, Key=key)


def write_site(folder: Path, prefix: str, logs: int = 3, *lines: str, steps: str = '["ingest"]') -> Path:
    """A pipeline file on this machine over s3://BUCKET/prefix: so many logs, archive, reports. Logs that are there are not put again: when they were
    put is the date of their dives."""
    root = f"s3://{BUCKET}/{prefix}"
    for number in range(logs):
        local, there = batch_case.write_log(folder / "made" / f"{number}.csv", seed=number), place(root) / "logs" / f"{number}.csv"
        if not there.exists():
            there.write_bytes(local.read_bytes())
    path = batch_case.write_pipeline(folder, *lines, steps=steps)
    text = path.read_text().replace('"archive"', f'"{root}/archive"').replace('"reports"', f'"{root}/reports"').replace('"logs/', f'"{root}/logs/')
    path.write_text(text)
    return path
