"""What is left unexplained, in words: on which axes a force is at work, with what it varies, and what it resembles."""

from __future__ import annotations

from collections.abc import Sequence

from rovval.core.channels import AXES
from rovval.diagnose.inference.laplace import Point
from rovval.diagnose.inference.prior import STRAINED
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.search.discrepancy import Forces


def left(problem: Problem, forces: Forces, point: Point, unsteady: Sequence[str] = ()) -> dict[str, object]:
    """On which axes a generic force would close most of what is left, with what it varies, which coefficient of ``point`` is strained, and
    which effects come near but do not hold still."""
    by_axis = sorted(((axis, forces.evidence([axis])) for axis in AXES), key=lambda item: -item[1])
    axes = [axis for axis, gain in by_axis if gain > 0.3 * by_axis[0][1]][:3] or [by_axis[0][0]]
    by_feature = sorted(((f, forces.evidence([axes[0]], f)) for f in forces.features), key=lambda item: -item[1])
    depends = [f for f, gain in by_feature if gain > 0.5 * by_feature[0][1] and gain > 0][:4]
    share = forces.share(problem.folds)
    text = f"a systematic force on {', '.join(axes)}"
    text += f" that varies with {', '.join(depends)}" if depends else ""
    text += f" would close {100 * share:.0f} % of it" if share >= 0.005 else " is at work"
    text += "; no effect of the library is shown to be it"
    strained = [(problem.plant.slots[c].key, z) for c, z in zip(point.columns[point.own :], point.sigmas(), strict=True) if abs(z) > STRAINED]
    if unsteady:
        text += f"; nearest is {' and '.join(unsteady)}, whose value would have to change along the log"
    elif strained:
        name, z = max(strained, key=lambda item: abs(item[1]))
        text += f"; nearest is {name}, which would have to be {abs(z):.0f} times its tolerance off"
    return {"axes": axes, "depends_on": depends, "share": share, "text": text}
