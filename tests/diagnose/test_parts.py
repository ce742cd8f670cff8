"""Parts of the diagnosis engine against brute force, planted truth and their own null."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnose_case import NOISE, bare, commands, merlin, own

from rovval.core.data import Array, Reason, Run
from rovval.core.frames import euler_rates, rotation_from_euler
from rovval.diagnose.hypotheses.hypothesis import columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis
from rovval.diagnose.problem.cross_validation import Fold, FoldSums, contest, cross_validate, held_out_losses, make_folds
from rovval.diagnose.problem.problem import pose
from rovval.diagnose.residuals.coherence import coherence
from rovval.diagnose.residuals.normal_equations import (
    Linearisation,
    NormalEquations,
    normal_equations,
    nuisance_corrected,
    whiten,
    with_frozen_columns,
)
from rovval.diagnose.residuals.parity import ParityResiduals, parity_residuals
from rovval.diagnose.residuals.ridge import Prior
from rovval.diagnose.residuals.sensor_faults import FittedFault, sensor_faults
from rovval.diagnose.result.attribution import slices, worst
from rovval.diagnose.windows.multiple_shooting import cut_run
from rovval.diagnose.windows.windows import Windows, axis_channels
from rovval.effects import load

RNG = np.random.default_rng


def random_linear(seed: int = 0, m: int = 6, n: int = 9, c: int = 3, k: int = 4, s: int = 2) -> tuple[Linearisation, np.ndarray, Array, Array]:
    rng = RNG(seed)
    linear = Linearisation(
        rng.normal(size=(m, n, c)), rng.normal(size=(m, n, c, k)), rng.normal(size=(m, n, c, s)), tuple(range(10, 10 + k)), np.ones(m, dtype=bool)
    )
    return linear, rng.random((m, n, c)) > 0.2, rng.uniform(0.5, 2, (n, c)), rng.uniform(0.1, 3, s)


def test_products_are_the_inner_products_of_the_full_covariance():
    """A, b, c with V = diag(variance) + J Sigma J^T inverted as a whole over the samples that hold a value."""
    linear, ok, variance, spread = random_linear()
    got = normal_equations(linear, ok, variance, spread)
    for w in range(len(ok)):
        keep = ok[w].ravel()
        J, S, r = (x[w].reshape(keep.size, -1)[keep] for x in (linear.J, linear.S, linear.r))
        V = np.diag(variance.ravel()[keep]) + (J * spread**2) @ J.T
        weighed = np.linalg.solve(V, np.concatenate([S, r], axis=1))
        np.testing.assert_allclose(got.A[w], S.T @ weighed[:, :-1], rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(got.b[w], S.T @ weighed[:, -1], rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(got.c[w], (r.T @ weighed[:, -1:])[0, 0], rtol=1e-9)


def test_slopes_that_stand_still_give_the_same_products():
    """Own columns beside those of a linearisation nearby, in its metric, with another residual: as if all were made anew; a window that stops
    there has no slopes, its nuisances with them, and costs what it errs."""
    near, ok, variance, spread = random_linear(3)
    own = replace(random_linear(4, k=2)[0], columns=(11, 3), valid=np.arange(6) != 4)
    own.S[4] = 0.0
    got = with_frozen_columns(own, whiten(near, ok, variance, spread), (13, 10))
    S, J = np.concatenate([own.S, near.S[..., [3, 0]]], axis=-1), near.J.copy()
    S[4], J[4] = 0.0, 0.0
    whole = Linearisation(own.r, S, J, (11, 3, 13, 10), own.valid)
    want, there = normal_equations(whole, ok, variance, spread), got.normal_equations(own.r)
    assert there.columns == want.columns
    np.testing.assert_allclose(got.linear.S, S * ok[..., None], rtol=1e-12)
    assert there.c[4] == pytest.approx(((own.r[4] ** 2 / variance) * ok[4]).sum())
    for one, other in ((there.A, want.A), (there.b, want.b), (there.c, want.c)):
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9)
    other_r = RNG(5).normal(size=own.r.shape)
    moved = normal_equations(replace(whole, r=other_r), ok, variance, spread)
    np.testing.assert_allclose(got.normal_equations(other_r).b, moved.b, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(got.normal_equations(other_r).c, moved.c, rtol=1e-9, atol=1e-9)


def test_start_states_are_taken_out_as_ridge_regression_does():
    linear, ok, variance, spread = random_linear(1)
    got = nuisance_corrected(linear, ok, variance, spread)
    root = (np.where(ok, 1.0, 0.0) / np.sqrt(variance)).reshape(len(ok), -1)
    for w in range(len(ok)):
        J, r = linear.J[w].reshape(root.shape[1], -1), linear.r[w].ravel()
        stacked = np.concatenate([J * root[w][:, None], np.diag(1 / spread)])
        x = np.linalg.lstsq(stacked, np.concatenate([r * root[w], np.zeros(len(spread))]), rcond=None)[0]
        np.testing.assert_allclose(got[w], np.where(ok[w], (r - J @ x).reshape(ok[w].shape), 0.0), atol=1e-9)


def test_contest_is_ridge_regression_on_held_out_windows():
    rng, m, n, k, design_effect = RNG(2), 10, 12, 5, 3.0
    S, r = rng.normal(size=(m, n, k)), rng.normal(size=(m, n))
    data = NormalEquations(np.einsum("wni,wnj->wij", S, S), np.einsum("wni,wn->wi", S, r), (r**2).sum(axis=1), tuple(range(k)))
    folds, prior = make_folds(np.zeros(m, dtype=int)), Prior({1: 0.5, 3: 2.0})

    def brute(train: np.ndarray) -> Array:
        X = np.concatenate([S[train][:, :, [1, 3]].reshape(-1, 2), np.sqrt(design_effect) * np.diag([2.0, 0.5])])
        return np.asarray(np.linalg.lstsq(X, np.concatenate([r[train].ravel(), [0, 0]]), rcond=None)[0])

    held = sum(((r[f.test] - S[f.test][:, :, [1, 3]] @ brute(f.train)) ** 2).sum() for f in folds)
    ring = FoldSums.of(data, folds)
    base, named = contest(ring, Prior({1: 0.5}), {"both": Prior({3: 2.0})}, design_effect)
    assert named["both"].loss == pytest.approx(held)
    assert base.loss == pytest.approx(cross_validate(ring, Prior({1: 0.5}), design_effect).loss)
    assert held_out_losses(data, folds, prior, design_effect).sum() == pytest.approx(held)
    np.testing.assert_allclose(named["both"].step[[1, 3]], brute(np.ones(m, dtype=bool)))


def test_folds_hold_logs_out_where_there_are_enough():
    def tests(folds: tuple[Fold, ...]) -> list[list[int]]:
        return [np.flatnonzero(f.test).tolist() for f in folds]

    assert tests(make_folds(np.array([0, 0, 1, 1, 2]))) == [[0, 1], [2, 3], [4]]
    assert tests(make_folds(np.zeros(6, dtype=int))) == [[0, 1], [2], [3], [4], [5]]
    assert all(not (f.train & f.test).any() and (f.train | f.test).all() for f in make_folds(np.zeros(7, dtype=int)))


def test_coherence_knows_the_same_and_the_foreign():
    x = RNG(3).normal(size=(200, 3))
    S = np.concatenate([x, x[:, :1] * 2], axis=1)[None]
    data = NormalEquations(np.einsum("wni,wnj->wij", S, S), np.zeros((1, 4)), np.zeros(1), (0, 1, 2, 3))
    assert coherence(data, (0,), (3,)) == pytest.approx(1.0)
    assert coherence(data, (0,), (1,)) == pytest.approx(abs(float(np.asarray(np.corrcoef(x.T))[0, 1])), abs=0.05)
    assert coherence(data, (0, 1), (1, 2)) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("name", "truth"),
    [
        ("quadratic_drag[surge]", {"scale": 0.4}),
        ("thruster_degraded[HAS]", {"loss": 0.3}),
        ("buoyancy_error", {"force": 60.0}),
        ("inflow_loss", {"loss": 0.25}),
    ],
)
def test_confirm_recovers_what_was_planted(name, truth):
    setting = f"{name}:" + ",".join(f"{p}={v}" for p, v in truth.items())
    parts = (cut_run(own((setting,), 4, 120.0), merlin(), "fossen", 10.0),)
    library = [h for h in hypotheses(parts)[0] if h.name == name]
    problem = pose(parts, columns_of(library), 0.05)
    done = fit_hypothesis(problem, problem.origin, library[0].slots)
    for slot in library[0].slots:
        p = problem.plant.slots[slot].parameter
        if p.name in truth:
            assert done.beta[slot] == pytest.approx(truth[p.name], abs=0.1 * p.typical)
    assert done.evidence > 20
    assert done.dynamics_loss.sum() < 0.6 * problem.gap.dynamics.c.sum()  # what is left is noise


# -- parity ------------------------------------------------------------------------------------------------------------------------


def kinematic(seed: int, seconds: float = 300.0) -> dict[str, Array]:
    """Motion that no vehicle's dynamics made: smooth random velocities, integrated in numpy at 10 ms, pose and velocity exact."""
    n, fine, rng = round(10 * seconds), 100, RNG(seed)
    t = np.arange(n * fine) * 0.1 / fine
    size = np.array([0.6, 0.3, 0.15, 0.02, 0.02, 0.15])
    waves = [(rng.uniform(0.05, 0.6, 6), rng.uniform(0, 6.28, 6)) for _ in size]
    nu: Array = np.stack([a * np.sin(np.outer(t, f) + p).sum(axis=1) / 2 for a, (f, p) in zip(size, waves, strict=True)], axis=1)
    eta = np.empty((n, 6))
    state: Array = np.array([0, 0, 30.0, 0, 0, 0.5])
    for i in range(len(t)):
        if i % fine == 0:
            eta[i // fine] = state
        if i % 10 == 0:  # Euler steps of 10 ms are ample for pose over a window of 10 s
            middle = np.asarray(nu[min(i + 5, len(t) - 1)])
            world = np.einsum("ij,j->i", rotation_from_euler(state[None, 3:])[0], middle[:3])
            state = np.asarray(state + 0.1 / fine * 10 * np.concatenate([world, euler_rates(state[None, 3:], middle[None, 3:]).ravel()]))
    return dict(zip((*"uvwpqr", "x", "y", "z", "phi", "theta", "psi"), np.concatenate([nu[::fine], eta], axis=1).T, strict=True))


KINEMATIC = kinematic(8)


def spoilt(fault: dict[str, float]) -> Run:
    """The motion as sensors with ``fault`` log it, in plain numpy, with noise."""
    log = {c: np.array(x) for c, x in KINEMATIC.items()}
    if "dvl_scale.scale" in fault:
        for c in "uvw":
            log[c] = log[c] * (1 + fault["dvl_scale.scale"])
    log["u"] = log["u"] * (1 + fault.get("dvl_scale.surge", 0.0))
    if "dvl_misalignment.yaw" in fault:
        a = fault["dvl_misalignment.yaw"]
        log["u"], log["v"] = np.cos(a) * log["u"] + np.sin(a) * log["v"], np.cos(a) * log["v"] - np.sin(a) * log["u"]
    if "dvl_lever_arm.x" in fault:
        log["v"], log["w"] = log["v"] + fault["dvl_lever_arm.x"] * log["r"], log["w"] - fault["dvl_lever_arm.x"] * log["q"]
    for c in "uvw":
        t = np.arange(len(log[c])) * 0.1
        log[c] = np.interp(t - fault.get("time_offset[velocity].delay", 0.0), t, log[c])
    for c in ("p", "q", "r", "phi", "theta", "psi"):
        log[c] = np.interp(t - fault.get("time_offset[attitude].delay", 0.0), t, log[c])
    for c in "pqr":
        log[c] = log[c] + fault.get(f"gyro_bias.{c}", 0.0)
    for c in ("phi", "theta"):
        log[c] = log[c] + fault.get(f"attitude_bias.{c}", 0.0)
    log["psi"] = log["psi"] + fault.get("compass_deviation.offset", 0.0)
    rng = RNG(9)
    seen = {c: x + NOISE[c] * rng.normal(size=len(x)) for c, x in log.items()}
    idle = {f"n:{name}": np.zeros(len(log["u"])) for name in merlin().thrusters}
    return bare(idle | seen, merlin(), "kinematic")


def parity_of(run: Run) -> dict[str, FittedFault]:
    part = cut_run(run, merlin(), "fossen", 10.0)
    sensor = tuple(i for i, s in enumerate(part.plant.slots) if load(s.effect).place == "sensor")
    return {row.fault: row for row in sensor_faults(parity_residuals(part, sensor), part, part.plant.null)}


@pytest.mark.parametrize(
    ("fault", "size"),
    [
        ("gyro_bias.r", 0.01), ("gyro_bias.p", -0.008), ("dvl_scale.scale", 0.05), ("dvl_scale.scale", -0.04), ("dvl_scale.surge", 0.05),
        ("dvl_misalignment.yaw", 0.08), ("dvl_lever_arm.x", 0.8), ("attitude_bias.phi", 0.06), ("attitude_bias.theta", -0.05),
        ("compass_deviation.offset", 0.1), ("time_offset[velocity].delay", 0.4), ("time_offset[attitude].delay", 0.4),
    ],
)  # fmt: skip
def test_parity_finds_a_sensor_fault_with_sign_and_size(fault, size):
    row = parity_of(spoilt({fault: size}))[fault]
    assert row.significant
    assert row.value == pytest.approx(size, rel=0.15)


def test_a_fault_is_not_told_of_fewer_windows_than_its_scatter_needs():
    """A log of which the yaw rate is missing but for 11 s here and there, as where a gyro stands at its stop: four windows, which a few numbers fit."""
    run = own((), 5, 120.0)
    r = np.where(np.arange(len(run)) % 300 < 110, run.get("r"), np.nan)
    reasons = np.where(np.isnan(r), Reason.NOT_LOGGED, Reason.OK).astype(np.uint8)
    told = parity_of(replace(run, values={**run.values, "r": r}, reasons={**run.reasons, "r": reasons}))
    assert not told, "each interval would have no width"
    whole = parity_of(run)
    assert whole and {row.significant for row in whole.values()} <= {False}


def test_parity_about_another_point_is_that_of_its_moved_rows():
    """Products from those at the null value against the rows moved one by one; other columns, in another order, some without a trace."""
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
    T, r = rows.traces[..., place].copy(), rows.rows - rows.traces @ taken[list(rows.columns)]
    T[..., columns.index(scale)] /= 1.04**2
    got = rows.normal_equations(beta, (*columns, len(part.plant.slots)), 2.0 * rows.design_effect)
    assert got.columns == (*columns, len(part.plant.slots)) and not got.A[:, -1].any() and not got.b[:, -1].any()
    wanted = np.einsum("wqi,wqj->wij", T, T), np.einsum("wqi,wq->wi", T, r), (r**2).sum(axis=1)
    for found, want in zip((got.A[:, :-1, :-1], got.b[:, :-1], got.c), wanted, strict=True):
        assert np.abs(found - 2.0 * want).max() < 1e-12 * np.abs(want).max()


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
    """Of a vehicle that turns, at the delay the horizontal rows are nearly those of the sound log; a straight trace leaves much."""
    parts = [cut_run(spoilt(fault), merlin(), "fossen", 10.0) for fault in ({name: late}, {})]
    slot = parts[0].plant.index[name]
    (rows, sound), beta = (parity_residuals(part, (slot,)) for part in parts), parts[0].plant.null.copy()
    beta[slot] = late

    def metres(whiten: Array, check: ParityResiduals) -> float:
        return float(np.sqrt(np.mean((whiten.reshape(len(whiten), -1, 6) * check.sigma)[..., :2] ** 2)))

    straight = metres(rows.rows - rows.traces[..., 0] * late, rows)
    assert metres(rows.undone(beta)[0], rows) < min(1.2 * metres(sound.rows, sound), 0.95 * straight)
    told = parity_of(spoilt({name: late}))[name]
    assert told.significant and told.value == pytest.approx(late, rel=0.05)


def test_parity_of_healthy_sensors_finds_nothing():
    assert not [name for name, row in parity_of(spoilt({})).items() if row.significant]


# -- detection ---------------------------------------------------------------------------------------------------------------------


# -- where -------------------------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def part() -> Windows:
    return cut_run(own((), 4, 240.0), merlin(), "fossen", 10.0)


def test_a_gap_planted_in_a_regime_is_found_with_its_share(part):
    """Nine tenths of the surge gap where u is in its strong forward range, the rest spread evenly elsewhere."""
    channel, rng = axis_channels(part)["surge"], RNG(12)
    u = part.y[..., channel]
    strong = u > float(f"{np.quantile(np.abs(u), 0.8):.2g}")
    error = np.zeros_like(part.y)
    error[..., channel] = rng.choice([-1.0, 1.0], u.shape) * np.where(strong, np.sqrt(0.9 / strong.sum()), np.sqrt(0.1 / (~strong).sum()))
    best = worst(slices(part, error, part.ok, 0), {"surge": 1.0})[0]
    assert best.axis == "surge"
    assert best.regime.startswith("u > ")
    assert best.share == pytest.approx(0.9, abs=0.05)
    assert best.low > 1.5
    assert best.low <= best.lift <= best.high


def test_an_even_gap_has_no_worst_place(part):
    error = RNG(13).normal(size=part.y.shape)
    assert not worst(slices(part, error, part.ok, 0), dict.fromkeys(axis_channels(part), 1 / 6))


def test_idle_thrusters_and_all_regimes_have_names(part):
    assert commands(merlin(), 4, 240.0).shape == (2400, 7)
    names = {s.regime for s in slices(part, RNG(15).normal(size=part.y.shape), part.ok, 0)}
    assert {"HFP turning forward", "HFP turning backward", "first third of the run"} <= names
    assert any(n.startswith("heading") for n in names)
