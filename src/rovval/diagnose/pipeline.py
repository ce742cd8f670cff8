"""The diagnosis as an algorithm.

Logs are cut into windows, each simulated from its measured start (multiple shooting). An estimation problem is posed about the nominal vehicle; the
effects of the library are its hypotheses. A healthy vehicle is fitted first, with every coefficient within its tolerance; beside it causes are added
one at a time (forward search), and the most probable of all models that were fitted is the answer. Where something seems to begin in mid-log, the part
after that is analysed by itself, and the causes found in it, at work from then on, are further models of the whole log.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rovval import effects
from rovval.core.data import Run
from rovval.core.errors import BadInput
from rovval.diagnose.decision.finding import Search, began, decided, may_begin, weighed_with
from rovval.diagnose.effort import MOST_BEGUN, MOST_CAUSES
from rovval.diagnose.hypotheses.hypothesis import columns_of
from rovval.diagnose.hypotheses.library import hypotheses, initialised
from rovval.diagnose.hypotheses.observability import observable
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.problem.problem import pose
from rovval.diagnose.result.assembly import assemble
from rovval.diagnose.result.diagnosis import Diagnosis
from rovval.diagnose.search.forward import search
from rovval.diagnose.search.onset import windows_from
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.diagnose.windows.windows import Windows
from rovval.vehicle.model import Vehicle

Progress = Callable[[str, float], None]


def diagnose(
    runs: Sequence[Run],
    vehicle: Vehicle,
    *,
    model: str = "fossen",
    window_s: float = 10.0,
    calibration_slop: float = 0.05,
    seed: int = 0,
    without: Sequence[str] = (),
    progress: Progress | None = None,
) -> Diagnosis:
    """Diagnose the gap between ``vehicle``'s simulator and one or several of its logs.

    Args:
        runs: logs on the 10 Hz grid, all of this vehicle; three or more are held out one at a time, windows of fewer in fifths.
        vehicle: the vehicle as its file has it.
        model: the platform whose simulator is diagnosed.
        window_s: length (s) of the windows that are simulated from their measured start; a half or a quarter of it where logs are short.
        calibration_slop: tolerance: relative standard deviation of a healthy simulator's coefficients; an effect must explain more than that.
        seed: of bootstraps and permutations.
        without: effects or hypotheses to leave out of the library (the withheld-effect check does).
        progress: called with what is being done and the share of the work that is done (0 to 1).

    Returns:
        The typed diagnosis; `rovval.report` puts it into words.

    Raises:
        BadInput: too little of a log can be simulated, or thruster inputs are missing.
    """
    say = progress or _silent
    windows, left_out = cut(runs, vehicle, model, window_s)
    met = searched(windows, without, calibration_slop, say)
    say("asking how much any systematic cause could explain", 0.85)
    found = decided(met)
    if (time := found.selection.onset) and may_begin(found, time):
        say(f"searching the part from {time:.0f} s on", 0.85)
        unasked = [*without, *found.untestable]  # what the whole log does not show, a part of it does not
        late = _searched_from(time, windows[0], unasked, calibration_slop)
        if late and (moved := began(late, found, time)) != time:
            late, time = _searched_from(moved, windows[0], unasked, calibration_slop), moved
        found = weighed_with(decided(late), found, time) if late else found
    return assemble(found, left_out, calibration_slop, seed, say)


def searched(windows: tuple[Windows, ...], without: Sequence[str], tolerance: float, say: Progress, most: int = MOST_CAUSES) -> Search:
    """One pass over the windows of the logs: pose the estimation problem, fit the healthy vehicle, search for ``most`` causes."""
    library, untestable = hypotheses(windows, without)
    say(f"simulating every effect of the library on {sum(part.count for part in windows)} windows", 0.05)
    problem = pose(windows, columns_of(library), tolerance)
    library, unseen = observable(problem, library)
    healthy = healthy_fit(problem)
    return Search(problem, untestable | unseen, search(problem, library, initialised(problem, library, healthy), healthy, say, most))


def _searched_from(time: float, windows: Windows, without: Sequence[str], tolerance: float) -> Search | None:
    """The same over the windows from ``time`` (s) on, without the effects that have an onset of their own, which the whole log shows; None where too few
    windows can be simulated: the log as a whole was."""
    events = [name for name in effects.names() if effects.load(name).begins]
    try:
        return searched((windows_from(windows, time),), [*without, *events], tolerance, _silent, MOST_BEGUN)
    except BadInput:
        return None


def _silent(text: str, share: float) -> None:
    """Progress that is not reported."""
