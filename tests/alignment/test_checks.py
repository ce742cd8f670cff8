"""Checks: each kind of fault gives its finding, and a sound log gives none."""

from __future__ import annotations

import numpy as np
import pytest

from rovval.alignment.checks import check
from rovval.core.channels import Rule
from rovval.core.data import RawLog, Series
from rovval.core.frames import euler_rates, rotation_from_euler, wrap


def log(**channels):
    named = {k.replace("__", ":"): v for k, v in channels.items()}
    return RawLog("x.csv", "ab" * 32, "test", "", None, {n: Series(t, v, "row") for n, (t, v) in named.items()})


def moving(n=1200, **spoil):
    """A consistent motion: attitude integrates p q r, position integrates u v w."""
    t = np.arange(n) * 0.05
    euler = np.stack([0.2 * np.sin(0.7 * t), 0.15 * np.sin(0.5 * t + 1), 0.3 * t + 0.4 * np.sin(0.3 * t)], axis=1)
    rate = np.gradient(euler, t, axis=0)
    phi, theta = euler[:, 0], euler[:, 1]
    p = rate[:, 0] - np.sin(theta) * rate[:, 2]
    q = np.cos(phi) * rate[:, 1] + np.sin(phi) * np.cos(theta) * rate[:, 2]
    r = -np.sin(phi) * rate[:, 1] + np.cos(phi) * np.cos(theta) * rate[:, 2]
    assert np.allclose(euler_rates(euler, np.stack([p, q, r], axis=1)), rate)
    body = np.stack([0.5 + 0.3 * np.sin(0.4 * t), 0.2 * np.sin(0.6 * t), 0.1 * np.sin(0.9 * t)], axis=1)
    world = np.einsum("nij,nj->ni", rotation_from_euler(euler), body)
    way = np.concatenate((np.zeros((1, 3)), np.cumsum(0.5 * (world[1:] + world[:-1]) * 0.05, axis=0)))
    columns = dict(zip("xyz", way.T, strict=True)) | dict(zip("uvw", body.T, strict=True)) | {"p": p, "q": q, "r": r}
    columns |= {"phi": wrap(euler[:, 0]), "theta": wrap(euler[:, 1]), "psi": wrap(euler[:, 2])}
    return log(**{k: (t, spoil[k](v) if k in spoil else v) for k, v in columns.items()})


def test_a_sound_log_has_no_findings():
    assert check(moving()) == ()


@pytest.mark.parametrize(("channel", "partner"), [("w", "z"), ("z", "z"), ("r", "psi"), ("p", "phi"), ("q", "theta")])
def test_a_wrong_sign_is_named(channel, partner):
    found = [f for f in check(moving(**{channel: np.negative})) if f.code == "sign"]
    assert any(partner in f.where for f in found)


def test_a_wrong_unit_is_named():
    found = [f for f in check(moving(r=np.degrees)) if f.code == "scale"]
    assert any("psi" in f.where for f in found)


def test_gaps_are_counted_and_the_longest_told():
    t = np.concatenate([np.arange(0, 10, 0.1), np.arange(12, 20, 0.1), np.arange(25, 30, 0.1)])
    (finding,) = check(log(u=(t, np.sin(t))))
    assert finding.code == "gap" and "2 gaps longer than 0.5 s" in finding.detail and "5.10 s from t = 19.9 s" in finding.detail


def test_a_rate_that_changes_is_told():
    t = np.concatenate([np.arange(0, 30, 0.1), np.arange(30, 60, 0.05)])
    (finding,) = check(log(u=(t, np.sin(t))))
    assert finding.code == "rate_change" and "from 10 to 20 Hz" in finding.detail


def test_constant_and_stuck_are_two_things():
    t = np.arange(0, 60, 0.1)
    stuck = np.sin(t)
    stuck[200:260] = stuck[200]
    codes = {f.where: f.code for f in check(log(u=(t, stuck), v=(t, np.full(len(t), 0.3)), n__A=(t, np.zeros(len(t)))))}
    assert codes == {"u": "stuck", "v": "constant"}


def test_a_slow_or_coarse_sensor_is_not_stuck():
    """Depth in steps of 10 cm stands still for seconds on end by its resolution."""
    t = np.arange(0, 120, 0.1)
    assert check(log(z=(t, np.round(10 + np.sin(0.05 * t), 1)))) == ()


def test_what_is_true_of_many_channels_is_one_finding():
    t = np.concatenate([np.arange(0, 10, 0.1), np.arange(12, 20, 0.1)])
    (finding,) = check(log(u=(t, np.sin(t)), v=(t, np.cos(t))))
    assert finding.where == "u, v"


@pytest.mark.parametrize(("factor", "code", "says"), [(1 / 60, "scale", "0.017 times"), (-1, "sign", "against its set-point"), (0.8, None, "")])
def test_a_thruster_far_from_its_set_point_has_a_wrong_unit_or_sign(factor, code, says):
    """A governor that droops by a fifth does not."""
    t = np.arange(0, 60, 0.1)
    wanted = 5.0 * np.sin(0.2 * t)
    found = check(log(n_cmd__HFP=(t, wanted), n__HFP=(t, factor * wanted)))
    assert [f.code for f in found] == [code] * bool(code)
    assert all(says in f.detail and f.where == "n:HFP, n_cmd:HFP" for f in found)


def test_a_slow_channel_says_what_is_interpolated_over():
    t = np.arange(0, 100, 1.0)
    (finding,) = check(log(u=(t, np.sin(0.1 * t))))
    assert finding.code == "slow_channel" and "every 1 s" in finding.detail and "1.5 s are interpolated over instead of 0.5 s" in finding.detail


def test_commands_that_begin_late_and_end_early_are_told():
    t, late = np.arange(600) * 0.05, np.arange(100) * 0.2 + 3.0
    sensors = {"r": (t, np.sin(t)), "psi": (t, np.cos(t))}
    [found] = [f for f in check(log(pwm__A=(late, 1500.0 + late), **sensors)) if f.code == "short"]
    assert found.where == "pwm:A"
    assert found.detail == "begins 3.0 s after the log and ends 7.2 s before it; missing there, so nothing is simulated"
    held = RawLog("x.csv", "ab" * 32, "test", "", None, with_pulses(late, sensors), rules={"pwm:A": Rule(longest_gap_s=2.0)})
    [found] = [f for f in check(held) if f.code == "short"]
    assert "its last value is held for 2.0 s, longest_gap_s of the profile" in found.detail
    assert not [f for f in check(log(pwm__A=(t, 1500.0 + t), **sensors)) if f.code == "short"]


def with_pulses(late, sensors):
    return {"pwm:A": Series(late, 1500.0 + late, "row")} | {n: Series(t, v, "row") for n, (t, v) in sensors.items()}


def turning(speed, command, family="n_cmd"):
    t = np.arange(0, 60, 0.1)
    wave = np.sin(0.3 * t)
    return log(**{"n__A": (t, speed(wave)), f"{family}__A": (t, command(wave))})


@pytest.mark.parametrize(("family", "command"), [("n_cmd", lambda w: 5 * w), ("pwm", lambda w: 1500 + 300 * w)])
def test_an_unsigned_speed_beside_a_signed_command_is_named(family, command):
    """Speeds of ESC telemetry without sign were used as they are."""
    codes = [f.code for f in check(turning(lambda w: 5 * np.abs(w), command, family))]
    assert "unsigned" in codes
    assert not [f for f in check(turning(lambda w: 5 * w, command, family)) if f.code == "unsigned"]


def test_a_thruster_that_only_goes_ahead_is_not_unsigned():
    assert not [f for f in check(turning(lambda w: 5 * np.abs(w), lambda w: 5 * np.abs(w))) if f.code == "unsigned"]


@pytest.mark.parametrize(("times", "said"), [(1 / 60, "rpm and rev/s"), (np.pi / 30, "rpm and rad/s"), (2.6, "")])
def test_the_ratio_of_two_units_is_named(times, said):
    (finding,) = (f for f in check(turning(lambda w: 5 * times * w, lambda w: 5 * w)) if f.code == "scale")
    assert (f"(the ratio of {said})" in finding.detail) == bool(said) and finding.detail.count("(") == bool(said)


def test_attitude_and_rates_in_radians_are_named_by_the_way_covered():
    """Both wrong alike agree with each other; the velocities then lead elsewhere than the positions."""
    spoiled = moving(**dict.fromkeys(("phi", "theta", "psi", "p", "q", "r"), np.radians))
    assert [f.where for f in check(spoiled) if f.code == "unit"] == ["phi, theta, psi"]
    assert not [f for f in check(moving()) if f.code == "unit"]


def test_a_heading_that_wraps_at_two_pi_degrees_is_in_radians():
    t = np.arange(0, 120, 0.1)
    heading = (0.2 * t) % (2 * np.pi)
    (finding,) = check(log(psi=(t, np.radians(heading))))
    assert finding.code == "unit" and "it is in radians" in finding.detail
    assert check(log(psi=(t, wrap(heading)))) == ()


@pytest.mark.parametrize(("channel", "times", "said"), [("w", 1852 / 3600, "z, w"), ("r", np.pi / 180, "psi, r")])
def test_units_of_a_log_without_roll_and_pitch(channel, times, said):
    """A vehicle that is level: depth and heading alone tell that w is in knots, or r in degrees a second."""
    t = np.arange(1200) * 0.1
    w, r = 0.3 * np.sin(0.5 * t), 0.2 * np.cos(0.3 * t)
    series = {"w": w, "r": r, "z": 5.0 - 0.6 * np.cos(0.5 * t), "psi": np.asarray(wrap(1.0 + 0.2 / 0.3 * np.sin(0.3 * t)))}
    assert check(log(**{n: (t, v) for n, v in series.items()})) == ()
    [found] = check(log(**{n: (t, v / times if n == channel else v) for n, v in series.items()}))
    assert (found.code, found.where) == ("scale", said) and "the ratio of" in found.detail and "not logged" in found.detail
