"""Every effect of the library: towards its null value what it does vanishes, and beyond its bounds it is refused."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest

from rovval import effects
from rovval.core.errors import UsageProblem
from rovval.core.frames import wrap
from rovval.plant import Plant, parse_settings

LITTLE = 1e-6  # of a typical size
REBUILT = ("time_offset[velocity]", "time_offset[attitude]", "velocity_filter_lag")  # the motion that the log has not shown yet at a window's start is worked
# out from what it shows, to some per cent


@pytest.fixture(scope="module")
def changes() -> dict[str, tuple[float, float]]:
    """Largest change of the logged motion within 4 s, m/s, rad/s, m and rad alike, by hypothesis: at a typical size, and at `LITTLE` of it."""
    plant, rng = Plant(cases.merlin()), np.random.default_rng(3)
    inputs = cases.random_inputs(rng, plant)
    typical, little = (np.tile(plant.null, (len(plant.hypotheses), 1)) for _ in range(2))
    for lane, columns in enumerate(plant.hypotheses.values()):
        for c in columns:
            p = plant.slots[c].parameter
            side = 1.0 if p.null + p.typical <= p.high else -1.0
            typical[lane, c], little[lane, c] = (np.clip(p.null + side * share * p.typical, p.low, p.high) for share in (1.0, LITTLE))
            if p.name == "onset":
                typical[lane, c] = little[lane, c] = 21.0
    lanes = np.concatenate([plant.null[None], typical, little])
    nu, eta = (np.tile(x, (len(lanes), 1)) for x in cases.random_states(rng, 1))
    out = plant.simulate(inputs, np.full(len(lanes), 200), 40, nu, eta, lanes)
    assert (out.stopped == -1).all()
    turned = np.abs(wrap(out.eta[..., 3:] - out.eta[:1, :, 3:]))
    moved = np.concatenate([np.abs(out.nu - out.nu[:1]), np.abs(out.eta - out.eta[:1])[..., :3], turned], axis=-1).max(axis=(1, 2))
    whole, part = np.split(moved[1:], 2)
    return {name: (float(a), float(b)) for name, a, b in zip(plant.hypotheses, whole, part, strict=True)}


@pytest.mark.parametrize("name", effects.names())
def test_towards_its_null_value_an_effect_vanishes(name, changes):
    """At the null value itself it is passed over altogether; an equation that left something there would jump in between."""
    own = {hypothesis: sizes for hypothesis, sizes in changes.items() if hypothesis.partition("[")[0] == name}
    assert own
    for hypothesis, (typical, little) in own.items():
        assert typical > 1e-6 and little < (0.05 if hypothesis in REBUILT else 1e-3) * typical, hypothesis


@pytest.mark.parametrize("name", effects.names())
def test_beyond_its_bounds_an_effect_is_refused_with_the_bounds(name):
    plant = Plant(cases.merlin())
    for hypothesis, columns in plant.hypotheses.items():
        if hypothesis.partition("[")[0] == name:
            for p in (plant.slots[c].parameter for c in columns):
                with pytest.raises(UsageProblem, match=rf"{p.name} = 1e\+12( \S+)*, allowed"):
                    parse_settings(plant, [f"{hypothesis}:{p.name}=1e12"])
