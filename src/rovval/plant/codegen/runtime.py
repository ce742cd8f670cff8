"""What the generated kernel and nothing else needs of numba: options, inlining, and arithmetic that stays a vector instruction.

Calls into libm and gathers keep a whole loop over lanes scalar (measured), so exponential, sine and arc tangent are polynomials.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, cast

import llvmlite.binding
import numpy as np
from numba import njit

# Contraction to fused multiply-add, no sign of zero, reciprocals; not "fast": NaN and order of sums keep their meaning.
FLAGS = {"contract", "nsz", "arcp"}
OPTIONS: dict[str, Any] = {"nogil": True, "cache": True, "fastmath": FLAGS, "error_model": "numpy"}
INLINE: dict[str, Any] = {"forceinline": True, "fastmath": FLAGS, "error_model": "numpy"}



def compiled(options: dict[str, Any]) -> Callable[[Callable[..., Any]], Any]:
    """numba's decorator, which has no types of its own."""
    return cast("Callable[[Callable[..., Any]], Any]", njit(**options))


# A loop that touches more than some sixty rows is left scalar unless LLVM may merge its memory checks (measured: 2.8 times slower).
llvmlite.binding.set_option("rovval", "--memory-check-merge-threshold=100000")

TWO_PI_HIGH = 6.28125  # exact in few bits, so that k * TWO_PI_HIGH is exact (Cody and Waite)
TWO_PI_LOW = 2.0 * math.pi - 6.28125
SIN = tuple((-1.0) ** i / math.factorial(2 * i + 1) for i in range(11))
COS = tuple((-1.0) ** i / math.factorial(2 * i) for i in range(11))
EXP = tuple(1.0 / math.factorial(i) for i in range(13))
ATAN = tuple((-1.0) ** i / (2 * i + 1) for i in range(21))
TAN_EIGHTH = math.tan(math.pi / 8)


def _polynomial(name: str, coefficients: tuple[float, ...]) -> Any:
    """Compiled Horner scheme of the coefficients, lowest first."""
    body = repr(coefficients[-1])
    for c in reversed(coefficients[:-1]):
        body = f"({c!r} + x * {body})"
    scope: dict[str, Any] = {}
    exec(f"def {name}(x):\n    return {body}\n", scope)
    return compiled(INLINE)(scope[name])


_sin_series, _cos_series = _polynomial("_sin_series", SIN), _polynomial("_cos_series", COS)
_exp_series, _atan_series = _polynomial("_exp_series", EXP), _polynomial("_atan_series", ATAN)


@compiled(INLINE)
def _half_turns(x: Any) -> Any:
    """Sine and cosine of half of x brought into [-pi/2, pi/2]."""
    k = np.floor(x / (2.0 * math.pi) + 0.5)
    y = 0.5 * ((x - k * TWO_PI_HIGH) - k * TWO_PI_LOW)
    square = y * y
    return y * _sin_series(square), _cos_series(square)


@compiled(INLINE)
def _sin(x: Any) -> Any:
    s, c = _half_turns(x)
    return 2.0 * s * c


@compiled(INLINE)
def _cos(x: Any) -> Any:
    s, c = _half_turns(x)
    return c * c - s * s


@compiled(INLINE)
def _exp(x: Any) -> Any:
    """(exp(x / 256)) ** 256 over [-69, 69]: no exponent bits to touch, relative error below 1e-13."""
    y = _exp_series(min(max(x, -69.0), 69.0) * (1.0 / 256.0))
    y = y * y
    y = y * y
    y = y * y
    y = y * y
    y = y * y
    y = y * y
    y = y * y
    return y * y


@compiled(INLINE)
def atan2(y: Any, x: Any) -> Any:
    """Angle of (x, y) in (-pi, pi]: one division brings the tangent within tan(pi/8), where 20 terms of the series reach 1e-17."""
    ax, ay = abs(x), abs(y)
    low, high = min(ax, ay), max(ax, ay)
    steep = low > TAN_EIGHTH * high
    above = low - high if steep else low
    below = low + high if steep else high
    a = above / (below + 1e-300)
    angle = a * _atan_series(a * a)
    angle = angle + 0.25 * math.pi if steep else angle
    angle = 0.5 * math.pi - angle if ay > ax else angle
    angle = math.pi - angle if x < 0.0 else angle
    return -angle if y < 0.0 else angle


@compiled(INLINE)
def _positive(x: Any) -> Any:
    return 0.5 * (x + abs(x))


@compiled(INLINE)
def _clip(x: Any, low: Any, high: Any) -> Any:
    return min(max(x, low), high)


@compiled(INLINE)
def _sqrt(x: Any) -> Any:
    return math.sqrt(x)


@compiled({**OPTIONS, "cache": False})
def load_log(
    log: Any, t: Any, extra: Any, gain: Any, which: Any, start: Any, step: int, dt: float, la: Any, use_extra: bool, width: int, rows: int
) -> None:
    """Logged quantities and the extra wrench at a step's ends, each lane at its own place in the log; the row after the log's columns is time."""
    last, columns = t.shape[0] - 1, log.shape[1]
    for end in range(2):
        for lane in range(width):
            j = min(start[lane] + step + end, last)
            for c in range(columns):
                la[(end * rows + c) * width + lane] = log[j, c]
            la[(end * rows + columns) * width + lane] = t[start[lane]] + (step + end) * dt
            if use_extra:
                for c in range(6):
                    value = 0.0
                    if which[lane] >= 0:
                        value = gain[lane] * extra[which[lane], j, c]
                    la[(end * rows + columns + 1 + c) * width + lane] = value


@compiled({**OPTIONS, "cache": False})
def aligned(size: int) -> Any:
    """Zeros that begin on a cache line: a vector that straddles two lines costs twice (measured: a third of the kernel's speed)."""
    buffer = np.zeros(size + 8)
    skip = (64 - buffer.ctypes.data % 64) % 64 // 8
    return buffer[skip : skip + size]
