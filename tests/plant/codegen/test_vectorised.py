"""The batch kernel does its arithmetic in vector instructions.

LLVM leaves a loop over lanes scalar without a word (too few trips, too many memory checks, a call into libm, an index that may be
negative), and the plant is then three to six times slower. Looked up in the optimised code rather than timed: a loaded machine must
not fail this.
"""

from __future__ import annotations

import re

import plant_cases as cases
import pytest

from rovval.plant import Plant, parse_settings
from rovval.plant.codegen.cache import module
from rovval.plant.codegen.spec import Spec

# Every vectorised loop keeps a scalar twin for the case that its memory checks fail. Measured: 2.0 and 1.5 vector instructions for each
# scalar one (nominal, every effect); 1.1 and 0.4 with blocks of 8 lanes, which LLVM does not vectorise; 0.7 with an index of unknown sign.
LEAST = 1.3


def share(spec: Spec) -> float:
    """Vector instructions for each scalar one in the kernel's optimised code, arithmetic on doubles alone."""
    (compiled,) = module(spec).run.overloads.values()
    code = str(compiled.library._get_module_for_linking())  # the one form that a kernel out of the cache has too
    vector, scalar = (len(re.findall(rf"= f(?:add|sub|mul|div)[a-z ]* {kind}", code)) for kind in (r"<\d+ x double>", "double"))
    return vector / scalar


@pytest.mark.parametrize("effect", [None, "waves:cosine=0.2"], ids=["nominal", "every effect"])
def test_the_kernel_is_vectorised(effect):
    plant = Plant(cases.merlin())
    cases.run(plant, beta=parse_settings(plant, [effect] if effect else []))
    assert share(Spec(7, False, False, effect is not None)) > LEAST


@pytest.mark.slow
def test_a_kernel_that_is_not_is_seen():
    """Blocks of 8 lanes: right in every number, and scalar."""
    cases.run(Plant(cases.merlin()))
    (signature,) = module(Spec(7, False, False, False)).run.signatures
    narrow = Spec(7, False, False, False, lanes=8)
    module(narrow).run.compile(signature)
    assert share(narrow) < LEAST
