"""The trend of a fleet from rows of the catalogue: drifts that are planted, and healthy fleets beside them."""

import numpy as np
import pytest
from catalogue_case import row

from rovval.core.channels import AXES
from rovval.trend import trends

DIVES = 100


def fleet(seed, dives=DIVES, vehicles=("merlin", "minerva"), scatter=0.15, correlation=0.0):
    """Rows of healthy vehicles: gaps that vary from dive to dive by a factor, with heavy tails."""
    rng = np.random.default_rng(seed)
    rows = []
    for vehicle in vehicles:
        errors = scatter * rng.standard_t(4, (dives, len(AXES)))
        for n in range(1, dives):
            errors[n] += correlation * errors[n - 1]
        for n in range(dives):
            gap = {axis: float(0.05 * np.exp(errors[n, k])) for k, axis in enumerate(AXES)}
            rows.append(row(n, vehicle=vehicle, run=f"{vehicle}{n}", log=f"{vehicle}{n}", current=True, causes=[], **gap))
    return rows


def alarms(rows):
    return {(t.series.vehicle, t.series.name): t.changes for t in trends(rows) if t.changes}


def test_fouling_planted_in_a_hundred_rows_is_found_and_nothing_else():
    """3 % a day in surge since dive 60, the first of May."""
    rows = fleet(1)
    for n in range(DIVES):
        rows[n]["surge"] *= 1.03 ** max(0, n - 60)
    [((vehicle, name), (change,))] = alarms(rows).items()
    assert (vehicle, name, change.kind) == ("merlin", "surge", "ramp")
    assert change.places[0] <= 60 <= change.places[1] and change.places[1] - change.places[0] < 30
    per_day, spread = (x * 86400.0 for x in change.rate)
    assert abs(per_day - np.log(1.03)) < 3 * spread and spread < 0.01


def test_a_thruster_that_wears_is_found_by_the_size_of_its_cause():
    rng = np.random.default_rng(2)
    rows = fleet(2, vehicles=("merlin",))
    for n, dive in enumerate(rows):
        value = 0.1 + 0.004 * max(0, n - 50) + 0.02 * rng.standard_t(4)
        loss = {"name": "loss", "value": value, "low": value - 0.03, "high": value + 0.03, "unit": "1"}
        dive["causes"] = [{"effect": "thruster_degraded[HFP]", "parameters": [loss]}]
    [((_, name), (change,))] = alarms(rows).items()
    assert name == "thruster_degraded[HFP] loss" and change.kind == "ramp"
    assert change.rate[0] * 86400.0 == pytest.approx(0.004, rel=0.25)


def test_dives_of_another_method_or_another_content_are_left_out_and_counted():
    rows = fleet(3, vehicles=("merlin",))
    for n in range(50):
        rows[n] |= {"method": "before the update", "surge": rows[n]["surge"] * 5}
    rows[60]["stops"] = ["stretch from 0 s stopped"]
    rows.append(rows[70] | {"current": False, "surge": 99.0})
    found = next(t for t in trends(rows) if t.series.name == "surge")
    assert (len(found.series.runs), found.series.other_method, found.series.stopped, found.changes) == (49, 50, 1, ())


@pytest.mark.slow
@pytest.mark.parametrize("correlation", [0.0, 0.5])
def test_healthy_fleets_raise_one_false_alarm_in_a_hundred_at_most(correlation):
    """100 fleets of two vehicles and six axes. One is allowed on average; more than four would come once in 300."""
    assert sum(bool(alarms(fleet(seed, correlation=correlation))) for seed in range(1000, 1100)) <= 4
