"""The true motion about a window's start behind a sensor that is late or early.

What such a sensor wrote there is the motion of some samples before, which is simulated forward from it, or of some samples after, from which
the motion is stepped back: each step is solved for where it began.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rovval.core.frames import wrap

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Simulate = Callable[[Indices, Indices, Array, int], tuple[Array, Indices]]
Path = tuple[Indices, Array]  # lanes (b,), and their true motion from some samples before the start to the start (b, k + 1, 12)
ROUNDING = 1e-9  # of a sample, in a delay of whole samples
POSITIONS, ANGLES = (6, 7, 8), (9, 10, 11)  # among u v w p q r x y z phi theta psi


@dataclass(frozen=True, slots=True)
class Delay:
    """``seconds`` (B,) by which a sensor is late in each lane, and the ``columns`` of the state (u v w p q r x y z phi theta psi) that it writes."""

    seconds: Array
    columns: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Clock:
    """``simulate(lanes, start, state, steps)``: true motion (b, steps + 1, 12) of some lanes from other samples and states, and where each stopped
    (b,) (-1: it did not); ``dt`` s, ``samples`` of the log."""

    simulate: Simulate
    dt: float
    samples: int

    def step(self, lanes: Indices, start: Indices, state: Array) -> tuple[Array, NDArray[np.bool_]]:
        """What a sample adds to the states (b, 12), and which lanes did not stop in it (b,)."""
        out, stopped = self.simulate(lanes, start, state, 1)
        added = out[:, 1] - out[:, 0]
        added[:, ANGLES] = wrap(added[:, ANGLES])
        return added, stopped < 0


def _samples(late: Array, dt: float) -> Indices:
    """How many whole samples (B,) hold each delay ``late`` (B,) s, as far as it is above zero."""
    return np.ceil(np.maximum(late, 0.0) / dt - ROUNDING).astype(np.int64)


def _alike(late: Array, dt: float) -> Iterator[tuple[int, Indices]]:
    """How many whole samples hold a delay ``late`` (B,) s above zero, and the lanes with as many."""
    whole = _samples(late, dt)
    for samples in np.unique(whole[whole > 0]):
        yield int(samples), np.flatnonzero(whole == samples)


def true_start(clock: Clock, start: Indices, measured: Array, delays: Sequence[Delay]) -> tuple[Array, Array, int]:
    """True states (B, 12) at the samples ``start`` (B,) behind ``measured`` ones, those of the samples before (B, m, 12), as far back as a late
    sensor shows, and how many samples beyond the window an early one shows. Where the log does not reach, the delay times the acceleration at the
    start stands for both, as it does for positions."""
    state, led = measured.copy(), list[tuple[NDArray[np.int64], Path]]()
    for one in (d for d in delays if not set(d.columns) & set(POSITIONS)):
        columns, lanes = np.array(one.columns), np.flatnonzero(one.seconds)
        added, _ = clock.step(lanes, start[lanes], state[lanes])
        straight, rate = state[lanes], np.zeros_like(state)
        straight[:, columns] += (one.seconds[lanes] / clock.dt)[:, None] * added[:, columns]
        rate[lanes] = added
        paths = [*_forward(clock, start, state, rate, one), _back(clock, start, state, one)]
        state[lanes] = straight
        for known, path in paths:
            state[np.ix_(known, columns)] = path[:, -1][:, columns]
            led.append((columns, (known, path)))
    lanes = np.flatnonzero(np.any([d.seconds != 0 for d in delays], axis=0))
    added, _ = clock.step(lanes, start[lanes], state[lanes])
    for one in (d for d in delays if set(d.columns) & set(POSITIONS)):
        columns = np.array(one.columns)
        state[np.ix_(lanes, columns)] += (one.seconds[lanes] / clock.dt)[:, None] * added[:, columns]
    many, after = (max((steps for one in delays for steps, _ in _alike(side * one.seconds, clock.dt)), default=0) for side in (1.0, -1.0))
    before = np.repeat(state[:, None], many, axis=1)
    before[lanes] -= np.arange(many, 0, -1)[:, None] * added[:, None]
    for columns, (known, path) in led:
        before[np.ix_(known, np.arange(many - path.shape[1] + 1, many), columns)] = path[:, :-1][..., columns]
    return state, before, after


def _forward(clock: Clock, start: Indices, state: Array, rate: Array, one: Delay) -> Iterator[Path]:
    """Lanes with a late sensor, from as many samples before the start as the delay has. The oldest sample adds as much of what it would add as the delay
    has of it, so that the motion at the start goes over into what was measured there as the delay vanishes. The turn of an attitude that is not late is
    taken back at its ``rate`` at the start, a sample's (B, 12); what else moves is held: stepped back, it errs by what the model misses, which grows that
    way (roll and pitch of a BlueROV2)."""
    columns, turned = np.array(one.columns), np.array([c for c in ANGLES if c not in one.columns], dtype=np.int64)
    for steps, alike in _alike(one.seconds, clock.dt):
        lanes = alike[start[alike] >= steps]
        if len(lanes):
            begin, part = start[lanes] - steps, (one.seconds[lanes] / clock.dt - (steps - 1))[:, None]
            first, turn = state[lanes], rate[np.ix_(lanes, turned)]
            first[:, turned] -= steps * turn
            added, _ = clock.step(lanes, begin, first)
            second = state[lanes] + part * added
            second[:, turned] -= (steps - 1 + part) * turn
            first[:, columns] -= (1.0 - part) * added[:, columns]
            out, stopped = clock.simulate(lanes, begin + 1, second, steps - 1) if steps > 1 else (second[:, None], np.full(len(lanes), -1))
            yield lanes[stopped < 0], np.concatenate([first[:, None], out], axis=1)[stopped < 0]


def _back(clock: Clock, start: Indices, state: Array, one: Delay) -> Path:
    """Lanes with an early sensor, stepped back from where it showed the motion that it wrote at the start; of the last sample as much as the delay has."""
    columns, whole = np.array(one.columns), _samples(-one.seconds, clock.dt)
    lanes = np.flatnonzero((whole > 0) & (start + whole + 1 < clock.samples))
    steps, there, ran = whole[lanes], state[lanes], np.ones(len(lanes), dtype=bool)
    part = (-one.seconds[lanes] / clock.dt - (steps - 1))[:, None]
    for j in range(int(steps.max(initial=0)) - 1, -1, -1):
        here = np.flatnonzero(steps > j)
        some, goal, before = lanes[here], there[here], there[here]
        for _ in range(2):  # what leads to the goal in a step: by the step that begins in the goal, then by that of the first answer
            added, still = clock.step(some, start[some] + j, before)
            before[:, columns] = (goal - added)[:, columns]
            ran[here] &= still
        there[here] = np.where((steps[here] == j + 1)[:, None], goal + part[here] * (before - goal), before)
    return lanes[ran], there[ran, None]
