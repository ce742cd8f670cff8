"""Names of files and folders that are made of the name of a log."""

from __future__ import annotations

LONGEST = 200  # bytes; a file system takes 255, of which a digest, a process's number and ".part" need up to 40


def shortened(stem: str) -> str:
    """``stem``, cut to `LONGEST` bytes of UTF-8 between two characters; what makes a name unique is to be added after it."""
    return stem.encode()[:LONGEST].decode(errors="ignore")


def printable(name: str) -> str:
    """A name as text that can be written anywhere: bytes that are no UTF-8, which Python keeps as lone surrogates, as ``\\xff``."""
    return name.encode(errors="surrogateescape").decode(errors="backslashreplace")
