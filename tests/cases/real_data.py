"""Where the published logs lie; tests that need one skip, saying so, where it is absent."""

from __future__ import annotations

from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[3] / "shared" / "data"


def real(name: str) -> Path:
    """Path of a published log, or a skip."""
    path = FOLDER / name
    if not path.exists():
        pytest.skip(f"published log {path} is not on this machine")
    return path
