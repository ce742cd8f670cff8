"""Plant b against what must hold of any vehicle in water: energy, momentum, mirror symmetry, the order of the integrator, closed forms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from blind_case import vehicle_file
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from rovval.blind.plant.spec import Planted
from rovval.blind.second.blades import Drives, blade
from rovval.blind.second.catalogue import plant
from rovval.blind.second.fault import Site
from rovval.blind.second.hull import hull
from rovval.blind.second.motion import Craft, rotation, turned
from rovval.blind.second.sheet import read

SITE = Site(60.0, 20.0, 1e6, 0.0, np.zeros(3), 0.2)
THROWN = np.array([0.6, -0.4, 0.3, 0.2, -0.15, 0.25])


def craft(name: str, *effects: Planted, drag: float = 1.0, neutral: bool = False) -> Craft:
    """The sheet's vehicle with still shafts at 20 m, tilted and moving on all axes."""
    sheet = read(vehicle_file(name))
    body = hull(sheet, 0.0, np.random.default_rng(0))
    body.level = [drag * a for a in body.level]
    if neutral:
        body.volume = body.mass / body.density
    made = Craft(sheet, body, Drives(sheet, np.random.default_rng(0)), [plant(e, sheet, SITE, 1) for e in effects], SITE.seabed)
    made.at, made.q, made.nu = np.array([0.0, 0.0, 20.0]), turned(np.array([1.0, 0.0, 0.0, 0.0]), np.array([0.4, -0.3, 1.0])), THROWN.copy()
    return made


def energy(c: Craft) -> float:
    """Kinetic energy of body and water, and potential of weight and buoyancy."""
    h, down = c.hull, rotation(c.q)[2]
    moment = h.mass * h.cg - h.density * h.volume * h.cb
    return float(0.5 * c.nu @ (c.mass[0] + c.mass[1]) @ c.nu - h.gravity * ((h.mass - h.density * h.volume) * c.at[2] + moment @ down))


def flown(c: Craft, seconds: float, dt: float) -> Craft:
    for _ in range(round(seconds / dt)):
        c.step(dt)
    return c


@pytest.mark.parametrize("name", ["merlin", "bluerov2_heavy", "minerva"])
def test_energy_never_grows_without_thrust(name: str) -> None:
    c = craft(name)
    before = kinetic = energy(c)
    for _ in range(300):
        c.step()
        assert energy(c) <= before + 1e-5 * abs(kinetic)
        before = energy(c)
    assert before < kinetic


def test_without_drag_energy_and_world_momentum_are_kept() -> None:
    c = craft("merlin", drag=0.0, neutral=True)
    energy_0, world_0 = energy(c), rotation(c.q) @ ((c.mass[0] + c.mass[1]) @ c.nu)[:3]
    flown(c, 10.0, 0.02)
    assert energy(c) == pytest.approx(energy_0, rel=1e-4)
    assert np.allclose(rotation(c.q) @ ((c.mass[0] + c.mass[1]) @ c.nu)[:3], world_0, atol=1e-3 * np.linalg.norm(world_0))


@pytest.mark.parametrize("name", ["bluerov2_heavy", "minerva"])
def test_half_the_step_leaves_a_quarter_of_the_error(name: str) -> None:
    ends = [np.array([*c.at, *c.nu]) for c in (flown(craft(name), 3.0, dt) for dt in (0.04, 0.02, 0.01, 0.0025))]
    coarse, middle, fine = (float(np.linalg.norm(end - ends[3])) for end in ends[:3])
    assert fine < 2e-3
    assert 3.0 < coarse / middle < 6.0


@pytest.mark.parametrize("name", ["bluerov2_heavy", "minerva"])
def test_port_and_starboard_are_alike(name: str) -> None:
    """A vehicle that is symmetric moves as its mirror image where it is thrown as its mirror image."""
    c, image = craft(name), craft(name)
    flip = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    image.nu = flip * c.nu
    image.q = c.q * np.array([1.0, -1.0, 1.0, -1.0])
    flown(c, 5.0, 0.02)
    flown(image, 5.0, 0.02)
    assert np.allclose(image.nu, flip * c.nu, atol=1e-9)
    assert np.allclose(image.at, c.at * np.array([1.0, -1.0, 1.0]), atol=1e-9)


def test_an_idle_vehicle_goes_with_the_water_and_is_not_turned_by_it() -> None:
    """A uniform current carries a neutral vehicle at rest in it for ever (d'Alembert), however it lies."""
    c = craft("bluerov2_heavy", Planted("current_constant"), neutral=True)
    current = c.faults[0]
    vars(current).update(eddy=np.zeros_like(vars(current)["eddy"]))
    c.q = turned(np.array([1.0, 0.0, 0.0, 0.0]), np.array([0.0, 0.0, 0.7]))
    c.nu = np.array([*(current.current(0.0, c.at) @ rotation(c.q)), 0.0, 0.0, 0.0])
    before = c.nu.copy()
    flown(c, 20.0, 0.02)
    assert np.allclose(c.nu, before, atol=1e-9)


def test_steady_speed_is_where_thrust_and_the_power_law_meet() -> None:
    c = craft("merlin", neutral=True)
    c.q, c.nu = np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(6)
    speeds = c.sheet.speeds(700.0 * c.sheet.share[:, 0])
    c.drives.n = c.drives.wanted = speeds
    flown(c, 60.0, 0.05)
    push = float((c.lever @ (np.where(speeds > 0, c.hull.ahead, c.hull.astern) * speeds * np.abs(speeds)))[0])
    assert c.nu[0] == pytest.approx(brentq(lambda v: c.hull.level[0] * v ** c.hull.power[0] - push, 0.0, 3.0), rel=1e-3)
    assert c.hull.level[0] * c.sheet.cruise ** c.hull.power[0] == pytest.approx(c.sheet.drag(0, c.sheet.cruise))


def test_rotations_are_those_of_scipy() -> None:
    q = np.array([1.0, 0.0, 0.0, 0.0])
    other = Rotation.identity()
    for by in ([0.3, -0.2, 0.5], [1e-9, 0.0, 0.0], [-1.1, 0.4, 2.0]):
        q, other = turned(q, np.array(by)), other * Rotation.from_rotvec(by)
    assert np.allclose(rotation(q), other.as_matrix(), atol=1e-12)


def test_blades_give_bollard_thrust_at_rest_and_less_with_inflow_and_mirror_in_reverse() -> None:
    n, wide = np.array([10.0, 40.0, 200.0]), np.full(3, 0.5)
    assert np.allclose(blade(n, np.zeros(3), wide), n * n)
    flows = [blade(np.array([200.0]), np.array([v]), wide[:1])[0] for v in np.linspace(-1.0, 3.0, 9)]
    assert np.all(np.diff(flows) < 0.0) and flows[-1] < 0.0
    assert np.allclose(blade(-n, np.full(3, -0.4), wide), -blade(n, np.full(3, 0.4), wide))


def test_a_drive_settles_and_keeps_its_slew() -> None:
    drives = Drives(read(vehicle_file("merlin")), np.random.default_rng(0))
    drives.wanted = np.full(7, 100.0)
    rows = [drives.n]
    for _ in range(1000):
        drives.n = drives.after(0.02)
        rows.append(drives.n)
    assert np.allclose(drives.n, 100.0, atol=1e-6)
    assert float(np.abs(np.diff(rows, axis=0)).max()) <= 0.02 * drives.slew * (1.0 + 1e-9)


def test_nothing_of_another_plant_or_of_the_simulator_is_in_it() -> None:
    """Of rovval it imports what a flight takes and gives, and itself."""
    room = Path(__file__).parents[3] / "src" / "rovval" / "blind" / "second"
    lines = [line for path in room.rglob("*.py") for line in path.read_text(encoding="utf-8").splitlines()]
    found = {line.split()[1] for line in lines if line.startswith(("from rovval", "import rovval"))}
    assert {name for name in found if not name.startswith("rovval.blind.second")} == {"rovval.blind.plant.spec"}
