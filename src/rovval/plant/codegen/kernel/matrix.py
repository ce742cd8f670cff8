"""Products with the 6 x 6 matrices of a lane, kept as 36 rows or, where they are diagonals, as six. Sums run from left to right."""

from __future__ import annotations

from rovval.plant.codegen.kernel.symbols import DENSE, Array, Lanes, W

Six = tuple[Lanes, Lanes, Lanes, Lanes, Lanes, Lanes]


def product(m: Array, first: int, i: int, j: int, x: Six) -> Lanes:
    """Row ``i`` of the matrix from row ``first`` on, times a vector."""
    return (
        m[(first + 6 * i) * W + j] * x[0] + m[(first + 6 * i + 1) * W + j] * x[1] + m[(first + 6 * i + 2) * W + j] * x[2]
        + m[(first + 6 * i + 3) * W + j] * x[3] + m[(first + 6 * i + 4) * W + j] * x[4] + m[(first + 6 * i + 5) * W + j] * x[5]
        if DENSE else m[(first + i) * W + j] * x[i]
    )  # fmt: skip


def plus_product(start: Lanes, m: Array, first: int, i: int, j: int, x: Six) -> Lanes:
    """``start`` and row ``i`` of the matrix times a vector."""
    return (
        start
        + m[(first + 6 * i) * W + j] * x[0] + m[(first + 6 * i + 1) * W + j] * x[1] + m[(first + 6 * i + 2) * W + j] * x[2]
        + m[(first + 6 * i + 3) * W + j] * x[3] + m[(first + 6 * i + 4) * W + j] * x[4] + m[(first + 6 * i + 5) * W + j] * x[5]
        if DENSE else start + m[(first + i) * W + j] * x[i]
    )  # fmt: skip


def plus_translation(start: Lanes, m: Array, first: int, i: int, j: int, x: Lanes, y: Lanes, z: Lanes) -> Lanes:
    """``start`` and row ``i`` of the matrix times a vector without turn, (x, y, z, 0, 0, 0): nothing of a diagonal from the fourth row on."""
    return (
        start + m[(first + 6 * i) * W + j] * x + m[(first + 6 * i + 1) * W + j] * y + m[(first + 6 * i + 2) * W + j] * z
        if DENSE else start + m[(first + i) * W + j] * (x, y, z)[i] if i < 3 else start
    )  # fmt: skip


def symmetric_product(m: Array, first: int, i: int, j: int, x: Six) -> Lanes:
    """Row ``i`` of a symmetric matrix, kept as its upper triangle row by row (21), times a vector."""
    return (
        m[(first + triangle(i, 0)) * W + j] * x[0] + m[(first + triangle(i, 1)) * W + j] * x[1] + m[(first + triangle(i, 2)) * W + j] * x[2]
        + m[(first + triangle(i, 3)) * W + j] * x[3] + m[(first + triangle(i, 4)) * W + j] * x[4] + m[(first + triangle(i, 5)) * W + j] * x[5]
    )  # fmt: skip


def triangle(i: int, k: int) -> int:
    """Place of entry (i, k) in the upper triangle of a symmetric 6 x 6 matrix, row by row."""
    return 6 * min(i, k) - min(i, k) * (min(i, k) + 1) // 2 + max(i, k)
