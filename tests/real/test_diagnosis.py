"""Real logs whose answer is known: ballast bags, and logs damaged on purpose. Physics knocked out of a fitted model: `test_knocked_out`."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from real_data import real

from rovval import vehicle
from rovval.core.data import Run
from rovval.diagnose import diagnose
from rovval.fit import fit
from rovval.storage.archive import open_run
from rovval.vehicle.model import Vehicle

TUNED = (
    "quadratic_drag",
    "linear_drag",
    "buoyancy_error",
    "cg_offset",
    "added_mass",
    "thrust_lag",
    "rpm_scale",
    "reverse_asymmetry",
)
slow = pytest.mark.slow


@pytest.fixture(scope="module")
def run_a() -> Run:
    """The longest of the tank runs: 130 s of all six axes."""
    return open_run(real("bluerov2_tank/run_a.csv"))


@pytest.fixture(scope="module")
def fitted(tmp_path_factory) -> Vehicle:
    """The BlueROV2 tuned to the two other tank runs."""
    others = [open_run(real(f"bluerov2_tank/run_{name}.csv")) for name in "bc"]
    path: Path = tmp_path_factory.mktemp("fitted") / "bluerov2_fitted.toml"
    path.write_text(fit(others, vehicle.load("bluerov2_heavy"), TUNED).vehicle, encoding="utf-8")
    return vehicle.load(path)


def named(document: dict[str, Any]) -> set[str]:
    """Every name that the answer gives: causes and what they cannot be told from."""
    return {name for cause in document["causes"] for name in (cause["effect"], *cause["group"])}


def test_ballast_is_fitted_as_its_publishers_fitted_it():
    """The vehicle released without ballast: the bags' README has a net buoyancy of -4.8 to -5.6 N from its own fit."""
    result = fit([open_run(real("bluerov2_ballast/ff_nb1.bag"))], vehicle.load("bluerov2_heavy"), ["buoyancy_error"])
    tuned = result.document["parameters"]["buoyancy_error.force"]
    assert tuned["low"] < -5.2 < tuned["high"]
    assert -7.0 < tuned["value"] < -3.5


@slow
def test_ballast_is_named():
    """By `diagnose`, with its sign and size, in heave; the log holds four windows of free motion."""
    document = diagnose([open_run(real("bluerov2_ballast/ff_nb1.bag"))], vehicle.load("bluerov2_heavy")).document()
    gap = document["gap"]["axes"]
    assert max(gap, key=lambda axis: gap[axis]["share"]) == "heave"
    cause = document["causes"][0]
    assert {"buoyancy_error", "tether_tension"} & set(cause["group"])  # a steady pull down, as a released vehicle shows it
    force = cause["parameters"].get("force") or cause["parameters"]["down"]
    assert abs(force["value"]) == pytest.approx(4.6, abs=1.5)
    closed = cause["shrinkage"]["axes"]
    assert closed["heave"] > 0.8
    assert max(gap, key=lambda axis: gap[axis]["share"] * closed[axis]) == "heave"  # most of what is closed; of the little gap in roll as large a share is


def changed(run: Run, **channels: np.ndarray) -> Run:
    return replace(run, values=dict(run.values) | channels)


def turned(run: Run, degrees: float) -> Run:
    """Velocities in a frame turned to starboard."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    u, v = run.get("u"), run.get("v")
    return changed(run, u=c * u + s * v, v=c * v - s * u)


def late(run: Run, seconds: float) -> Run:
    """The sticks stamped late."""
    k = round(seconds / run.dt)
    moved = {n: np.concatenate([np.full(k, x[0]), x[:-k]]) for n, x in run.values.items() if n.startswith("stick:")}
    return changed(run, **moved)


DAMAGED = [
    pytest.param("frame turned by 15 degrees", {"dvl_misalignment"}),
    pytest.param("all velocities 1.25 times too large", {"dvl_scale"}),
    pytest.param("surge velocity 1.3 times too large", {"dvl_scale"}),
    pytest.param("sticks stamped 0.8 s late", {"time_offset"}),
]


@slow
@pytest.mark.parametrize(("damage", "right"), DAMAGED)
def test_damage_of_the_log_is_named(run_a: Run, fitted: Vehicle, damage: str, right: set[str]):
    harmed = {
        "frame": lambda: turned(run_a, 15.0),
        "all": lambda: changed(run_a, **{c: 1.25 * run_a.get(c) for c in "uvw"}),
        "surge": lambda: changed(run_a, u=1.3 * run_a.get("u")),
        "sticks": lambda: late(run_a, 0.8),
    }[damage.partition(" ")[0]]()
    document = diagnose([harmed], fitted).document()
    assert named(document) & right
    if damage.startswith("frame"):
        [cause] = [c for c in document["causes"] if c["effect"] == "dvl_misalignment"]
        assert cause["parameters"]["yaw"]["value"] == pytest.approx(math.radians(15.0), abs=math.radians(5.0))
    if damage.startswith("surge"):
        [cause] = [c for c in document["causes"] if c["effect"] == "dvl_scale"]
        assert cause["parameters"]["surge"]["value"] == pytest.approx(0.3, abs=0.05)
