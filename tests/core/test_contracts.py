"""What every file of a plug-in folder keeps, whoever adds it: ingest profiles, vehicles, effects, metrics."""

from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from rovval import demo, effects, ingest, vehicle
from rovval.cli import complete
from rovval.cli.app import app
from rovval.comparison import metrics
from rovval.core.channels import channel
from rovval.core.errors import BadInput, UsageProblem
from rovval.ingest.profile import ATTITUDE, load_profile, profiles
from rovval.plant import Plant, parse_settings
from rovval.simulation import simulate
from rovval.vehicle.audit import audit, uncontrolled_axes, unsourced

LIBRARY = {  # the design's contract: these names stay
    *("added_mass linear_drag quadratic_drag cross_drag current_constant current_shear current_varying waves".split()),
    *("density_gradient ground_effect wall_suction tether_drag tether_tension tether_snag buoyancy_error cg_offset".split()),
    *("payload_change inertia_error thruster_degraded thruster_fault_onset thruster_deadband thruster_reversed".split()),
    *("reverse_asymmetry thrust_lag inflow_loss crossflow_loss hull_interaction thruster_interaction".split()),
    *("thruster_misaligned propeller_torque rpm_scale voltage_sag time_offset clock_drift dvl_scale".split()),
    *("dvl_misalignment dvl_lever_arm gyro_bias compass_deviation attitude_bias velocity_filter_lag".split()),
}
RUNNER = CliRunner()


@pytest.fixture(scope="module")
def stretch():
    """The first 20 s of the sample dive."""
    run = demo.sample()
    keep = slice(0, 200)
    return replace(
        run, values={n: v[keep] for n, v in run.values.items()}, reasons={n: r[keep] for n, r in run.reasons.items()}
    )


@pytest.fixture(scope="module")
def nominal(stretch):
    return simulate(stretch, vehicle.load("merlin"))


@pytest.mark.parametrize(
    ("kind", "names"), [("effect", effects.names), ("metric", metrics.names), ("profile", profiles), ("vehicle", vehicle.names)]
)
def test_listing_and_completion_know_the_same_names(kind, names):
    """Completion looks at file names alone; it must not drift from what the library loads."""
    assert tuple(complete.known(kind)) == names()
    assert RUNNER.invoke(app, ["list", kind]).output.split() == list(names())


def test_an_effect_shows_how_to_ask_for_each_of_its_hypotheses():
    shown = RUNNER.invoke(app, ["show", "effect", "time_offset"]).output
    assert "  [velocity] delay [s]" in shown
    assert "'time_offset:tau=VALUE', --effect 'time_offset[velocity]:delay=VALUE', --effect 'time_offset[attitude]:delay=VALUE'" in shown


@pytest.mark.parametrize(
    ("kind", "name"),
    [
        (k, n)
        for k, f in (("effect", effects.names), ("metric", metrics.names), ("profile", profiles), ("vehicle", vehicle.names))
        for n in f()
    ],
)
def test_each_can_be_shown_as_text_and_as_json(kind, name):
    for flag in ([], ["--json"]):
        shown = RUNNER.invoke(app, ["show", kind, name, *flag])
        assert shown.exit_code == 0, shown.exception
        assert name in shown.output


# vehicles


@pytest.mark.parametrize("name", vehicle.names())
def test_vehicle(name):
    loaded = vehicle.load(name)
    assert loaded.name == name
    assert audit(loaded) == ()
    assert unsourced(loaded) == (), "each group of numbers names its source"
    assert set(uncontrolled_axes(loaded)) <= {"roll", "pitch"}
    assert vehicle.load(name).hash == loaded.hash


def test_a_vehicle_with_a_bad_matrix_is_refused_with_every_problem(tmp_path):
    text = (vehicle.LIBRARY / "merlin.toml").read_text()
    text = text.replace("Izz = 2125.224693", "Izz = 99999.0").replace("linear_drag = [150.0", "linear_drag = [-150.0")
    path = tmp_path / "bad.toml"
    path.write_text(text)
    with pytest.raises(UsageProblem) as refused:
        vehicle.load(path)
    assert refused.value.exit_code == 2
    for word in ("triangle", "linear_drag is negative on surge", "bad.toml", "2 problems"):
        assert word in refused.value.message


# profiles


@pytest.mark.parametrize("name", profiles())
def test_profile(name):
    profile = load_profile(name)
    assert profile.name == name
    assert profile.description
    assert profile.format in ingest.readers()
    assert not profile.vehicle or vehicle.load(profile.vehicle)
    for mapped in profile.channels:
        assert mapped == ATTITUDE or channel(mapped)


# effects


def test_the_library_has_the_names_of_the_contract():
    assert set(effects.names()) >= LIBRARY


@pytest.mark.parametrize("name", effects.names())
def test_effect_is_documented(name):
    effect = effects.load(name)
    assert effect.title
    assert effect.equation
    assert effect.signature
    assert effect.parameters
    assert all(p.source and p.unit for p in effect.parameters)
    assert set(effect.confused_with) <= set(effects.names()), "confused_with names effects of the library"


@pytest.mark.parametrize("name", effects.names())
def test_effect_at_its_null_value_changes_nothing_to_the_last_bit(name, stretch, nominal):
    effect = effects.load(name)
    target = {"axis": f"[{(effect.axes or ('surge',))[0]}]", "thruster": "[HFP]", "": ""}[effect.per]
    settings = tuple(f"{name}{f'[{p.target}]' if p.target else target}:{p.name}={p.null!r}" for p in effect.parameters)
    same = simulate(stretch, vehicle.load("merlin"), effects=settings)
    assert np.array_equal(same.free.nu, nominal.free.nu, equal_nan=True)
    assert np.array_equal(same.windowed.eta, nominal.windowed.eta, equal_nan=True)


@pytest.mark.parametrize("name", effects.names())
def test_effect_beyond_its_bounds_is_refused(name):
    plant = Plant(vehicle.load("merlin"), "fossen")
    effect = effects.load(name)
    target = {"axis": f"[{(effect.axes or ('surge',))[0]}]", "thruster": "[HFP]", "": ""}[effect.per]
    with pytest.raises(UsageProblem):
        parse_settings(plant, [f"{name}{target}:{effect.parameters[0].name}=1e12"])


# metrics


@pytest.mark.parametrize("name", metrics.names())
def test_metric(name):
    metric = metrics.get(name)
    rng = np.random.default_rng(5)
    error, measured, ok = rng.normal(size=100), rng.normal(size=100), np.arange(100) % 3 > 0
    value = metric.compute(error, ok, 0.1, measured)
    assert np.isfinite(value)
    assert metric.unit_of("m/s")
    spoilt = np.where(ok, error, np.nan)
    assert metric.compute(spoilt, ok, 0.1, measured) == value, "what is masked does not count"
    if metric.scales:
        assert metric.compute(2 * error, ok, 0.1, measured) == pytest.approx(2 * value)
    with pytest.raises(BadInput):
        metric.compute(error, np.zeros(100, dtype=bool), 0.1, measured)
