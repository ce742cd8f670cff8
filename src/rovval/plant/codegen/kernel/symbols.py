"""Insertion points of the kernel: what `rovval.plant.codegen.text` puts a number, lines or a choice in for. The values here are only types."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])
Array = Any  # of doubles, in the compiled kernel; numba finds the types
Lanes = Any  # one number a lane

# Choices: what a `Spec` says of the plant.
FULL = False  # every effect of the library is in, else none
DENSE = False  # added mass and drag are 6 x 6 matrices, else diagonals
ADVANCE = False  # thrust depends on the advance ratio
FLOW = False  # thrust depends on the flow past the thruster: FULL or ADVANCE
EXPLICIT = False  # added mass is a force of the filtered acceleration of the steps before, and the step one of Euler's
LAGGED = False  # thruster speeds answer late: FULL or EXPLICIT

# Sizes.
W = 16  # lanes of a block
THRUSTERS = 1
STRIDE = 1  # rows of a thruster
INPUT_ROWS = 1  # rows of a lane that `Plant` hands over; those that follow are the kernel's own
ROWS = 1  # rows of a lane in all
LOG_COUNT = 1  # logged quantities
LOG_ROWS = 1  # the same and the extra wrench at one time
TIME = 0  # row of the time among them
WRENCH = 0  # first row of the extra wrench among them
THRUST_ROWS = 1  # thrusts at rest and their wrench at one stage time
PAYLOAD_ROWS = 1  # rows that a payload replaces, from MASS on

# First rows of what `Plant` hands over.
MASS = 0  # m, m r_G (3), inertia about the origin (6), M^-1 (21, upper triangle)
RESTORING = 0  # W - B, W r_G - B r_B (3)
DISPLACED = 0  # rho V, rho V r_B (3): force of accelerating water
ADDED = 0  # M_A, 36 or the diagonal; so are
LINEAR = 0  # D_l and
QUADRATIC = 0  # D_q
LAG = 0  # time constant, what is left of the past at the start, middle and end of a step (3)
SHIFT = 0  # samples by which thruster speeds are stamped early, samples per s
JET = 0  # share of thrust lost in a jet, each thruster; side force per newton
BODY = 0  # first row of the thrusters, each STRIDE rows: gain ahead, astern, direction (3), moment (3), the effects' own

# First rows of the kernel's own.
STATE = 0  # x y z, q_wxyz, u v w p q r (13) at the start of a step, then what each of the four stages leaves (52)
EULER = 0  # phi theta psi for the record
ENDS = 0  # logged speed of each thruster at the start of a step, then at its end
MEMORY = 0  # lagged speed of each thruster at the start of a step
NEXT = 0  # the same at its end
ALIVE = 0  # 1, or 0 of a lane that stopped
CODE = 0  # why a lane stops in this step, and room for its sum
CURRENT = 0  # velocity of the water in the body frame (3)
WATER = 0  # velocity of the water, its change along the path and at a fixed point, north east down (9)
MOTION = 0  # at the stage at hand: x y z, q_wxyz, u v w p q r, rotation (9), velocity over ground (3)
LOGGED = 0  # logged quantities then
EXTRA = 0  # wrench of all that acts on the state beyond the rigid body (6)
FILTERED = 0  # filtered acceleration relative to the water (6)
BEFORE = 0  # velocity relative to the water at the step before (6)

# Limits.
SETTLING = 1  # steps of the acceleration's filter before a lane's first
SPEED_LIMIT_2 = 0.0  # (m/s)^2
RATE_LIMIT_2 = 0.0  # (rad/s)^2
ADVANCE_LIMIT = 0.0
THIRD = 1.0 / 3.0
SHARE = 0.0  # of the newest acceleration in the filtered one


def compiled_function(function: Function) -> Function:
    """Mark a function that numba compiles; one without the mark is written into its caller."""
    return function


def unrolled(count: int) -> range:
    """Numbers 0 to ``count`` - 1 of a loop that is written out, turn by turn."""
    return range(count)


def spread(values: Array, count: int) -> tuple[float, ...]:
    """The first ``count`` numbers of an array, each in a local variable of its own."""
    raise NotImplementedError


def pruned(lanes: range) -> range:
    """The same lanes; assignments that nothing after them in the loop reads are left out: each effect needs another part of the state."""
    return lanes


def effects_of(kind: str) -> tuple[str, ...]:
    """Names of the effects with a function of that kind, for a loop that is written out."""
    raise NotImplementedError


def at_work(acts: Array, b: int, effect: str) -> bool:
    """Whether some lane of block ``b`` has the effect."""
    raise NotImplementedError


def any_at_work(acts: Array, b: int, *kinds: str, asks: str = "") -> bool:
    """Whether some lane of block ``b`` has an effect with a function of one of these kinds (that asks for the quantity ``asks``)."""
    raise NotImplementedError


def any_reads_log(acts: Array, b: int) -> bool:
    """Whether some lane of block ``b`` has an effect that asks for a logged quantity."""
    raise NotImplementedError


def in_turn(kind: str, value: Lanes, m: Array, i: int, j: int, *, skip: str = "", **given: Lanes) -> Lanes:
    """``value`` (speed or thrust of thruster ``i`` in lane ``j``) handed from one effect's function of that kind to the next, ``given`` what a function may
    ask for by name beside the logged quantities (rows LOGGED); those that ask for ``skip`` are left out."""
    raise NotImplementedError


def effect_value(kind: str, effect: str, m: Array, j: int, *, i: int = 0, log: Array = None, **given: Lanes) -> tuple[Lanes, ...]:
    """What one effect's function of that kind returns in lane ``j``, of thruster ``i`` where it is one of a thruster, ``log`` the logged quantities at this
    time (else, of functions of the state, rows LOGGED), ``given`` what else it may ask for by name."""
    raise NotImplementedError
