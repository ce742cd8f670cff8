"""What somebody meant who typed a name that is not there: the nearest of those that are."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

ALIKE = 0.6  # of the characters, in order: difflib's own limit for words
MOST = 3


def near(name: str, known: Iterable[str]) -> list[str]:
    """The nearest names, the nearest first; upper and lower case are one."""
    plain = {k.lower(): k for k in known}
    return [plain[k] for k in difflib.get_close_matches(name.lower(), list(plain), n=MOST, cutoff=ALIKE)]


def suggestion(name: str, known: Iterable[str], all_of_them: str) -> str:
    """The next step of a refusal: the names that were probably meant and where all of them are, else all of them."""
    names = list(known)
    close = near(name, names)
    return f"did you mean {' or '.join(close)}? {all_of_them} has all" if close else f"use one of: {', '.join(names)}"
