"""The tank profile's axes, checked on the published runs by what kinematics and the sticks allow."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from real_data import real

from rovval.core.data import Series
from rovval.core.frames import rotation_from_euler
from rovval.ingest import read
from rovval.storage.archive import open_run


def whole_rows(raw):
    """The channels at the stamps that all of them have (one heading averaged across the wrap is dropped)."""
    shared = raw.channels["psi"].t
    return {n: Series(s.t[np.isin(s.t, shared)], s.values[np.isin(s.t, shared)], s.stamp) for n, s in raw.channels.items()}


def misfit(c, signs=(1, 1, 1, 1, 1), k=8) -> float:
    """How far velocity is from being the rate of position, in parts of the way covered over 8 samples."""
    t = c["x"].t
    euler = np.stack([c[n].values for n in ("phi", "theta", "psi")], axis=1) * np.array(signs[:3])
    body = np.stack([c[n].values for n in "uvw"], axis=1) * np.array([1, *signs[3:]])
    world = np.einsum("nij,nj->ni", rotation_from_euler(euler), body)
    way = np.concatenate((np.zeros((1, 3)), np.cumsum(0.5 * (world[1:] + world[:-1]) * np.diff(t)[:, None], axis=0)))
    position = np.stack([c[n].values for n in "xyz"], axis=1)
    moved, said = position[k:] - position[:-k], way[k:] - way[:-k]
    return float(np.median(np.linalg.norm(moved - said, axis=1)) / np.median(np.linalg.norm(moved, axis=1)))


@pytest.mark.parametrize("run", ["run_a", "run_b", "run_c"])
def test_velocity_is_the_rate_of_position(run):
    raw = read(real(f"bluerov2_tank/{run}.csv"))
    assert raw.profile == "bluerov2_tank" and raw.vehicle == "bluerov2_heavy"
    assert raw.t0_ns is not None and raw.t0_ns > 1_748_000_000 * 10**9
    assert misfit(whole_rows(raw)) < 0.1


def test_no_other_choice_of_signs_fits():
    c = whole_rows(read(real("bluerov2_tank/run_c.csv")))
    errors = {signs: misfit(c, signs) for signs in itertools.product((1, -1), repeat=5)}
    best = sorted(errors, key=lambda s: errors[s])
    assert best[0] == (1, 1, 1, 1, 1) and errors[best[1]] > 1.5 * errors[best[0]]


@pytest.mark.parametrize("run", ["run_a", "run_b", "run_c"])
def test_rates_are_those_of_the_attitude(run):
    c = whole_rows(read(real(f"bluerov2_tank/{run}.csv")))
    turn = rotation_from_euler(np.stack([c[n].values for n in ("phi", "theta", "psi")], axis=1))
    step = np.einsum("nji,njk->nik", turn[:-1], turn[1:])
    small = np.trace(step, axis1=1, axis2=2) > 2.9  # below 0.3 rad, where the skew part is the rotation
    said = 0.5 * np.stack([step[:, 2, 1] - step[:, 1, 2], step[:, 0, 2] - step[:, 2, 0], step[:, 1, 0] - step[:, 0, 1]], axis=1)
    for i, rate in enumerate("pqr"):
        turned = 0.5 * (c[rate].values[1:] + c[rate].values[:-1]) * np.diff(c[rate].t)
        assert np.corrcoef(said[small, i], turned[small])[0, 1] > 0.7, rate


@pytest.mark.parametrize(
    ("run", "pairs"),
    [("run_a", ["u surge", "v sway", "w heave"]), ("run_c", ["u surge", "v sway", "w heave", "p roll", "q pitch", "r yaw"])],
)
def test_every_stick_drives_its_axis_with_its_sign(run, pairs):
    log = open_run(real(f"bluerov2_tank/{run}.csv"))
    for pair in pairs:
        channel, axis = pair.split()
        ok = log.ok(channel)
        smooth = [np.convolve(x[ok], np.ones(11) / 11, "same") for x in (log.get(channel), log.get(f"stick:{axis}"))]
        assert np.corrcoef(smooth[0], smooth[1])[0, 1] > 0.6, pair


def test_the_heading_is_turned_into_the_positions_axes_and_said():
    for run, degrees in (("run_a", 27), ("run_b", 38), ("run_c", -2)):
        found = [f for f in read(real(f"bluerov2_tank/{run}.csv")).findings if f.code == "heading_zero"]
        assert len(found) == 1 and float(found[0].detail.split()[0]) == pytest.approx(degrees, abs=1.0)


def test_the_published_simulation_lies_on_the_same_rows():
    for run, tether in itertools.product(("run_a", "run_b", "run_c"), (".sim", ".sim_tether")):
        measured, simulated = open_run(real(f"bluerov2_tank/{run}.csv")), open_run(real(f"bluerov2_tank/{run}{tether}.csv"))
        assert simulated.profile == "bluerov2_tank_sim"
        assert len(simulated) == len(measured) and simulated.t0_ns == measured.t0_ns
        ok = measured.ok("u") & simulated.ok("u")
        assert ok.mean() > 0.99 and np.corrcoef(measured.get("u")[ok], simulated.get("u")[ok])[0, 1] > 0.7
