"""Compressed logs (gzip, bzip2, xz, Zstandard) as files that are unpacked while they are read; any other file as it is."""

from __future__ import annotations

import bz2
import errno
import io
import lzma
import tempfile
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO, cast

from rovval.core.errors import BadInput, Finding
from rovval.core.progress import Progress, silent

BLOCK = 1 << 16  # bytes of the packed file that are read at a time
PIECE = 1 << 10  # bytes of it that are unpacked at a time, and lost where the stream is damaged in one of them
NO_ROOM = (errno.ENOSPC, errno.EDQUOT)
SUFFIXES = (".gz", ".bz2", ".xz", ".zst", ".zstd")
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
    code = "cut_file" if ENDS_IN_THE_MIDDLE in raw.lost else "damaged_file"
    return (Finding(code, path.name, f"{raw.lost}; the {raw.size:,} bytes before are read"),)


@contextmanager
def unpacked(path: Path, progress: Progress = silent) -> Iterator[tuple[Path, tuple[Finding, ...]]]:
    """The content of a compressed file as a file of its own, which is gone afterwards, and what is lost of it; any other path as it is.

    What is refused meanwhile names the compressed file. Raises `BadInput` where nothing of it can be unpacked, or no room is left for it.
    """
    if not is_compressed(path):
        yield path, ()
        return
    with scratch_folder(path) as scratch:
        plain = scratch / (path.stem if path.suffix.lower() in SUFFIXES else path.name)
        with opened(path) as packed, plain.open("wb") as file:
            while block := packed.read(BLOCK):
                file.write(block)
                progress("unpacking", share_read(packed, path))
            lost = lost_of(packed, path)
        if not plain.stat().st_size:
            raise BadInput(f"{path}: {lost[0].detail if lost else 'holds nothing'}", "is the file whole? fetch or export it again")
        yield plain, lost


@contextmanager
def scratch_folder(path: Path) -> Iterator[Path]:
    """A folder for copies of what is read of ``path``, gone afterwards. What is refused meanwhile names ``path``, not its copy. Raises `BadInput` where
    there is no room for one."""
    with tempfile.TemporaryDirectory(prefix="rovval-") as folder:
        try:
            yield Path(folder)
        except BadInput as error:
            said = error.message.replace(str(Path(folder) / path.name), str(path)).replace(str(Path(folder) / path.stem), str(path))
            raise BadInput(said, error.hint) from None
        except OSError as error:
            if error.errno not in NO_ROOM:
                raise
            hint = f"it is copied into {tempfile.gettempdir()} to be read: make room there, or set TMPDIR"
            raise BadInput(f"{path}: {error.strerror}", hint) from None


def share_read(file: BinaryIO, path: Path) -> float:
    """The share of an opened file that is read, 0 to 1; of a compressed one by what is unpacked."""
    raw = getattr(file, "raw", file)
    return min((raw.packed if isinstance(raw, Unpacked) else file).tell() / max(path.stat().st_size, 1), 1.0)


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
        for piece in self._pieces():
            piece = piece if begun else piece.lstrip(b"\0")  # a tape is filled up with zeros behind the last stream
            while piece:
                try:
                    yield bytes(stream.decompress(piece))
                except (zlib.error, OSError, EOFError, lzma.LZMAError, zstandard.ZstdError) as error:
                    self.lost = f"its compressed stream ({self.kind}) is damaged: {error}"
                    return
                begun, piece = not stream.eof, b""
                if stream.eof:
                    piece, stream = stream.unused_data.lstrip(b"\0"), self.unpacker()
        if begun:
            self.lost = f"the file {ENDS_IN_THE_MIDDLE} ({self.kind})"

    def _pieces(self) -> Iterator[bytes]:
        while block := self.packed.read(BLOCK):
            yield from (block[at : at + PIECE] for at in range(0, len(block), PIECE))
