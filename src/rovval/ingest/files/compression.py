"""Compressed logs (gzip, bzip2, xz, Zstandard) as files that are unpacked while they are read; any other file as it is."""

from __future__ import annotations

import bz2
import io
import lzma
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, BinaryIO, cast

from rovval.core.errors import Finding

BLOCK = 1 << 16  # bytes of the packed file that are read at a time, and lost where the stream is damaged in one of them
SUFFIXES = (".gz", ".bz2", ".xz", ".zst")
ENDS_IN_THE_MIDDLE = "ends in the middle of its compressed stream"


def _gzip() -> Any:
    return zlib.decompressobj(wbits=31)  # 16 + 15: a gzip header, the largest window (zlib's manual)


def _zstandard() -> Any:
    import zstandard

    return zstandard.ZstdDecompressor().decompressobj()


MAGIC: dict[bytes, tuple[str, Callable[[], Any]]] = {
    b"\x1f\x8b\x08": ("gzip", _gzip),  # RFC 1952: magic and the only method
    b"BZh": ("bzip2", bz2.BZ2Decompressor),
    b"\xfd7zXZ\0": ("xz", lzma.LZMADecompressor),
    b"\x28\xb5\x2f\xfd": ("Zstandard", _zstandard),  # RFC 8878, 3.1.1
}


def suffix(path: Path) -> str:
    """What a log's name ends in, in lower case, without the suffix of its compression: ``.csv`` of ``dive.csv.gz``."""
    ends = path.suffix.lower()
    return Path(path.stem).suffix.lower() if ends in SUFFIXES else ends


def is_compressed(path: Path) -> bool:
    """Whether the file begins as a compressed one does, whatever its name. Raises OSError for one that cannot be read."""
    if path.is_dir():
        return False
    with path.open("rb") as file:
        return file.read(8).startswith(tuple(MAGIC))


def opened(path: Path) -> BinaryIO:
    """The content of a file, unpacked while it is read; `lost_of` says afterwards whether the end was missing. Raises OSError."""
    file = path.open("rb")
    head = file.read(8)
    file.seek(0)
    for magic, (name, unpacker) in MAGIC.items():
        if head.startswith(magic):
            return cast(BinaryIO, io.BufferedReader(Unpacked(file, name, unpacker), BLOCK))
    return file


def lost_of(file: BinaryIO, path: Path) -> tuple[Finding, ...]:
    """What an opened file that was read to its end could not be unpacked of: () where it is whole or was not compressed."""
    raw = getattr(file, "raw", None)
    if not isinstance(raw, Unpacked) or not raw.lost:
        return ()
    return (Finding("cut_file", path.name, f"{raw.lost}; the {raw.size} bytes before are read"),)


class Unpacked(io.RawIOBase):
    """The unpacked bytes of a compressed file. It ends where the stream is cut or damaged, and ``lost`` says so then; ``size`` bytes
    were unpacked so far. Streams that follow one another (`cat a.gz b.gz`) are one."""

    def __init__(self, packed: BinaryIO, kind: str, unpacker: Callable[[], Any]) -> None:
        self.packed, self.kind, self.unpacker = packed, kind, unpacker
        self.blocks, self.rest, self.size, self.lost = self._blocks(), b"", 0, ""

    def readable(self) -> bool:
        """It is."""
        return True

    def close(self) -> None:
        """Close the packed file, too."""
        self.packed.close()
        super().close()

    def readinto(self, buffer: Any, /) -> int:
        """Fill the buffer as far as the next block goes; 0 at the end."""
        into = memoryview(buffer).cast("B")
        while not self.rest and (block := next(self.blocks, None)) is not None:
            self.rest = block
        count = min(len(into), len(self.rest))
        into[:count], self.rest = self.rest[:count], self.rest[count:]
        self.size += count
        return count

    def _blocks(self) -> Iterator[bytes]:
        import zstandard

        stream, begun = self.unpacker(), False
        block = self.packed.read(BLOCK)
        while block:
            try:
                yield bytes(stream.decompress(block))
            except (zlib.error, OSError, EOFError, lzma.LZMAError, zstandard.ZstdError) as error:
                self.lost = f"its compressed stream ({self.kind}) is damaged: {error}"
                return
            begun, block = not stream.eof, b""
            if stream.eof:
                block, stream = stream.unused_data, self.unpacker()
            block = block or self.packed.read(BLOCK)
            if not begun:
                block = block.lstrip(b"\0")  # a tape is filled up with zeros behind the last stream
        if begun:
            self.lost = f"the file {ENDS_IN_THE_MIDDLE} ({self.kind})"
