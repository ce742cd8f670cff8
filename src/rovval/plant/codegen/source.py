"""The kernel's text put together: the fixed text, the lines that a `Spec` asks for, and the effects' functions in their places.

Thesis 3.10 to 3.15 in the velocity relative to the water (Fossen 2021, 8.4), Runge-Kutta 4 over ``x y z, q_wxyz, u v w p q r``. Thruster
speeds are taken at the stage times: frozen over the step they make the whole scheme first order (measured). Lines of the text that end
in ``#full`` and the like are kept only in such kernels; ``<<name>>`` is replaced by generated lines.
"""

from __future__ import annotations

import re

from rovval.plant.codegen import spec as compose
from rovval.plant.codegen import terms, text_run, text_state
from rovval.plant.codegen.calls import chain, state
from rovval.plant.codegen.passes import passes, switch_lines
from rovval.plant.codegen.spec import Spec, layout

SPEED_LIMIT = 20.0  # m/s; no ROV comes near it (design: limits)
RATE_LIMIT = 30.0  # rad/s
ADVANCE_LIMIT = 1.0  # |J_a| beyond which the cubic K_T is held: open-water series end near there, and a cubic turns up again


def render(spec: Spec) -> str:
    """The kernel's source for ``spec``. Constants are written out: Python folds them, where numba would type every operation."""
    generated, numbers = _generated(spec), _numbers(spec)
    named = re.compile(rf"\b({'|'.join(numbers)})\b")
    lines = []
    for line in _kept(text_state.TEXT + text_run.TEXT, spec):
        bare = line.strip()
        if bare.startswith("<<"):
            indent = line[: len(line) - len(line.lstrip())]
            lines += [indent + new for new in generated[bare[2:-2]]]
        else:
            lines.append(line)
    return named.sub(lambda name: repr(numbers[name[0]]), "\n".join(lines)) + "\n"


def _generated(spec: Spec) -> dict[str, list[str]]:
    """Lines for each place in the text."""
    k = spec.thrusters
    return {
        "geometry": [f"g_{c} = geo[{c}]" for c in range(16 * k)] if spec.state else [],
        "switches": switch_lines(spec),
        "speed": chain(spec, "speed", "n", "(BODY + i * STRIDE)"),
        "wrench_at_rest": terms.wrench_at_rest(spec),
        "thrust_at_rest": terms.thrust_at_rest(spec, "i", False),
        "thrust_with_effects": terms.thrust_at_rest(spec, "i", True),
        "wrench_of_thrust": terms.wrench_of_thrust(spec),
        "side": terms.side(spec),
        "passes": passes(spec),
        "state": state(("qw", "r_p", "vn", "ve", "vd", *(("ur",) if spec.full else ()))),
        "force": terms.force(spec),
        "momentum": terms.momentum(spec.dense),
        "drag": terms.drag(spec.dense),
        "acceleration": terms.acceleration(),
        "stage_state": terms.stage_state(),
        "new_state": terms.new_state(),
        "take_state": terms.take_state(),
    }


def _numbers(spec: Spec) -> dict[str, float]:
    """Constants of the kernel: first rows of groups, sizes, limits. State and scratch follow the lane's own numbers in one array: LLVM
    then proves with few checks at run time that what a loop writes is not what it reads."""
    where, k = layout(spec), spec.thrusters
    numbers: dict[str, float] = {name.upper(): where.first[name] for name in compose.GROUPS}
    numbers |= {
        "W": compose.W, "THRUSTERS": k, "BODY": where.body_rows, "STRIDE": where.stride, "ROWS": where.rows, "LOGS": compose.LOG_ROWS,
        "THS": (3 * k + 6 if spec.state else 6) * compose.W, "PAYLOAD": compose.MASS_ROWS,
        "V2": SPEED_LIMIT**2, "W2": RATE_LIMIT**2, "JMAX": ADVANCE_LIMIT, "THIRD": 1.0 / 3.0,
    }  # fmt: skip
    place = where.rows
    sizes = {"X0": 5 * 13, "SEEN": 3, "ENDS": 2 * k, "MEMORY": k, "NEXT": k, "ALIVE": 1, "CODE": 2, "CURRENT": 3, "WATER": 9, "EXTRA": 6}
    for name, size in sizes.items():
        numbers[name] = place
        place += size
    return numbers | {"TOTAL": place}


def _kept(text: str, spec: Spec) -> list[str]:
    """Lines without a mark, and those whose mark holds: ``#full`` ``#nominal`` ``#state`` (thrust depends on motion) ``#rest`` (it does
    not) ``#law`` (by its advance ratio alone)."""
    marks = {"full": spec.full, "nominal": not spec.full, "state": spec.state, "rest": not spec.state, "law": spec.state and not spec.full}
    kept = []
    for line in text.splitlines():
        code, _, mark = line.rpartition("  #")
        if marks.get(mark, True):
            kept.append(code if mark in marks else line)
    return kept
