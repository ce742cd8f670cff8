"""Places where things are kept: folders, and prefixes of an S3 object store (``s3://bucket/prefix``) that are used as folders are.

A place of an object store is a `upath.UPath`, which has pathlib's methods; credentials and endpoint are those of the AWS tools
(``AWS_ACCESS_KEY_ID``, ``AWS_ENDPOINT_URL``, ``~/.aws``). An object appears whole or not at all, and so does every file that is put there.
"""

from __future__ import annotations

import os
import posixpath
import re
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, cast

from rovval.core.errors import Unwritable, UsageProblem

SCHEME = "s3"
URL = re.compile(r"([A-Za-z][A-Za-z0-9+.-]+):/+")


def place(text: str | Path) -> Path:
    """The place of a path or of an address ``s3://bucket/prefix``.

    Raises `UsageProblem` for the address of anything else, which as a path would be a local folder of that name, lost with the machine; and where
    the library for object stores is not installed.
    """
    if not isinstance(text, str):
        if is_remote(text):
            return text
        text = str(text)
    if not (url := URL.match(text)):
        return Path(text)
    if url[1] != SCHEME:
        raise UsageProblem(
            f"{url[1]}://{text[url.end() :]}: {url[1]}:// is no place that rovval reads or writes, only folders and {SCHEME}:// are",
            "mount it as a folder (rclone mount, a volume of the cluster) and give that, or copy to it afterwards",
        )
    try:
        from upath import UPath
    except ImportError:
        raise UsageProblem(f"{text}: object stores need a library that is not installed", "pip install 'rovval[object-store]'") from None
    # a listing that was kept would not show what other processes wrote since
    return cast(Path, UPath(f"{SCHEME}://{text[url.end() :].rstrip('/')}", use_listings_cache=False))


def is_remote(path: Path) -> bool:
    """Whether a place is one of an object store."""
    return not isinstance(path, Path)


def below(base: Path, path: Path) -> Path:
    """``path`` as it stands in a file in ``base``: relative to it unless it is absolute or an address."""
    return path if is_remote(path) else base / path


def is_inside(path: Path, folder: Path) -> bool:
    """Whether ``path`` lies in ``folder``, or is it."""
    return is_remote(path) == is_remote(folder) and path.is_relative_to(folder)


def name_from(base: Path, path: Path) -> str:
    """How ``path`` is written in a record that stands in ``base``: relative to it where both lie on the same disk or in the same store."""
    if is_remote(base) and is_remote(path):
        return posixpath.relpath(_key(path), _key(base))
    if is_remote(base) or is_remote(path):
        return str(path) if is_remote(path) else str(path.absolute())
    return Path(os.path.relpath(path, base)).as_posix()


def named(base: Path, name: str) -> Path:
    """The place that `name_from` wrote as ``name``."""
    if URL.match(name) or posixpath.isabs(name):
        return place(name)
    if is_remote(base):
        return place(f"{SCHEME}://{posixpath.normpath(posixpath.join(_key(base), name))}")
    return Path(os.path.normpath(f"{base}/{name}"))


def status(base: Path, name: str) -> os.stat_result:
    """That of the place that `name_from` wrote as ``name``: as `named` finds it, but without making a path, which takes longer than the look at the
    disk; a batch looks at every output of every log. Raises OSError."""
    if is_remote(base) or URL.match(name):
        return named(base, name).stat()
    return os.stat(os.path.normpath(f"{base}/{name}"))  # noqa: PTH116


def stamp(path: Path) -> list[Any]:
    """What differs when a file was changed: its size, times and inode; of an object its size and tag."""
    if is_remote(path):
        facts = store(path).info(str(path))
        return [facts["size"], facts["ETag"]]
    status = path.stat()
    return [status.st_size, status.st_mtime_ns, status.st_ctime_ns, status.st_ino]


def put(draft: Path, target: Path) -> None:
    """A local file into an object store, in one step. Raises OSError and `Unwritable`."""
    with reached():
        store(target).put_file(str(draft), str(target))


@contextmanager
def fetched(path: Path) -> Iterator[Path]:
    """A log as local files, while the block lasts: itself, or what an object store has, folders (a ROS 2 bag) with all that is in them, and a dive
    file with the files that it names. Raises OSError and `Unwritable`."""
    if not is_remote(path):
        yield path
        return
    from rovval.ingest.files import files_of

    with tempfile.TemporaryDirectory(prefix="rovval-") as folder, reached():
        home = path.parent
        for part in {path, *files_of(path)} if not path.is_dir() else set(files_of(path)):
            local = Path(folder, posixpath.relpath(_key(part), _key(home)))
            local.parent.mkdir(parents=True, exist_ok=True)
            store(part).get_file(str(part), str(local))
        yield Path(folder, path.name)


def move(path: Path, target: Path) -> Path:
    """A file or folder to another place of the same disk or store; in a store it is copied, then removed. Raises OSError."""
    if is_remote(path):
        store(path).mv(str(path), str(target), recursive=path.is_dir())
        return target
    target.parent.mkdir(parents=True, exist_ok=True)
    return path.rename(target)


def remove(folder: Path) -> None:
    """A folder and all that is in it, as far as it can be."""
    if not is_remote(folder):
        shutil.rmtree(folder, ignore_errors=True)
    elif folder.exists():
        store(folder).rm(str(folder), recursive=True)


def store(path: Path) -> Any:
    """The file system (fsspec) of a place of an object store."""
    return cast(Any, path).fs


@contextmanager
def reached() -> Iterator[None]:
    """Raises `Unwritable` where what is in the block cannot reach an object store, or is not let in: no log's fault, so that a batch stops."""
    try:
        yield
    except Exception as error:
        if type(error).__module__.partition(".")[0] not in ("botocore", "aiobotocore", "aiohttp"):
            raise
        raise Unwritable(f"the object store cannot be used: {error}", "look at AWS_ENDPOINT_URL, the credentials and the network") from None


def _key(path: Path) -> str:
    """Bucket and key."""
    return URL.sub("", str(path), count=1)
