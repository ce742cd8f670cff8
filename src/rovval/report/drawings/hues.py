"""One colour a thruster, the same on every page and in every recording."""

from __future__ import annotations

from colorsys import hls_to_rgb


def hues(count: int) -> list[int]:
    """So many hues (degrees), evenly round the colour circle."""
    return [round(360 * j / count + 15) % 360 for j in range(count)]


def rgb(hue: int) -> tuple[int, int, int]:
    """The colour of a hue on a dark ground."""
    return tuple(round(255 * c) for c in hls_to_rgb(hue / 360, 0.62, 0.65))  # type: ignore[return-value]
