"""Parity residuals: a fault of a sensor is found with its size, and none where the sensors are sound."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnose_case import merlin, own, with_values
from kinematic import spoilt
from tumbling import bluerov2, tumbling

from rovval.core.data import Array, Reason, Run
from rovval.core.errors import Finding
from rovval.diagnose.residuals.parity import ParityResiduals, parity_residuals
from rovval.diagnose.residuals.sensor_faults import FittedFault, sensor_faults
from rovval.diagnose.windows.conditioning import condition
from rovval.diagnose.windows.multiple_shooting import cut_run
from rovval.effects import load
from rovval.vehicle.model import Vehicle


def faults_of(run: Run, of: Vehicle | None = None) -> dict[str, FittedFault]:
    """Every fault of the library that the parity residuals of a log are fitted with, by its parameter."""
    part = cut_run(run, of or merlin(), "fossen", 10.0)
    sensor = tuple(i for i, s in enumerate(part.plant.slots) if load(s.effect).place == "sensor")
    return {found.fault: found for found in sensor_faults(parity_residuals(part, sensor), part, part.plant.null)}


@pytest.mark.parametrize(
    ("fault", "size"),
    [
        ("gyro_bias.r", 0.01), ("gyro_bias.p", -0.008), ("dvl_scale.scale", 0.05), ("dvl_scale.scale", -0.04), ("dvl_scale.surge", 0.05),
        ("dvl_misalignment.yaw", 0.08), ("dvl_lever_arm.x", 0.8), ("attitude_bias.phi", 0.06), ("attitude_bias.theta", -0.05),
        ("compass_deviation.offset", 0.1), ("time_offset[velocity].delay", 0.4), ("time_offset[attitude].delay", 0.4),
    ],
)  # fmt: skip
def test_parity_finds_a_sensor_fault_with_sign_and_size(fault, size):
    found = faults_of(spoilt({fault: size}))[fault]
    assert found.significant
    assert found.value == pytest.approx(size, rel=0.15)


@pytest.mark.parametrize(("fault", "size"), [("gyro_bias.p", 0.01), ("gyro_bias.q", -0.02), ("dvl_scale.scale", 0.08)])
def test_parity_of_a_vehicle_that_tumbles_finds_a_fault_and_none_in_sound_sensors(fault: str, size: float):
    found = faults_of(tumbling((f"{fault.replace('.', ':')}={size}",)), bluerov2())
    assert found[fault].significant
    assert found[fault].value == pytest.approx(size, rel=0.15)
    sound = faults_of(tumbling(), bluerov2())[fault]
    assert not sound.significant
    assert abs(sound.value) < 0.1 * abs(size)


def test_of_a_heading_that_counts_from_the_start_the_zero_is_no_fault():
    """It was found by turning the way that the velocities make onto that of the position."""
    run = spoilt({"compass_deviation.offset": 0.3})
    assert faults_of(run)["compass_deviation.offset"].significant
    found = faults_of(replace(run, findings=(Finding("heading_zero", "psi", "17 deg between heading and position"),)))
    assert "compass_deviation.offset" not in found, "nothing is known of it"
    assert not any(one.significant for one in found.values())


@pytest.mark.parametrize(
    ("fault", "size"), [("dvl_scale.scale", 0.08), ("gyro_bias.r", 0.01), ("dvl_lever_arm.x", 0.8), ("dvl_misalignment.yaw", 0.2)]
)
def test_of_a_heading_that_counts_from_the_start_all_other_faults_show(fault: str, size: float):
    found = faults_of(replace(spoilt({fault: size}), findings=(Finding("heading_zero", "psi", "left as logged"),)))[fault]
    assert found.significant and found.value == pytest.approx(size, rel=0.15)


def test_no_fault_is_fitted_to_fewer_windows_than_its_scatter_needs():
    """A log of which the yaw rate is missing but for 11 s here and there, as where a gyro stands at its stop: four windows, which a few numbers fit."""
    run = own((), 5, 120.0)
    r = np.where(np.arange(len(run)) % 300 < 110, run.get("r"), np.nan)
    reasons = np.where(np.isnan(r), Reason.NOT_LOGGED, Reason.OK).astype(np.uint8)
    sparse = faults_of(replace(run, values={**run.values, "r": r}, reasons={**run.reasons, "r": reasons}))
    assert not sparse, "each interval would have no width"
    whole = faults_of(run)
    assert whole and not any(found.significant for found in whole.values())


def test_parity_about_another_point_is_that_of_its_moved_rows():
    """Products from those at the null value against the rows moved one by one; other columns, in another order, some without a signature."""
    part = cut_run(spoilt({"gyro_bias.r": 0.01, "dvl_scale.scale": 0.05}), merlin(), "fossen", 10.0)
    index = part.plant.index
    rows = parity_residuals(part, tuple(i for i, s in enumerate(part.plant.slots) if s.effect != "dvl_lever_arm"))
    beta = part.plant.null.copy()
    for key, value in (("gyro_bias.r", 0.008), ("dvl_scale.scale", 0.04), ("dvl_misalignment.yaw", -0.1), ("buoyancy_error.force", 30.0)):
        beta[index[key]] = value
    columns = tuple(index[key] for key in ("inflow_loss.loss", "dvl_misalignment.yaw", "gyro_bias.r", "gyro_bias.p", "dvl_scale.scale"))
    place = [rows.columns.index(c) for c in columns]
    scale, taken = index["dvl_scale.scale"], beta.copy()
    taken[scale] = 0.04 / 1.04  # of a velocity that is 1.04 times the true one, the fault is 0.04 / 1.04
    T, r = rows.signatures[..., place].copy(), rows.rows - rows.signatures @ taken[list(rows.columns)]
    T[..., columns.index(scale)] /= 1.04**2
    got = rows.normal_equations(beta, (*columns, len(part.plant.slots)), 2.0 * rows.design_effect)
    assert got.columns == (*columns, len(part.plant.slots)) and not got.A[:, -1].any() and not got.b[:, -1].any()
    wanted = np.einsum("wqi,wqj->wij", T, T), np.einsum("wqi,wq->wi", T, r), (r**2).sum(axis=1)
    for found, want in zip((got.A[:, :-1, :-1], got.b[:, :-1], got.c), wanted, strict=True):
        assert np.abs(found - 2.0 * want).max() < 1e-12 * np.abs(want).max()


def test_losses_by_relation_add_up_and_show_where_a_fault_is():
    """A gyro that drifts in yaw spoils the heading, and nothing of the depth; told what it is, it spoils neither."""
    part = cut_run(spoilt({"gyro_bias.r": 0.01}), merlin(), "fossen", 10.0)
    sensors = tuple(i for i, s in enumerate(part.plant.slots) if load(s.effect).place == "sensor")
    check, null, everywhere = parity_residuals(part, sensors), part.plant.null.copy(), np.ones(part.count, dtype=bool)
    told = null.copy()
    told[part.plant.index["gyro_bias.r"]], told[part.plant.index["dvl_scale.scale"]] = 0.01, 0.02
    for beta in (null, told):
        losses = check.losses(beta, 2.0, everywhere)
        assert sum(losses.values()) == pytest.approx(check.normal_equations(beta, (), 2.0).c.sum(), rel=1e-9)
        half = everywhere & (np.arange(part.count) % 2 == 0)
        for name, loss in losses.items():
            assert check.losses(beta, 2.0, half)[name] + check.losses(beta, 2.0, ~half)[name] == pytest.approx(loss)
    told[part.plant.index["dvl_scale.scale"]] = 0.0
    before, after = check.losses(null, 2.0, everywhere), check.losses(told, 2.0, everywhere)
    assert after["psi"] < 0.2 * before["psi"] and after["z"] == pytest.approx(before["z"], rel=0.2)
    tolerated = check.tolerated({part.plant.index["gyro_bias.r"]: 0.01}, 2.0)
    assert max(tolerated, key=lambda name: tolerated[name]) == "psi" and tolerated["psi"] == pytest.approx(before["psi"] - after["psi"], rel=0.2)


def test_a_velocity_scale_is_read_without_the_bias_of_its_tangent():
    """12 % too large: the tangent at nothing would say 0.12 / 1.12."""
    part = cut_run(spoilt({"dvl_scale.scale": 0.12}), merlin(), "fossen", 10.0)
    slot = part.plant.index["dvl_scale.scale"]
    rows, beta = parity_residuals(part, (slot,)), part.plant.null.copy()
    for _ in range(4):
        one = rows.normal_equations(beta, (slot,), rows.design_effect)
        beta[slot] += float(one.b.sum() / one.A.sum())
    assert beta[slot] == pytest.approx(0.12, abs=0.004)


@pytest.mark.parametrize("name", ["time_offset[velocity].delay", "time_offset[attitude].delay"])
@pytest.mark.parametrize("late", [1.2, -0.9])
def test_a_late_sensor_is_read_without_the_bias_of_its_tangent(name: str, late: float):
    """Of a vehicle that turns, at the delay the horizontal rows are nearly those of the sound log; a signature that is taken for linear leaves much."""
    parts = [cut_run(spoilt(fault), merlin(), "fossen", 10.0) for fault in ({name: late}, {})]
    slot = parts[0].plant.index[name]
    (rows, sound), beta = (parity_residuals(part, (slot,)) for part in parts), parts[0].plant.null.copy()
    beta[slot] = late

    def metres(whiten: Array, check: ParityResiduals) -> float:
        return float(np.sqrt(np.mean((whiten.reshape(len(whiten), -1, 6) * check.sigma)[..., :2] ** 2)))

    straight = metres(rows.rows - rows.signatures[..., 0] * late, rows)
    assert metres(rows.at_delays(beta)[0], rows) < min(1.2 * metres(sound.rows, sound), 0.95 * straight)
    found = faults_of(spoilt({name: late}))[name]
    assert found.significant and found.value == pytest.approx(late, rel=0.05)


def test_parity_of_healthy_sensors_finds_nothing():
    assert not [name for name, row in faults_of(spoilt({})).items() if row.significant]


def test_a_fault_of_a_size_that_it_cannot_have_is_none():
    """Velocities in steps of 0.2 m/s, held between pings, were read as 41 s late."""
    run = own((), 5, 300.0)
    pinged = np.arange(len(run)) // 16 * 16
    coarse, _ = condition(with_values(run, **{c: np.round(run.get(c)[pinged] / 0.2) * 0.2 for c in "uvw"}))
    late = faults_of(coarse)["velocity_filter_lag.dead"]
    assert late.low > 0.0 and late.value > 1.5, "the least squares estimate, far from linear"
    assert not late.significant
