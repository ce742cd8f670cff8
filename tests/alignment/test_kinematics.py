"""Sums over a log in pieces are the sums over the whole."""

from __future__ import annotations

import numpy as np
import pytest

from rovval.alignment.kinematics import PIECE, Moments, channel_at, pieces, pose_against_velocities
from rovval.core.data import RawLog, Series


def test_moments_of_parts_are_those_of_the_whole():
    rng = np.random.default_rng(3)
    a, b = 40.0 + rng.normal(size=5000), rng.normal(size=5000)
    parts = [Moments.of(x, y) for x, y in zip(np.split(a, [0, 7, 3000]), np.split(b, [0, 7, 3000]), strict=True)]
    together, whole = parts[0] + parts[1] + parts[2] + parts[3], Moments.of(a, b)
    assert together.n == 5000
    assert [together.a, together.b, together.aa, together.ab, together.bb] == pytest.approx([whole.a, whole.b, whole.aa, whole.ab, whole.bb], rel=1e-12)


@pytest.mark.parametrize("n", [5, PIECE + 9, PIECE + 10, 2 * PIECE + 13])
def test_every_second_lies_in_one_piece(n):
    t, k = np.arange(n) * 0.1, 10
    steps = np.concatenate([t[piece][k:] for piece in pieces(t, k)] or [t[:0]])
    assert np.array_equal(steps, t[k:])


def test_a_channel_in_pieces_is_the_channel():
    t = np.arange(400.0) * 0.05
    series = Series(t[::3] + 0.013, np.angle(np.exp(1j * t[::3])), "row")
    whole = channel_at(series, t, angle=True)
    parts = np.concatenate([channel_at(series, part, angle=True) for part in np.split(t, [90, 200])])
    off = (parts - whole) / (2.0 * np.pi)  # each piece unwraps from a turn of its own
    assert np.allclose(off[np.isfinite(off)], np.round(off[np.isfinite(off)])) and np.array_equal(np.isfinite(parts), np.isfinite(whole))
    assert np.isnan(whole[0]) and np.isfinite(whole[1:-10]).all()


def test_a_log_longer_than_a_piece_tells_a_sign_from_all_of_it():
    """Depth runs with w in half of the first piece and against it in the longer rest."""
    n = 3 * PIECE
    t = np.arange(float(n)) * 0.02
    way = np.where(np.arange(n) < PIECE // 2, 1.0, -1.0)
    w = 0.2 * np.cos(0.5 * t)
    zero = np.zeros(n)
    columns = {"phi": zero, "theta": zero, "psi": zero, "u": zero, "v": zero, "w": w, "z": np.cumsum(way * w) * 0.02}
    raw = RawLog("x.csv", "ab" * 32, "test", "", None, {name: Series(t, values, "row") for name, values in columns.items()})
    (finding,) = pose_against_velocities(raw)
    assert finding.code == "sign" and finding.where == "z, w" and "-0.67" in finding.detail
