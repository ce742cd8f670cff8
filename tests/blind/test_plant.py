"""The independent plant of the blind check: physics against closed forms, plantings that act, logs that tell nothing by shape."""

from __future__ import annotations

import csv
import json
import math
import re
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rovval.blind.cases import flight as plant
from rovval.blind.cases import generate
from rovval.blind.cases.csv_log import header, write_csv
from rovval.blind.cases.grid import BEGIN, DURATION_S, grid
from rovval.blind.cases.visibility import RecordedSpeeds, gap, visibility
from rovval.blind.missions.manoeuvres import MISSIONS
from rovval.blind.plant.dynamics import BASE, Plant
from rovval.blind.plant.environment import draw_setting
from rovval.blind.plant.motor import motor
from rovval.blind.plant.nominal_vehicle import read_vehicle
from rovval.blind.plant.parameters import nominal_parameters
from rovval.blind.plant.rotation import euler, matrix, quaternion
from rovval.blind.plant.scales import rpm_for, scales
from rovval.blind.plant.spec import AXES, STEP_S, Flight, Planted, stream
from rovval.blind.planted.catalogue import build, catalogue, names

ROOT = Path(__file__).parents[2]
LIBRARY = ROOT / "src/rovval/vehicle/library"
SHARED = ROOT.parent / "shared"
CONTRACT = tuple(
    """added_mass linear_drag quadratic_drag cross_drag current_constant current_shear current_varying waves
density_gradient ground_effect wall_suction tether_drag tether_tension tether_snag buoyancy_error cg_offset payload_change
inertia_error thruster_degraded thruster_fault_onset thruster_deadband thruster_reversed reverse_asymmetry thrust_lag
inflow_loss crossflow_loss hull_interaction thruster_interaction thruster_misaligned propeller_torque rpm_scale voltage_sag
time_offset clock_drift dvl_scale dvl_misalignment dvl_lever_arm gyro_bias compass_deviation attitude_bias
velocity_filter_lag""".split()
)


def vehicle(name: str) -> Path:
    for path in (LIBRARY / f"{name}.toml", SHARED / f"{name}.toml"):
        if path.exists():
            return path
    pytest.skip(f"no {name}.toml in {LIBRARY} or {SHARED}")


@pytest.fixture(scope="module")
def merlin() -> Path:
    return vehicle("merlin")


def bare(path: Path, *, neutral: bool, drag: float = 1.0) -> Plant:
    """The nominal vehicle with its shafts as given (at zero)."""
    nominal = read_vehicle(path)
    p = nominal_parameters(nominal)
    p.lin, p.quad = drag * p.lin, drag * p.quad
    if neutral:
        p.volume = p.mass / p.density
    return Plant(p, [], scales(nominal), RecordedSpeeds(np.zeros(len(nominal.thrusters))), bottom=1e6)


def run(body: Plant, y: np.ndarray, seconds: float) -> list[np.ndarray]:
    states, step = [y], 0.02
    for _ in range(round(seconds / STEP_S)):
        y, step = plant.integrate(body, 0.0, y, step, plant.tolerances(body, body.scale))
        states.append(y)
    return states


def thrown(body: Plant) -> np.ndarray:
    """Tilted and moving on all six axes."""
    y = np.zeros(body.size)
    y[2], y[3:7] = 20.0, quaternion(0.4, -0.3, 1.0)
    y[7:13] = body.mass @ np.array([0.6, -0.4, 0.3, 0.2, -0.15, 0.25])
    return y


def energy(body: Plant, y: np.ndarray) -> float:
    """Kinetic energy of body and water, and potential of weight and buoyancy."""
    down = np.array(matrix(*y[3:7])[6:9])
    p = body.p
    moment = p.mass * p.gravity_centre - p.density * p.volume * p.buoyancy_centre
    potential = -p.gravity * ((p.mass - p.density * p.volume) * y[2] + moment @ down)
    return float(0.5 * y[7:13] @ body.inverse @ y[7:13] + potential)


@pytest.mark.parametrize("name", ["merlin", "bluerov2_heavy"])
def test_energy_never_grows_without_thrust(name: str) -> None:
    body = bare(vehicle(name), neutral=False)
    levels = np.array([energy(body, y) for y in run(body, thrown(body), 30.0)])
    assert np.all(np.diff(levels) <= 1e-5 * abs(levels[0]))
    assert levels[-1] < levels[0]


@pytest.mark.parametrize("name", ["merlin", "bluerov2_heavy", "minerva"])
@pytest.mark.parametrize("effect", ["linear_drag", "quadratic_drag"])
def test_no_planted_drag_pushes_the_vehicle_on(name: str, effect: str) -> None:
    """Less drag than the file states is less drag, never a push, on a vehicle within slop (`SURE`) as well; more is more."""
    nominal = read_vehicle(vehicle(name))
    setting = draw_setting(nominal, scales(nominal), 1, 60.0)
    own = getattr(nominal, effect)
    for axis, target in enumerate(AXES):
        plantings = (build(Planted(effect, target, s), nominal, scales(nominal), setting) for s in (-1.0, 1.0))
        less, more = (float(np.asarray(planted.values["coefficient"])) for planted in plantings)
        assert 0.8 * own[axis] + less >= 0.0
        assert more > 0.0 and abs(less) == more


def test_without_drag_energy_and_world_momentum_are_kept(merlin: Path) -> None:
    body = bare(merlin, neutral=True, drag=0.0)
    states = run(body, thrown(body), 10.0)
    levels = [energy(body, y) for y in states]
    assert max(levels) - min(levels) < 1e-4 * abs(levels[0])
    world = [np.array(matrix(*y[3:7])).reshape(3, 3) @ y[7:10] for y in states]
    assert np.allclose(world, world[0], atol=1e-3 * np.linalg.norm(world[0]))


def test_steady_surge_speed_is_the_root_of_thrust_and_drag(merlin: Path) -> None:
    body, nominal = bare(merlin, neutral=True), read_vehicle(merlin)
    push = 700.0
    y = np.zeros(body.size)
    y[3] = 1.0
    y[BASE : BASE + body.many] = rpm_for(push * body.scale.share[:, 0], nominal.k_pos, nominal.k_neg)
    speed = body.see(0.0, run(body, y, 60.0)[-1]).vel[0]
    a, b = nominal.quadratic_drag[0], nominal.linear_drag[0]
    assert speed == pytest.approx((-b + math.sqrt(b * b + 4.0 * a * push)) / (2.0 * a), rel=1e-4)


def test_terminal_sink_speed(merlin: Path) -> None:
    body, nominal = bare(merlin, neutral=False), read_vehicle(merlin)
    y = np.zeros(body.size)
    y[3] = 1.0
    load = (nominal.mass - nominal.density * nominal.volume) * nominal.gravity
    sink = body.see(0.0, run(body, y, 240.0)[-1]).vel[2]
    a, b = nominal.quadratic_drag[2], nominal.linear_drag[2]
    assert sink == pytest.approx((-b + math.sqrt(b * b + 4.0 * a * load)) / (2.0 * a), rel=1e-3)


def test_a_current_carries_an_idle_vehicle_away(merlin: Path) -> None:
    nominal = read_vehicle(merlin)
    setting = draw_setting(nominal, scales(nominal), 1, 60.0)
    current = build(Planted("current_constant"), nominal, scales(nominal), setting)
    body = Plant(bare(merlin, neutral=True).healthy, [current], scales(nominal), RecordedSpeeds(np.zeros(7)), setting.bottom)
    last = run(body, plant.initial(body, setting), 60.0)[-1]
    k = body.see(0.0, last)
    ground = np.array(k.r).reshape(3, 3) @ k.vel[:3]
    assert np.allclose(ground[:2], k.water[:2], atol=0.25 * math.hypot(*k.water[:2]))


def test_quaternion_and_euler_agree_with_scipy() -> None:
    for angles in ((0.1, -0.4, 2.9), (-1.2, 1.1, -0.3), (3.0, 0.2, 0.0)):
        q = quaternion(*angles)
        other = Rotation.from_euler("ZYX", angles[::-1]).as_matrix()
        assert np.allclose(np.array(matrix(*q)).reshape(3, 3), other)
        assert np.allclose(euler(*q), angles)


def test_the_motor_settles_on_its_set_point(merlin: Path) -> None:
    nominal = read_vehicle(merlin)
    drive = motor(scales(nominal), 7, stream(1, "motor"))
    y, out = np.zeros(14), np.zeros(14)
    for _ in range(4000):
        drive.derivative(np.full(7, 150.0), y, out, 0, 7)
        y += 0.005 * out
    assert np.allclose(y[:7], 150.0, atol=0.5)


def test_the_whole_library_of_the_contract_and_a_dozen_foreign_effects_can_be_planted() -> None:
    assert set(names(foreign=False)) == set(CONTRACT)
    assert len(names(foreign=True)) >= 12
    assert all(row.severity_one and row.about for row in catalogue().values())


SECONDS = 24.0


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_vane_that_sticks_is_not_a_dead_thruster(merlin: Path, seed: int) -> None:
    """It keeps the thrust of some speed of before, so that one that never lets go is nothing that the library has."""
    [effect] = plant.fly(merlin, "station", [Planted("sticky_thruster", None, 2.0)], seed, 20.0, 0.0).truth["effects"]
    working = effect["values"]["band_rpm"] / (0.8 * 2.0)
    assert 0.5 * working <= abs(effect["values"]["first_rpm"]) <= working


@pytest.fixture(scope="module")
def healthy(merlin: Path) -> Flight:
    return plant.fly(merlin, "rich", [], 11, SECONDS)


def difference(a: Flight, b: Flight) -> float:
    """Largest change of any cell, in units of the column's spread."""
    found = 0.0
    for name, x in a.measured.items():
        both = np.isfinite(x) & np.isfinite(b.measured[name])
        change = np.abs((x - b.measured[name] + 180.0) % 360.0 - 180.0) if name == "Heading" else np.abs(x - b.measured[name])
        found = max(found, float(np.max(change[both])) / (float(np.std(x[both])) + 1e-9))
    return found


@pytest.mark.parametrize("name", [*CONTRACT, *names(foreign=True)])
def test_severity_zero_changes_nothing_and_one_changes_the_log(name: str, merlin: Path, healthy: Flight) -> None:
    none = plant.fly(merlin, "rich", [Planted(name, severity=0.0)], 11, 2.0)
    assert all(np.array_equal(x, healthy.true[key][: len(x)]) for key, x in none.true.items() if key != "voltage")
    full = plant.fly(merlin, "rich", [Planted(name)], 11, SECONDS)
    little = plant.fly(merlin, "rich", [Planted(name, severity=0.02)], 11, SECONDS)
    assert difference(full, healthy) > 0.05
    assert difference(little, healthy) < 0.5 * difference(full, healthy)
    assert full.measured.keys() == healthy.measured.keys()
    assert {len(x) for x in full.measured.values()} == {len(healthy.time_s)}
    assert full.start_of_day_s == healthy.start_of_day_s
    label = json.loads(json.dumps(full.truth))["effects"][0]
    assert label["name"] == name and label["values"] and label["realised"]
    assert catalogue()[name].event == (label["onset_s"] is not None)


def test_the_same_seed_gives_the_same_log_and_another_does_not(merlin: Path, healthy: Flight) -> None:
    again = plant.fly(merlin, "rich", [], 11, SECONDS)
    assert all(np.array_equal(x, again.measured[name], equal_nan=True) for name, x in healthy.measured.items())
    other = plant.fly(merlin, "rich", [], 12, SECONDS)
    assert not np.array_equal(other.true["u"], healthy.true["u"])


@pytest.mark.parametrize("mission", MISSIONS)
@pytest.mark.parametrize("name", ["merlin", "bluerov2_heavy", "minerva"])
def test_every_mission_flies_within_sane_limits(mission: str, name: str) -> None:
    flight = plant.fly(vehicle(name), mission, [], 5, 40.0)
    assert all(np.isfinite(x).all() for x in flight.true.values())
    assert np.max(np.abs([flight.true[k] for k in "uvw"])) < 2.0
    assert np.min(flight.true["altitude"]) > 0.0
    assert np.max(np.abs([flight.true["phi"], flight.true["theta"]])) < 1.2


def test_an_onset_leaves_what_was_before_it_alone(merlin: Path, healthy: Flight) -> None:
    late = plant.fly(merlin, "rich", [Planted("thruster_fault_onset", "HFP", onset_s=12.0)], 11, SECONDS)
    before = healthy.time_s < 11.95
    assert np.array_equal(late.true["u"][before], healthy.true["u"][before])
    assert not np.array_equal(late.true["u"], healthy.true["u"])


def test_a_reversed_thruster_turns_the_other_way(merlin: Path) -> None:
    """Not minus its thrust: its gains ahead and astern differ."""
    nominal = read_vehicle(merlin)
    reversed_ = build(Planted("thruster_reversed", "HFP"), nominal, scales(nominal), draw_setting(nominal, scales(nominal), 1, 60.0))
    body = Plant(nominal_parameters(nominal), [reversed_], scales(nominal), RecordedSpeeds(np.zeros(7)), 1e6)
    at = nominal.thrusters.index("HFP")
    y = np.zeros(body.size)
    y[3], y[BASE + at] = 1.0, 50.0
    assert body.see(0.0, y).thrust[at] == pytest.approx(-nominal.k_neg[at] * 50.0**2)
    y[BASE + at] = -50.0
    assert body.see(0.0, y).thrust[at] == pytest.approx(nominal.k_pos[at] * 50.0**2)


def test_wrong_names_targets_and_severities_are_refused(merlin: Path) -> None:
    for item in (Planted("gremlin"), Planted("thruster_degraded", "T9"), Planted("tether_drag", severity=-1.0)):
        with pytest.raises(ValueError, match=r"gremlin|T9|tether_drag"):
            plant.fly(merlin, "rich", [item], 1, 1.0)


def test_the_csv_has_the_header_of_the_hardware_log_and_three_columns_more(
    tmp_path: Path, merlin: Path, healthy: Flight
) -> None:
    write_csv(healthy, tmp_path / "log.csv")
    with (tmp_path / "log.csv").open(encoding="utf-8", newline="") as file:
        table = list(csv.reader(file))
    assert tuple(table[0]) == header(healthy.thrusters)
    assert table[0][:10] == [
        "Hour",
        "Minute",
        "Second",
        "Millisecond",
        "Latitude",
        "Longitude",
        "Depth",
        "Roll",
        "Pitch",
        "Heading",
    ]
    assert table[0][19:23] == ["VFP_SP", "VFP_PV", "VFS_SP", "VFS_PV"]
    assert table[0][-3:] == ["Altitude", "Voltage", "TetherLength"]
    assert len(table) == 1 + round(SECONDS / STEP_S)
    assert {len(row) for row in table} == {len(table[0])}
    at = table[0].index("LinVelX")
    assert any(row[at] == "" for row in table) and not any("nan" in row for row in table)
    heading = [float(row[9]) for row in table[1:]]
    assert min(heading) >= 0.0 and max(heading) <= 360.0


def test_the_generator_writes_logs_and_labels_apart(tmp_path: Path, merlin: Path) -> None:
    cases = [
        {"mission": "rich", "duration_s": 5.0},
        {"mission": "survey", "effects": [{"name": "buoyancy_error", "severity": 2.0}], "duration_s": 5.0, "seed": 7},
    ]
    (tmp_path / "cases.json").write_text(json.dumps(cases), encoding="utf-8")
    words = ["--vehicle", str(merlin), "--out", str(tmp_path / "logs"), "--seed", "1", "--cases", str(tmp_path / "cases.json")]
    assert generate.main(words) == 0
    labels = json.loads((tmp_path / "logs-labels" / "labels.json").read_text(encoding="utf-8"))["logs"]
    assert sorted(labels) == sorted(p.name for p in (tmp_path / "logs").iterdir())
    assert sorted(len(label["effects"]) for label in labels.values()) == [0, 1]


def test_the_grid_holds_every_effect_and_healthy_logs(merlin: Path) -> None:
    cases = grid(merlin, 1)
    assert {e.name for case in cases for e in case.effects} == set(catalogue())
    assert sum(not case.effects for case in cases) >= 40
    assert len({case.seed for case in cases}) == len(cases)
    assert {len(case.effects) for case in cases} == {0, 1, 2, 3}
    begun = [e for case in cases for e in case.effects if e.onset_s is not None]
    assert len(begun) == BEGIN and all(0.3 * DURATION_S <= float(e.onset_s or 0.0) <= 0.55 * DURATION_S for e in begun)


def test_the_plant_shares_no_code_with_what_it_tests() -> None:
    """Modules that make the truth import nothing of rovval but one another, refusals, and how a file is written whole."""
    rooms = ("plant", "planted", "missions", "cases")
    files = [path for room in rooms for path in (ROOT / "src/rovval/blind" / room).glob("*.py")]
    allowed = (*(f"rovval.blind.{room}" for room in rooms), "rovval.storage.atomic", "rovval.core.errors")
    assert {path.parent.name for path in files} == set(rooms)
    for path in files:
        used = re.findall(r"^\s*(?:from|import)\s+(rovval[\w.]*)", path.read_text(encoding="utf-8"), re.MULTILINE)
        assert all(name.startswith(allowed) for name in used), f"{path.name} imports {used}"


@pytest.mark.slow
@pytest.mark.parametrize("name", [*CONTRACT, *names(foreign=True)])
def test_severity_one_is_visible(name: str, merlin: Path) -> None:
    """The nominal replay's gap is larger than the healthy log's on some channel (bias effects show in parity, not here)."""
    parity = {"gyro_bias", "compass_deviation", "dvl_scale", "dvl_misalignment", "time_offset", "depth_port_error"}
    clean = gap(merlin, plant.fly(merlin, "rich", [], 3, 150.0))
    dirty = gap(merlin, plant.fly(merlin, "rich", [Planted(name)], 3, 150.0))
    assert visibility(dirty, clean)[0] > (1.0 if name in parity else 1.3)


def test_thrust_under_way_is_the_file_s_open_water_curve():
    """Minerva's K_T of the public project, ahead 0.5 J^3 - 0.66 J^2 - 0.25 J + 0.24, astern 0.025 J^3 - 0.28 J^2 + 0.17 J + 0.15."""
    nominal = read_vehicle(LIBRARY / "minerva.toml")
    body = Plant(nominal_parameters(nominal), [], scales(nominal), RecordedSpeeds(np.zeros(len(nominal.thrusters))), 1e6)
    unit, speed = nominal.thrusters.index("HS"), 0.4
    axial = float(nominal.directions[unit] @ np.array([speed, 0.0, 0.0]))
    for n, curve in ((600.0, (0.5, -0.66, -0.25, 0.24)), (-600.0, (0.025, -0.28, 0.17, 0.15))):
        j = axial / (n / 60.0 * nominal.diameter[unit])
        turn = np.full(len(nominal.thrusters), n)
        said = body.under_way(turn, [speed, 0.0, 0.0, 0.0, 0.0, 0.0])[unit]
        assert said == pytest.approx(np.polyval(curve, j) / curve[-1], rel=1e-6)
    assert not Plant(nominal_parameters(read_vehicle(LIBRARY / "merlin.toml")), [], scales(nominal), RecordedSpeeds(np.zeros(7)), 1e6).advancing


@pytest.mark.parametrize("name", ["merlin", "bluerov2_heavy"])
def test_what_is_scaled_by_force_stays_what_there_is(name: str):
    """Of a large severity: the step of density is no brine's, and the nodes of a tether weigh what a line of ordinary thickness weighs."""
    nominal = read_vehicle(vehicle(name))
    scale = scales(nominal)
    setting = draw_setting(nominal, scale, 5, DURATION_S)
    layer, line = cast(Any, [build(Planted(effect, severity=2.4), nominal, scale, setting) for effect in ("density_gradient", "tether_drag")])
    assert 0.0 < layer.values["half_step_density"] <= 14.0 + 1e-9
    thick, length = line.values["diameter_m"], line.values["length_m"]
    assert thick in (0.0076, 0.03) and 50.0 < length < 1000.0
    drag = 0.5 * nominal.density * line.values["normal_drag"] * thick * length * scale.speed**2
    assert drag == pytest.approx(2.5 * 2.4 * scale.force)
    in_water = 2.0 * nominal.density * math.pi / 4.0 * thick**2 * length  # neutral, and as much again of the water about it
    assert 5.0 * line.node_mass == pytest.approx(in_water) and in_water < 2.0 * nominal.mass
