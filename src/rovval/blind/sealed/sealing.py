"""A seal on labels: hidden from eyes and guarded against change, with the standard library alone.

The text is XORed with a keystream (HMAC-SHA-256 in counter mode) and carries an HMAC; both keys come by scrypt from a random key file
that lies apart. It keeps honest people honest and makes every unsealing a deliberate act; whoever holds the key file, or the seed
and this code, can read the labels. It is no protection against a determined attacker.
"""

from __future__ import annotations

import hashlib
import hmac
import secrets
from collections.abc import Iterable
from pathlib import Path

from rovval.core.errors import BadInput, UsageProblem

MAGIC = b"rovval.blind-seal/1\n"
SALT, TAG, BLOCK = 16, 32, 32
COST = {"n": 2**14, "r": 8, "p": 1, "maxmem": 64 * 2**20}  # scrypt: a tenth of a second and 16 MB


def new_key(path: Path) -> bytes:
    """Write a random key that only its owner reads; an existing key is never replaced."""
    if path.exists():
        raise UsageProblem(f"{path} exists and may open another set", "give another --key, or move that file away")
    path.parent.mkdir(parents=True, exist_ok=True)
    key = secrets.token_hex(32)
    path.touch(mode=0o600)
    path.write_text(key + "\n", encoding="ascii")
    return key.encode()


def read_key(path: Path) -> bytes:
    """The key of a set."""
    if not path.is_file():
        raise UsageProblem(f"{path}: no key there", "give --key with the file that `rovval blind make` wrote")
    return path.read_text(encoding="ascii").strip().encode()


def seal(text: bytes, key: bytes) -> bytes:
    """Sealed form of ``text``; another one each time."""
    salt = secrets.token_bytes(SALT)
    stream, guard = _keys(key, salt)
    hidden = _mixed(text, stream)
    return MAGIC + salt + hmac.digest(guard, salt + hidden, "sha256") + hidden


def unseal(sealed: bytes, key: bytes) -> bytes:
    """The text again. Raises `BadInput` where the seal is damaged or the key is another's."""
    if not sealed.startswith(MAGIC):
        raise BadInput("the labels are not sealed by rovval", "restore labels.sealed as `rovval blind make` wrote it")
    rest = sealed[len(MAGIC) :]
    salt, tag, hidden = rest[:SALT], rest[SALT : SALT + TAG], rest[SALT + TAG :]
    stream, guard = _keys(key, salt)
    if not hmac.compare_digest(tag, hmac.digest(guard, salt + hidden, "sha256")):
        raise BadInput("the seal of the labels does not fit this key", "give the key of this set, or restore labels.sealed")
    return _mixed(hidden, stream)


def digest(path: Path) -> str:
    """SHA-256 of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def digest_of_files(files: Iterable[Path]) -> str:
    """One SHA-256 over names and contents of files, in the order of their names."""
    lines = [f"{path.name} {digest(path)}\n" for path in sorted(files, key=lambda p: p.name)]
    return hashlib.sha256("".join(lines).encode()).hexdigest()


def _keys(key: bytes, salt: bytes) -> tuple[bytes, bytes]:
    both = hashlib.scrypt(key, salt=salt, dklen=64, **COST)
    return both[:32], both[32:]


def _mixed(text: bytes, stream: bytes) -> bytes:
    blocks = range(len(text) // BLOCK + 1)
    pad = b"".join(hmac.digest(stream, number.to_bytes(8, "big"), "sha256") for number in blocks)
    return bytes(a ^ b for a, b in zip(text, pad, strict=False))
