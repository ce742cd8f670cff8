"""What computed the numbers of a report."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache


@cache
def versions() -> Mapping[str, str]:
    """Versions of Python and of the packages that the numbers depend on, by name."""
    import platform
    from importlib.metadata import PackageNotFoundError, version

    found = {"python": platform.python_version()}
    for package in ("rovval", "numpy", "scipy", "numba", "rerun-sdk"):
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            continue
    return found
