"""Body and world axes in every pair: one flight written in each, by SciPy's rotations, reads as one."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rovval.core.errors import UsageProblem
from rovval.ingest import reader
from rovval.ingest.profile import parse_profile

N = 50
T = np.arange(N) * 0.1
EULER = np.stack([0.2 * np.sin(T), 0.1 + 0.1 * np.cos(T), 0.3 * T - 1.0], axis=1)  # roll, pitch, heading: fsd in ned
NED = np.stack([3.0 + T, -2.0 + 0.5 * T, 10.0 - 0.2 * T], axis=1)
FSD = np.stack([0.5 + 0.1 * T, 0.1 * T, -0.05 * T], axis=1)
RATES = np.stack([0.01 * T, -0.02 * T, 0.03 * T], axis=1)
BODY = {"fsd": np.eye(3), "flu": np.diag([1.0, -1.0, -1.0])}
WORLD = {"ned": np.eye(3), "enu": np.array([[0.0, 1, 0], [1, 0, 0], [0, 0, -1]]), "nwu": np.diag([1.0, -1.0, -1.0])}
PAIRS = list(itertools.product(BODY, WORLD))


def read(tmp_path, columns, channels, **more):
    path = tmp_path / "log.csv"
    rows = np.stack([T, *columns.values()], axis=1)
    path.write_text("\n".join([",".join(["t", *columns]), *(",".join(map(repr, row.tolist())) for row in rows)]) + "\n")
    table = {"name": "p", "description": "", "format": "csv_log", "time": {"kind": "elapsed", "columns": ["t"]}, "channels": channels}
    return reader("csv_log").read(path, parse_profile(table | more, "p")).channels


def flight(body, world):
    """Position, body velocity, rates and quaternion w x y z (body into world) of the flight in these axes."""
    turn = Rotation.from_matrix(WORLD[world]) * Rotation.from_euler("ZYX", EULER[:, ::-1]) * Rotation.from_matrix(BODY[body])
    q = np.roll(turn.as_quat(), 1, axis=1)
    blocks = {"x y z": NED @ WORLD[world].T, "u v w": FSD @ BODY[body].T, "p q r": RATES @ BODY[body].T, "qw qx qy qz": q}
    return {n: block[:, i] for names, block in blocks.items() for i, n in enumerate(names.split())}, turn


def channels(**more):
    units = dict.fromkeys("xyz", "m") | dict.fromkeys("uvw", "m/s") | dict.fromkeys("pqr", "rad/s")
    return {n: {"column": n, "unit": unit} for n, unit in units.items()} | more


def is_the_flight(c):
    for names, truth in (("x y z", NED), ("u v w", FSD), ("p q r", RATES), ("phi theta psi", EULER)):
        for i, n in enumerate(names.split()):
            assert np.allclose(c[n].values, truth[:, i], atol=1e-12), n


@pytest.mark.parametrize(("body", "world"), PAIRS)
def test_a_quaternion_from_any_body_into_any_world(body, world, tmp_path):
    columns, _ = flight(body, world)
    q = {"columns": ["qw", "qx", "qy", "qz"], "unit": "quaternion", "frame": body, "world": world}
    is_the_flight(read(tmp_path, columns, channels(attitude=q), frame=body, world=world))


@pytest.mark.parametrize(("body", "world"), PAIRS)
def test_velocities_along_any_world(body, world, tmp_path):
    columns, turn = flight(body, world)
    along = turn.apply(FSD @ BODY[body].T)
    columns |= {n: along[:, i] for i, n in enumerate("uvw")}
    q = {"columns": ["qw", "qx", "qy", "qz"], "unit": "quaternion", "frame": body, "world": world}
    velocity = {n: {"column": n, "unit": "m/s", "frame": "world"} for n in "uvw"}
    is_the_flight(read(tmp_path, columns, channels(attitude=q, **velocity), frame=body, world=world))


def angles(heading):
    degrees = {"roll": EULER[:, 0], "pitch": EULER[:, 1], "heading": heading}
    return {n: np.degrees(v) for n, v in degrees.items()}


def test_a_starboard_down_body_in_an_east_north_up_world(tmp_path):
    """Positions of a survey, compass and motion sensor of the vehicle: what people mean by it."""
    columns, _ = flight("fsd", "enu")
    euler = {"phi": {"column": "roll", "unit": "deg"}, "theta": {"column": "pitch", "unit": "deg"}}
    compass = {"psi": {"column": "heading", "unit": "deg", "world": "ned"}}
    is_the_flight(read(tmp_path, columns | angles(EULER[:, 2]), channels(**euler, **compass), frame="fsd", world="enu"))
    from_east = {"psi": {"column": "heading", "unit": "deg", "world": "enu"}}
    is_the_flight(read(tmp_path, columns | angles(np.pi / 2 - EULER[:, 2]), channels(**euler, **from_east), frame="fsd", world="enu"))


def test_depth_in_a_world_that_points_up(tmp_path):
    columns, _ = flight("flu", "enu")
    depth = {"z": {"column": "depth", "unit": "m", "world": "ned"}}
    c = read(tmp_path, columns | {"depth": NED[:, 2]}, channels(**depth), frame="flu", world="enu")
    assert np.allclose(c["z"].values, NED[:, 2]) and np.allclose(c["x"].values, NED[:, 0]) and np.allclose(c["w"].values, FSD[:, 2])


def test_where_body_and_world_do_not_belong_together_the_heading_says_its_own(tmp_path):
    columns, _ = flight("fsd", "enu")
    q = {"columns": ["qw", "qx", "qy", "qz"], "unit": "quaternion"}
    for more, word in (({"psi": {"column": "heading", "unit": "deg"}}, "clockwise from north"), ({"attitude": q}, "the quaternion turns")):
        with pytest.raises(UsageProblem, match=word):
            read(tmp_path, columns | angles(EULER[:, 2]), channels(**more), frame="fsd", world="enu")


def test_axes_of_a_channel_that_has_none_are_refused(tmp_path):
    wrong = channels(x={"column": "x", "unit": "m", "world": "enu"}, r={"column": "r", "unit": "rad/s", "world": "ned"})
    with pytest.raises(UsageProblem) as refused:
        read(tmp_path, flight("fsd", "ned")[0], wrong, frame="fsd", world="ned")
    assert "'r': has no world axes" in str(refused.value) and "x, y: in different world axes" in str(refused.value)


def test_one_horizontal_position_of_an_east_north_up_world(tmp_path):
    """East alone is y; it ended in an internal error."""
    only = {"x": {"column": "x", "unit": "m"}}
    c = read(tmp_path, flight("flu", "enu")[0], only, frame="flu", world="enu")
    assert list(c) == ["y"] and np.allclose(c["y"].values, NED[:, 1])
