"""Effects: what can be wrong with a nominal simulator, one file of `library` each; a file that is added there is in the library.

A file declares ``EFFECT`` (`effects.effect`) and, where it needs them, any of these functions (``p[name]`` is (B,), (B, 6) per axis or (B, k) per
thruster; every one changes nothing at the null value, to the last bit):

- ``lower(lanes, p) -> Lanes``           vehicle and input numbers of each lane (`effects.lanes`); with ``FULL_KERNEL = True`` where these are
  numbers that the nominal kernel does without
- ``rows(lanes, p) -> {row: array}``     the effect's own numbers for its functions of the state, in ``ROWS`` order: (B,), or (B, k)
  for functions of a thruster unless the file says ``SHARED = True``
- ``water(...)``                         north-east-down velocity of the water, its change along the path and at a fixed point (9)
- ``wrench(...)``                        body force and moment, N and N m (6)
  of which the water's and the body's may be sums over ``COMPONENTS``, endings of names (a sea's trains, ``""`` the first): the function is of one, its
  parameters and rows are those of that ending, or those that all share; a component at its null value costs nothing
- ``speed(...)``, ``acting(...)``        thruster speed rev/s, before and after the lag
- ``static(...)``, ``thrust(...)``       thrust N, at rest in the water and under way
- ``observe(motion, p)``, ``unobserve(nu, eta, p)``   the log as a sensor writes it, and the truth back out of it

Functions of the state are written once, free of branches, with the helpers of `effects.arithmetic`; their arguments are named
after what they need (the kernel's names of the state, the effect's ROWS) and they run compiled in the batch kernel and as NumPy in the
reference plant.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType

from rovval.core.did_you_mean import suggestion
from rovval.core.errors import UsageProblem
from rovval.effects.effect import FAMILIES, Effect, Parameter, Tolerance

__all__ = ["FAMILIES", "Effect", "Parameter", "Tolerance", "load", "module", "names", "sensor_tolerance"]
FOLDER = Path(__file__).parent / "library"


@cache
def names() -> tuple[str, ...]:
    """Names of every effect in the library, sorted."""
    return tuple(sorted(p.stem for p in FOLDER.glob("*.py") if not p.stem.startswith("_")))


@cache
def module(name: str) -> ModuleType:
    """The file of an effect, imported.

    Raises:
        UsageProblem: a name that is not in the library.
    """
    if name not in names():
        raise UsageProblem(f"no effect named {name!r}", suggestion(name, names(), "`rovval list effect`"))
    return import_module(f"rovval.effects.library.{name}")


def load(name: str) -> Effect:
    """The effect of that name.

    Raises:
        UsageProblem: a name that is not in the library, or a file that does not declare the effect of its name.
    """
    effect = module(name).EFFECT
    if not isinstance(effect, Effect) or effect.name != name:
        raise UsageProblem(f"effects/library/{name}.py does not declare EFFECT with the name {name!r}")
    return effect


def sensor_tolerance(name: str) -> float | None:
    """By how much a healthy sensor may be off, one standard deviation in the unit of the effect's parameters; None for a name that is no fault of a
    sensor, or none of the library."""
    stated = [p.tolerance for p in load(name).parameters if p.tolerance] if name in names() else []
    return next((t.sd for t in stated if not t.calibrated and isinstance(t.sd, float)), None)
