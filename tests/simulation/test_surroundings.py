"""The current and the forces that the effects of a simulation make along its motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from report_cases import make_run, make_sim

from rovval import vehicle
from rovval.core.frames import rotation_from_euler
from rovval.simulation.surroundings import Surroundings, surroundings

RUN, MERLIN = make_run(300), vehicle.load("merlin")


def around(*settings: str) -> Surroundings:
    return surroundings(RUN, replace(make_sim(RUN), effects=settings), MERLIN)


def test_a_steady_current_is_itself_all_along():
    found = around("current_constant:north=0.2,east=-0.1")
    assert found.current is not None and found.forces == {}
    np.testing.assert_allclose(found.current, np.tile([0.2, -0.1, 0.0], (300, 1)))


def test_a_steady_pull_keeps_its_direction_in_the_world_while_the_vehicle_turns():
    found = around("tether_tension:north=12,down=-5")
    assert found.current is None
    world = np.einsum("nij,nj->ni", rotation_from_euler(make_sim(RUN).windowed.eta[:, 3:]), found.forces["tether_tension"])
    np.testing.assert_allclose(world, np.tile([12.0, 0.0, -5.0], (300, 1)), atol=1e-5)


def test_a_tether_s_drag_opposes_the_motion_through_the_water():
    """Driven by the current alone it pulls with the current; coefficient times speed squared."""
    sim = make_sim(RUN)
    still = replace(sim, windowed=replace(sim.windowed, nu=np.zeros((300, 6))), effects=("tether_drag:coefficient=40", "current_constant:north=0.5"))
    drag = surroundings(RUN, still, MERLIN).forces["tether_drag"]
    assert np.linalg.norm(drag, axis=1) == pytest.approx(40 * 0.25, rel=1e-6)
    world = np.einsum("nij,nj->ni", rotation_from_euler(sim.windowed.eta[:, 3:]), drag)
    np.testing.assert_allclose(world[:, 0], 10.0, rtol=1e-6)


def test_what_was_not_simulated_has_no_force_and_effects_of_the_vehicle_none_at_all():
    sim = make_sim(RUN)
    nu = sim.windowed.nu.copy()
    eta = sim.windowed.eta.copy()
    nu[100:120], eta[100:120] = np.nan, np.nan
    gone = replace(sim, windowed=replace(sim.windowed, nu=nu, eta=eta), effects=("tether_tension:north=12",))
    assert np.isnan(surroundings(RUN, gone, MERLIN).forces["tether_tension"][100:120]).all()
    assert around("inflow_loss:loss=0.3") == Surroundings(None, {}) == around()
