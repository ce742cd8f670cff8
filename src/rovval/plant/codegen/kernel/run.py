"""Time, step by step: what the compiled kernel is called by."""

from __future__ import annotations

import math

from rovval.plant.codegen.kernel.body import equations_of_motion
from rovval.plant.codegen.kernel.effects import effects_on_state, loops_needed, take_payload
from rovval.plant.codegen.kernel.explicit import explicit_step
from rovval.plant.codegen.kernel.log import lag_memory, speeds_of_step
from rovval.plant.codegen.kernel.step import halt, record, take_step

from rovval.plant.codegen.kernel.symbols import (  # isort: skip
    ALIVE, EULER, EXPLICIT, FULL, INPUT_ROWS, JET, LAGGED, LOG_ROWS, MEMORY, NEXT, ROWS, STATE, THRUST_ROWS, THRUSTERS, TIME, Array, W,
    compiled_function,
)  # fmt: skip
from rovval.plant.codegen.kernel.thrust import thrust_of_stage
from rovval.plant.codegen.runtime import aligned, load_log


@compiled_function
def run(
    first: int, last: int, numbers: Array, acts: Array, late: Array, onset: Array, states: Array, start: Array, limit: Array, which: Array,
    gain: Array, speed: Array, log: Array, t: Array, extra: Array, geo: Array, pairs: Array, weights: Array, dt: float, hold: bool, steps: int,
    substeps: int, out: Array, stopped: Array, reason: Array,
) -> None:  # fmt: skip
    """Blocks ``first`` to ``last`` of W lanes each: time runs inside the block, so that its numbers stay in the cache."""
    h, inv_dt = dt / substeps, 1.0 / dt
    m, th = aligned(ROWS * W), aligned(3 * THRUST_ROWS * W)
    la, lg = aligned(2 * LOG_ROWS * W), aligned(3 * LOG_ROWS * W)
    for b in range(first, last):
        load_block(m, numbers, states, b)
        use_extra, use_wake, use_side, pending, least = lanes_of_block(m, b, onset, limit, which, steps)
        if FULL:
            use_rest, use_water, use_cross, use_flow, use_state, use_log = loops_needed(acts, b, use_extra, pending)
            clear_log(la, lg)
        if LAGGED:
            lag_memory(speed, t, start[b], dt, hold, m)
        record(m, out, 0, b * W)
        begin = 0
        for step in range(steps):
            if step >= least:
                halt(m, stopped[b], reason[b], limit[b], step)
            speeds_of_step(m, speed, t, start[b], step, hold)
            if FULL and use_log:
                load_log(log, t, extra, gain[b], which[b], start[b], step, dt, la, use_extra, W, LOG_ROWS)
            for sub in range(substeps):
                f0, f1 = sub / substeps, (sub + 1) / substeps
                again = 0
                if not hold and step + sub > 0:  # a step begins where the last one ended
                    again, begin = 1, 2 - begin
                thrust_over_substep(
                    m, th, lg, la, geo, pairs, weights, acts, b, again, begin, f0, f1, inv_dt, use_log, use_rest, use_wake, use_side, use_extra
                )
                if FULL and pending:
                    take_payload(m, late, onset, b, (begin * LOG_ROWS + TIME) * W, lg)
                if LAGGED:
                    remember_lag(m)
                if EXPLICIT:
                    inverse_h = 1.0 / h if step + sub > 0 else 0.0
                    engine_over_substep(m, th, lg, geo, acts, b, begin, h, inverse_h, use_state, use_water, use_cross, use_flow)
                else:
                    motion_over_substep(m, th, lg, geo, acts, b, begin, h, use_state, use_water, use_cross, use_flow)
                take_step(m, stopped[b], reason[b], step)
            record(m, out, step + 1, b * W)


def thrust_over_substep(
    m: Array, th: Array, lg: Array, la: Array, geo: Array, pairs: Array, weights: Array, acts: Array, b: int, again: int, begin: int, f0: float, f1: float,
    inv_dt: float, use_log: bool, use_rest: bool, use_wake: bool, use_side: bool, use_extra: bool,
) -> None:  # fmt: skip
    """Thrust, and what effects need of the log, at the start, the middle and the end of a substep; from the middle on where it goes on from the last."""
    for s in range(again, 3):
        f = f0 + (f1 - f0) * 0.5 * s
        slot = 1 + (s - 1) * (1 - begin)
        tv = th[slot * (THRUST_ROWS * W) : (slot + 1) * (THRUST_ROWS * W)]
        if FULL:
            lv = lg[slot * LOG_ROWS * W : (slot + 1) * LOG_ROWS * W]
        thrust_of_stage(m, tv, lv, la, geo, pairs, weights, acts, b, s, f, f0, inv_dt, use_log, use_rest, use_wake, use_side, use_extra)


def motion_over_substep(
    m: Array, th: Array, lg: Array, geo: Array, acts: Array, b: int, begin: int, h: float, use_state: bool, use_water: bool, use_cross: bool,
    use_flow: bool,
) -> None:  # fmt: skip
    """The four stages of a Runge-Kutta step of length ``h`` (s), each with the effects that act on its state."""
    for stage in range(4):
        slot = 1 + ((stage + 1) // 2 - 1) * (1 - begin)
        tv = th[slot * (THRUST_ROWS * W) : (slot + 1) * (THRUST_ROWS * W)]
        if FULL:
            lv = lg[slot * LOG_ROWS * W : (slot + 1) * LOG_ROWS * W]
        xs, xn = (STATE + 13 * stage) * W, (STATE + 13 * stage + 13) * W
        reach = -0.5 * h if stage == 3 else (h if stage == 2 else 0.5 * h)
        half = 0.5 * reach
        effects_on_state(m, tv, lv, geo, acts, b, xs, use_state, use_water, use_cross, use_flow)
        equations_of_motion(m, tv, xs, xn, reach, half)


def engine_over_substep(
    m: Array, th: Array, lg: Array, geo: Array, acts: Array, b: int, begin: int, h: float, inverse_h: float, use_state: bool, use_water: bool,
    use_cross: bool, use_flow: bool,
) -> None:  # fmt: skip
    """A physics engine's step of length ``h`` (s), with the thrust and the effects of its beginning."""
    tv = th[begin * (THRUST_ROWS * W) : (begin + 1) * (THRUST_ROWS * W)]
    if FULL:
        lv = lg[begin * LOG_ROWS * W : (begin + 1) * LOG_ROWS * W]
    effects_on_state(m, tv, lv, geo, acts, b, STATE * W, use_state, use_water, use_cross, use_flow)
    explicit_step(m, tv, h, inverse_h)


def load_block(m: Array, numbers: Array, states: Array, b: int) -> None:
    """Numbers and first states of the block's lanes; all else zero."""
    for c in range(INPUT_ROWS * W):
        m[c] = numbers[b, c]
    for c in range(13 * W):
        m[STATE * W + c] = states[b, c]
    for c in range((ROWS - EULER) * W):
        m[EULER * W + c] = 0.0


def lanes_of_block(m: Array, b: int, onset: Array, limit: Array, which: Array, steps: int) -> tuple[bool, bool, bool, bool, int]:
    """What some lane of the block has: an extra wrench, jets, side force, a payload to come; and the fewest steps that one can take."""
    use_extra, use_wake, use_side, pending, least = False, False, False, False, steps
    for j in range(W):
        m[ALIVE * W + j] = 1.0
        least = min(least, limit[b, j])
        use_extra = use_extra or which[b, j] >= 0
        for i in range(THRUSTERS):
            use_wake = use_wake or m[(JET + i) * W + j] != 0.0
        use_side = use_side or m[(JET + THRUSTERS) * W + j] != 0.0
        pending = pending or onset[b, j] < math.inf
    return use_extra, use_wake, use_side, pending, least


def clear_log(la: Array, lg: Array) -> None:
    """Zeros in the log at the ends of a step and at its stages."""
    for c in range(2 * LOG_ROWS * W):
        la[c] = 0.0
    for c in range(3 * LOG_ROWS * W):
        lg[c] = 0.0


def remember_lag(m: Array) -> None:
    """What lags remember where the next step begins."""
    for c in range(THRUSTERS * W):
        m[MEMORY * W + c] = m[NEXT * W + c]
