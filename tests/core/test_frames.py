"""The rotations: against scipy's, there and back, and between the axes of ROS and those of marine craft."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from rovval.core.frames import (
    ENU_TO_NED,
    FLU_TO_FSD,
    attitude_difference,
    euler_from_quaternion,
    euler_rates,
    quaternion_from_euler,
    rotation_from_euler,
    skew,
    smooth_quaternions,
    tilt_difference,
    wrap,
)

TURN = st.floats(-3.1, 3.1)
EULER = st.tuples(TURN, st.floats(-1.5, 1.5), TURN)


@settings(max_examples=60, deadline=None)
@given(EULER)
def test_a_rotation_is_scipy_s(euler):
    np.testing.assert_allclose(rotation_from_euler(np.array(euler)), Rotation.from_euler("ZYX", euler[::-1]).as_matrix(), atol=1e-12)


@settings(max_examples=60, deadline=None)
@given(EULER)
def test_euler_angles_survive_the_quaternion(euler):
    back = euler_from_quaternion(quaternion_from_euler(np.array(euler)))
    assert np.abs(wrap(back - np.array(euler))).max() < 1e-9


@settings(max_examples=60, deadline=None)
@given(EULER, st.tuples(TURN, TURN, TURN))
def test_rates_of_the_angles_turn_the_matrix_as_body_rates_do(euler, omega):
    """dR/dt = R S(omega) (Fossen 2021, equation 2.28), by a central difference along the rates."""
    at, body, h = np.array(euler), np.array(omega), 1e-6
    rate = euler_rates(at, body)
    slope = (rotation_from_euler(at + h * rate) - rotation_from_euler(at - h * rate)) / (2 * h)
    assert np.abs(slope - rotation_from_euler(at) @ skew(body)).max() < 1e-4 * (1.0 + np.abs(rate).max())


def test_skew_is_the_cross_product():
    a, b = np.random.default_rng(0).normal(size=(2, 5, 3))
    np.testing.assert_allclose(np.einsum("nij,nj->ni", skew(a), b), np.cross(a, b))


def test_a_vehicle_of_ros_that_looks_east_and_climbs_looks_east_and_climbs_in_ours():
    """REP-103: yaw counts from east to the left, z up; Fossen: from north to the right, z down."""
    east_and_up = ENU_TO_NED @ np.array([2.0, 0.0, 1.0])
    assert east_and_up.tolist() == [0.0, 2.0, -1.0]
    ours = ENU_TO_NED @ np.eye(3) @ FLU_TO_FSD
    np.testing.assert_allclose(ours, rotation_from_euler(np.array([0.0, 0.0, np.pi / 2])), atol=1e-12)
    for flip in (ENU_TO_NED, FLU_TO_FSD):
        np.testing.assert_array_equal(flip @ flip, np.eye(3))


@settings(max_examples=60, deadline=None)
@given(st.floats(-1e3, 1e3))
def test_a_wrapped_angle_is_the_same_direction_within_half_a_turn(angle):
    wrapped = float(wrap(angle))
    assert -np.pi < wrapped <= np.pi
    assert abs(np.exp(1j * wrapped) - np.exp(1j * angle)) < 1e-9
    assert float(wrap(-np.pi)) == np.pi


ANY = st.tuples(TURN, st.floats(-np.pi / 2, np.pi / 2), TURN)


@settings(max_examples=60, deadline=None)
@given(ANY, ANY)
def test_a_difference_of_attitudes_is_scipy_s_rotation_vector(a, b):
    of, to = (Rotation.from_euler("ZYX", x[::-1]) for x in (b, a))
    got = attitude_difference(np.array(a), np.array(b))
    assert ((of * Rotation.from_rotvec(got)).inv() * to).magnitude() < 1e-7
    assert np.linalg.norm(got) <= np.pi + 1e-9


@settings(max_examples=60, deadline=None)
@given(ANY, ANY)
def test_a_difference_of_tilts_brings_one_vertical_to_the_other_by_the_shortest_way(a, b):
    of, to = (Rotation.from_euler("ZYX", x[::-1]) for x in (b, a))
    turn = tilt_difference(np.array(a), np.array(b))
    down = np.array([0.0, 0.0, 1.0])
    angle = np.arccos(np.clip(of.inv().apply(down) @ to.inv().apply(down), -1.0, 1.0))
    if angle < 3.0:  # of opposite verticals every way is the shortest
        np.testing.assert_allclose((of * Rotation.from_rotvec(turn)).inv().apply(down), to.inv().apply(down), atol=1e-7)
    assert np.linalg.norm(turn) <= angle + 1e-6


def test_differences_of_nearly_level_attitudes_are_those_of_their_angles():
    b = np.array([0.02, -0.03, 2.0])
    d = np.array([1e-3, -2e-3, 3e-3])
    np.testing.assert_allclose(attitude_difference(b + d, b), d, atol=2e-4)
    np.testing.assert_allclose(tilt_difference(b + d, b), d * [1, 1, 0], atol=2e-4)


def test_quaternions_of_a_tumbling_series_have_no_jump():
    t = np.linspace(0.0, 4.0 * np.pi, 400)
    turns = Rotation.from_rotvec(np.outer(t, [0.3, 1.0, -0.2]))
    euler = turns.as_euler("ZYX")[:, ::-1]
    assert np.abs(np.diff(euler[:, 0])).max() > 1.0
    q = smooth_quaternions(euler)
    assert np.abs(np.diff(q, axis=0)).max() < 0.03
    assert (Rotation.from_quat(q, scalar_first=True).inv() * turns).magnitude().max() < 1e-7
