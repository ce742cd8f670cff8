"""The colours of curves: told apart by a reader with deuteranopia or protanopia, too, in light and dark, and in the recording."""

import itertools
import re
from pathlib import Path

import numpy as np
import pytest

from rovval import report
from rovval.report.recording.world import COLOURS

CHARTS = ("bg", "first", "second", "third", "fourth")
CURVES = ("bg", "measured", "windowed", "free", "other", "corrected")
# Machado, Oliveira and Fernandes (2009), table 1: severity 1, in linear RGB
DEUTERANOPIA = np.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]])
PROTANOPIA = np.array([[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]])
SRGB_TO_XYZ = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]])
WHITE = np.array([0.95047, 1.0, 1.08883])
APART = 25.0  # in CIELAB: ten times what is just noticeable side by side, for thin lines that lie over each other


def lab(rgb: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """CIELAB of a colour (0 to 1) as it is ``seen``."""
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    t = SRGB_TO_XYZ @ np.clip(seen @ linear, 0, 1) / WHITE
    f = np.where(t > 0.008856, np.cbrt(t), 7.787 * t + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def palettes() -> dict[str, dict[str, np.ndarray]]:
    css = (Path(report.__file__).parent / "assets" / "report.css").read_text()
    light, dark = (dict(re.findall(r"--([a-z]+): (#[0-9a-f]{3,6})[;\s]", part)) for part in css.split("prefers-color-scheme: dark", 1))
    found = {}
    for name, theme in (("light", light), ("dark", dark)):
        digits = {k: theme[k].lstrip("#") for k in {*CURVES, *CHARTS}}
        whole = {k: "".join(2 * c for c in h) if len(h) == 3 else h for k, h in digits.items()}
        found[name] = {k: np.array([int(h[i : i + 2], 16) for i in (0, 2, 4)]) / 255 for k, h in whole.items()}
    return found | {"recording": {k: np.array(v) / 255 for k, v in COLOURS.items()}}


@pytest.mark.parametrize("theme", ["light", "dark", "recording"])
@pytest.mark.parametrize("seen", [np.eye(3), DEUTERANOPIA, PROTANOPIA], ids=["all", "deuteranopia", "protanopia"])
def test_no_two_curves_look_alike(theme: str, seen: np.ndarray) -> None:
    """Measured and corrected were one colour to a deuteranope."""
    palette = palettes()[theme]
    colours = {name: lab(rgb, seen) for name, rgb in palette.items()}
    for together in (CURVES, CHARTS) if theme != "recording" else (tuple(palette),):
        near = {(a, b): float(np.linalg.norm(colours[a] - colours[b])) for a, b in itertools.combinations(together, 2)}
        assert min(near.values()) > APART, min(near, key=lambda pair: near[pair])
