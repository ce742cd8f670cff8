"""Every vehicle of the library is one that can float, dissipate and steer, and says where its numbers come from."""

from __future__ import annotations

import pytest

from rovval import vehicle
from rovval.core.errors import UsageProblem
from rovval.vehicle.audit import audit, uncontrolled_axes, unsourced


@pytest.mark.parametrize("name", vehicle.names())
def test_a_vehicle_of_the_library_is_sound_and_sourced(name):
    loaded = vehicle.load(name)
    assert loaded.name == name
    assert audit(loaded) == ()
    assert unsourced(loaded) == (), "each group of numbers names its source"
    assert set(uncontrolled_axes(loaded)) <= {"roll", "pitch"}


def test_the_hash_follows_the_numbers_and_not_the_words(tmp_path):
    """Results are kept by it: an edited comment makes none of them anew, an edited number all of them."""
    text = (vehicle.LIBRARY / "merlin.toml").read_text()
    path = tmp_path / "merlin.toml"
    path.write_text("# read in the office\n" + text)
    assert vehicle.load(path).hash == vehicle.load("merlin").hash
    path.write_text(text.replace("mass = 2936.0", "mass = 2930.0"))
    assert vehicle.load(path).hash != vehicle.load("merlin").hash


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


@pytest.mark.parametrize("number", ["inf", "-inf", "nan"])
def test_a_number_that_is_not_finite_is_refused(tmp_path, number):
    """It was a traceback of linear algebra."""
    text = (vehicle.LIBRARY / "merlin.toml").read_text()
    (tmp_path / "v.toml").write_text(text.replace("mass = 2936.0", f"mass = {number}"))
    with pytest.raises(UsageProblem, match=r"body\.mass"):
        vehicle.load(tmp_path / "v.toml")
