"""Thrust at rest in the water at one stage time, and its wrench: what does not depend on the motion, once for the stages that share a time.

Thruster speeds are taken at the stage times: frozen over the step they make the whole scheme first order (measured).
"""

from __future__ import annotations

from rovval.plant.codegen.kernel.symbols import (  # isort: skip
    ADVANCE, BODY, ENDS, FLOW, FULL, JET, LAG, LAGGED, LOG_ROWS, MEMORY, NEXT, STRIDE, THRUSTERS, WRENCH, Array, Lanes, W,
    at_work, compiled_function, effect_value, effects_of, spread, unrolled,
)  # fmt: skip


def thrust_of_stage(
    m: Array, tv: Array, lv: Array, la: Array, geo: Array, pairs: Array, weights: Array, acts: Array, b: int, s: int, f: float, f0: float,
    inv_dt: float, use_log: bool, use_rest: bool, use_wake: bool, use_side: bool, use_extra: bool,
) -> None:  # fmt: skip
    """Everything of a stage time, ``f`` of the way through the sample: the log, acting speed and thrust of each thruster, their wrench."""
    if not FLOW:
        wrench_at_rest(m, tv, s, f, f0, inv_dt)
    if FULL and use_log:
        for c in range(LOG_ROWS * W):
            lv[c] = la[c] + (la[LOG_ROWS * W + c] - la[c]) * f
    if FLOW:
        speeds_at_work(m, tv, s, f, f0, inv_dt)
        if FULL and use_rest:
            change_speeds(m, tv, lv, acts, b)
        thrusts_at_rest(m, tv, geo)
        if FULL and use_rest:
            change_thrusts(m, tv, lv, acts, b)
    if FULL and use_wake:
        lost_in_jets(m, tv, pairs, weights)
    if FLOW:
        wrench_of_thrusts(m, tv)
    if FULL and use_side:
        side_force(m, tv, geo)
    if FULL and use_extra:
        for c in range(6 * W):
            tv[3 * THRUSTERS * W + c] += lv[WRENCH * W + c]


def speed_at_work(m: Array, i: int, j: int, s: int, f: float, f0: float, inv_dt: float) -> Lanes:
    """Speed (rev/s) at which thruster ``i`` turns: the logged one, behind a lag that is exact for a speed that runs linearly from ``f0`` to ``f``."""
    if LAGGED:
        tau, left = m[LAG * W + j], m[(LAG + 1 + s) * W + j]
    a = m[(ENDS + i) * W + j]
    d = m[(ENDS + THRUSTERS + i) * W + j] - a
    n = a + d * f
    if LAGGED:
        slope = d * inv_dt * tau
        n = n - slope + (m[(MEMORY + i) * W + j] - (a + d * f0) + slope) * left
        m[(NEXT + i) * W + j] = n
    return n


def thrust_at_rest(m: Array, i: int, j: int, n: Lanes) -> Lanes:
    """Thrust of thruster ``i`` (N, thesis 3.14) at a speed: k n |n|, k of its own for each sense."""
    ahead, astern = 0.5 * (abs(n) + n), 0.5 * (abs(n) - n)
    return m[(BODY + i * STRIDE) * W + j] * ahead * ahead - m[(BODY + i * STRIDE + 1) * W + j] * astern * astern


def speeds_at_work(m: Array, tv: Array, s: int, f: float, f0: float, inv_dt: float) -> None:
    """Speed of every thruster, kept for the stages."""
    for j in range(W):
        for i in unrolled(THRUSTERS):
            tv[(3 * i + 1) * W + j] = speed_at_work(m, i, j, s, f, f0, inv_dt)


@compiled_function
def change_speeds(m: Array, tv: Array, lv: Array, acts: Array, b: int) -> None:
    """What effects make of these speeds, one after the other."""
    for effect in effects_of("acting"):
        if at_work(acts, b, effect):
            for j in range(W):
                for i in unrolled(THRUSTERS):
                    tv[(3 * i + 1) * W + j] = effect_value("acting", effect, m, j, i=i, log=lv, n=tv[(3 * i + 1) * W + j])[0]


def thrusts_at_rest(m: Array, tv: Array, geo: Array) -> None:
    """Thrust at rest of every thruster at its speed, kept for the stages."""
    for j in range(W):
        for i in unrolled(THRUSTERS):
            n = tv[(3 * i + 1) * W + j]
            tv[3 * i * W + j] = thrust_at_rest(m, i, j, n)
            if ADVANCE:
                tv[(3 * i + 2) * W + j] = n / (geo[16 * i + 15] * (n * n + 1e-12))  # J_a = u_a n / (D n^2)


@compiled_function
def change_thrusts(m: Array, tv: Array, lv: Array, acts: Array, b: int) -> None:
    """What effects make of these thrusts, one after the other."""
    for effect in effects_of("static"):
        if at_work(acts, b, effect):
            for j in range(W):
                for i in unrolled(THRUSTERS):
                    tv[3 * i * W + j] = effect_value("static", effect, m, j, i=i, log=lv, T=tv[3 * i * W + j], n=tv[(3 * i + 1) * W + j])[0]


def wrench_at_rest(m: Array, tv: Array, s: int, f: float, f0: float, inv_dt: float) -> None:
    """Wrench of all thrusters where thrust does not depend on the motion."""
    for j in range(W):
        X = Y = Z = K = M = N = 0.0
        for i in unrolled(THRUSTERS):
            n = speed_at_work(m, i, j, s, f, f0, inv_dt)
            T = thrust_at_rest(m, i, j, n)
            X, Y, Z, K, M, N = with_force(m, i, j, T, X, Y, Z, K, M, N)
        put_wrench(tv, 0, j, X, Y, Z, K, M, N)


def wrench_of_thrusts(m: Array, tv: Array) -> None:
    """Wrench of the thrusts at rest."""
    for j in range(W):
        X = Y = Z = K = M = N = 0.0
        for i in unrolled(THRUSTERS):
            T = tv[3 * i * W + j]
            X, Y, Z, K, M, N = with_force(m, i, j, T, X, Y, Z, K, M, N)
        put_wrench(tv, 3 * THRUSTERS, j, X, Y, Z, K, M, N)


def with_force(
    m: Array, i: int, j: int, T: Lanes, X: Lanes, Y: Lanes, Z: Lanes, K: Lanes, M: Lanes, N: Lanes
) -> tuple[Lanes, Lanes, Lanes, Lanes, Lanes, Lanes]:
    """The wrench with ``T`` newtons of thruster ``i`` more: direction and moment of 1 N of it, tau = T_c F_T (thesis 3.15)."""
    X += T * m[(BODY + i * STRIDE + 2) * W + j]
    Y += T * m[(BODY + i * STRIDE + 3) * W + j]
    Z += T * m[(BODY + i * STRIDE + 4) * W + j]
    K += T * m[(BODY + i * STRIDE + 5) * W + j]
    M += T * m[(BODY + i * STRIDE + 6) * W + j]
    N += T * m[(BODY + i * STRIDE + 7) * W + j]
    return X, Y, Z, K, M, N


def put_wrench(tv: Array, row: int, j: int, X: Lanes, Y: Lanes, Z: Lanes, K: Lanes, M: Lanes, N: Lanes) -> None:
    """The wrench into six rows from ``row`` on."""
    tv[(row + 0) * W + j] = X
    tv[(row + 1) * W + j] = Y
    tv[(row + 2) * W + j] = Z
    tv[(row + 3) * W + j] = K
    tv[(row + 4) * W + j] = M
    tv[(row + 5) * W + j] = N


def add_wrench(into: Array, row: int, j: int, X: Lanes, Y: Lanes, Z: Lanes, K: Lanes, M: Lanes, N: Lanes) -> None:
    """The wrench added to six rows from ``row`` on."""
    into[(row + 0) * W + j] += X
    into[(row + 1) * W + j] += Y
    into[(row + 2) * W + j] += Z
    into[(row + 3) * W + j] += K
    into[(row + 4) * W + j] += M
    into[(row + 5) * W + j] += N


def lost_in_jets(m: Array, tv: Array, pairs: Array, weights: Array) -> None:
    """Share of its thrust that each thruster loses in another's jet (effect ``thruster_interaction``): both at work, and by the slower of the two."""
    for pair in range(pairs.shape[0]):
        row, other, first_row = 3 * pairs[pair, 1] * W, 3 * pairs[pair, 0] * W, (BODY + pairs[pair, 1] * STRIDE) * W
        wa, ws, wake = weights[pair, 0], weights[pair, 1], (JET + pairs[pair, 1]) * W
        for j in range(W):
            n, up = tv[row + W + j], tv[other + W + j]
            jet = (wa if up > 0.0 else ws) * min(abs(up), abs(n))
            own = 0.5 * (m[first_row + j] * (n + abs(n)) + m[first_row + W + j] * (n - abs(n)))
            tv[row + j] -= m[wake + j] * jet * own


@compiled_function
def side_force(m: Array, tv: Array, geo: Array) -> None:
    """Side force of every thruster on the hull beside it (effect ``hull_interaction``), from its thrust at rest."""
    g = spread(geo, 16 * THRUSTERS)
    for j in range(W):
        X = Y = Z = K = M = N = 0.0
        for i in unrolled(THRUSTERS):
            S = abs(tv[3 * i * W + j]) * m[(JET + THRUSTERS) * W + j]
            X += S * g[16 * i + 9]
            Y += S * g[16 * i + 10]
            Z += S * g[16 * i + 11]
            K += S * g[16 * i + 12]
            M += S * g[16 * i + 13]
            N += S * g[16 * i + 14]
        add_wrench(tv, 3 * THRUSTERS, j, X, Y, Z, K, M, N)
