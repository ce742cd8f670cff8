"""What the log gives a block of lanes: thruster speeds at both ends of a step, and the speeds that lags remember at a window's start."""

from __future__ import annotations

import math

from rovval.plant.codegen.kernel.symbols import (  # isort: skip
    ENDS, FULL, LAG, MEMORY, SHIFT, THRUSTERS, Array, W, compiled_function, in_turn,
)  # fmt: skip


@compiled_function
def logged(speed: Array, t: Array, start: Array, step: int, m: Array, end: int) -> None:
    """Logged thruster speeds (rev/s) at one end of a step, each lane at its own place in the log, linear between samples where it is shifted."""
    last = speed.shape[0] - 1
    for j in range(W):
        k = min(max(start[j] + step, 0), last)
        if FULL:
            x = k - (m[SHIFT * W + j] + m[(SHIFT + 1) * W + j] * t[k])
            x = min(max(x, 0.0), float(last))
            k = min(int(x), max(last - 1, 0))
            part = x - k
            after = min(k + 1, last)
        for i in range(THRUSTERS):
            n = speed[k, i]
            if FULL:
                n = n + (speed[after, i] - n) * part
                n = in_turn("speed", n, m, i, j)
            m[(ENDS + end * THRUSTERS + i) * W + j] = n


@compiled_function
def lag_memory(speed: Array, t: Array, start: Array, dt: float, hold: bool, m: Array) -> None:
    """Lagged speed of each thruster at the window's first sample, from the log's first sample or 40 time constants before: the exact answer of
    tau dn/dt = u - n to speeds that are held or run linearly between samples."""
    longest, back = 0.0, 0
    for j in range(W):
        longest = max(longest, m[LAG * W + j])
    if longest > 0.0:
        for j in range(W):
            back = max(back, min(start[j], int(40.0 * longest / dt) + 1))
    logged(speed, t, start, -back, m, 0)
    for c in range(THRUSTERS * W):
        m[MEMORY * W + c] = m[ENDS * W + c]
    for step in range(-back, 0):
        logged(speed, t, start, step + 1, m, 1)
        for j in range(W):
            if start[j] + step < 0:
                continue
            tau = m[LAG * W + j]
            left = math.exp(-dt / tau) if tau > 0.0 else 0.0
            for i in range(THRUSTERS):
                a = m[(ENDS + i) * W + j]
                b = a if hold else m[(ENDS + THRUSTERS + i) * W + j]
                slope = (b - a) / dt * tau
                m[(MEMORY + i) * W + j] = b - slope + (m[(MEMORY + i) * W + j] - a + slope) * left
        for c in range(THRUSTERS * W):
            m[ENDS * W + c] = m[(ENDS + THRUSTERS) * W + c]
    for j in range(W):
        if start[j] == 0 or m[LAG * W + j] == 0.0:
            for i in range(THRUSTERS):
                m[(MEMORY + i) * W + j] = m[(ENDS + i) * W + j]


def speeds_of_step(m: Array, speed: Array, t: Array, start: Array, step: int, hold: bool) -> None:
    """Thruster speeds at both ends of a step: where one ends, the next begins, but for commands, which are held until the next sample."""
    if step == 0 or hold:
        logged(speed, t, start, step, m, 0)
    else:
        for c in range(THRUSTERS * W):
            m[ENDS * W + c] = m[(ENDS + THRUSTERS) * W + c]
    if hold:
        for c in range(THRUSTERS * W):
            m[(ENDS + THRUSTERS) * W + c] = m[ENDS * W + c]
    else:
        logged(speed, t, start, step + 1, m, 1)
