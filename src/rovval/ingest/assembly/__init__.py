"""Signals as a source logs them -> a `RawLog`: SI, forward-starboard-down, north-east-down, each channel at its own stamps."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rovval.core.channels import Rule
from rovval.core.counts import counted
from rovval.core.data import Array, Flags, Marker, RawLog, Series
from rovval.core.errors import BadInput, Finding, merged
from rovval.core.frames import ENU_TO_NED, FLU_TO_FSD, euler_from_quaternion, rotation_from_euler, wrap
from rovval.core.units import to_si
from rovval.ingest.assembly.heading import with_heading_zero
from rovval.ingest.assembly.thruster_speeds import signed_by_command, without_spikes
from rovval.ingest.profile import ATTITUDE, GEODETIC, WORLD_VELOCITY, Profile, Source

SIDEWAYS_OR_DOWN = ("v", "w", "q", "r", "vdot", "wdot")  # change sign between forward-left-up and forward-starboard-down
TO_NED = {"ned": np.eye(3), "enu": ENU_TO_NED, "nwu": FLU_TO_FSD}
EULER = ("phi", "theta", "psi")
UNIT_WITHIN = 0.1  # of the length of a quaternion: rounding of an export leaves less; what is further off is no rotation
SPIKE_RAD = 1.5  # rad
WGS84_A, WGS84_E2 = 6378137.0, 6.69437999014e-3  # semi-major axis (m) and first eccentricity squared, NIMA TR8350.2, table 3.1


@dataclass(frozen=True, slots=True)
class Signal:
    """One signal as logged: ``t`` (n,) s strictly increasing, ``values`` (n,) or (n, 4) in the source's unit, NaN where missing."""

    t: Array
    values: Array
    stamp: str
    source: Source


def build(
    profile: Profile,
    signals: Iterable[tuple[str, Signal]],
    path: Path,
    sha256: str,
    t0_ns: int | None,
    findings: Sequence[Finding],
    properties: Mapping[str, str],
    markers: Sequence[Marker] = (),
) -> RawLog:
    """The log out of its signals, (channel name, signal) one after the other: who makes them on the way holds each once. Raises `BadInput` when
    no signal holds a value."""
    found = list(findings)
    if profile.draft:
        detail = "its units, frames and channels are guesses that nobody has reviewed: confirm them and delete the line `draft`"
        found.insert(0, Finding("draft_profile", profile.name, detail))
    facts = {"profile_sha256": profile.sha256, **({"water": profile.water} if profile.water else {}), **properties}
    series: dict[str, Series] = {}
    sources: dict[str, Source] = {}
    for name, signal in signals:
        sources[name] = signal.source
        present: Flags = np.asarray(np.isfinite(signal.values.reshape(len(signal.t), -1)).all(axis=1))
        if signal.source.missing:
            present = present & ~np.isin(signal.values, signal.source.missing)
        if not present.any():
            found.append(Finding("empty_channel", name, "holds no value"))
        elif name == ATTITUDE:
            series |= _attitude(profile, signal, present, found)
        else:
            t, values = (signal.t, signal.values) if present.all() else (signal.t[present], signal.values[present])
            series[name] = Series(t, _si(values, signal.source), signal.stamp)
    series, said = signed_by_command(profile, series)
    series, spikes = without_spikes(series)
    found += [*said, *spikes]
    series = _geodetic(profile, series, facts, found)
    series = _turned(profile, series)
    series = _into_body(profile, series, found)
    if profile.relative_heading and "psi" in series:
        series, told = with_heading_zero(series)
        found.append(told)
    if not series:
        raise BadInput(f"{path}: every channel of profile {profile.name!r} is empty", "see `rovval show profile`")
    ordered = {name: _angles(name, series[name], found) for name in _in_order(profile, series)}
    return RawLog(
        source=str(path), sha256=sha256, profile=profile.name, vehicle=profile.vehicle_file, t0_ns=t0_ns, channels=ordered,
        findings=tuple(merged(found)), properties=facts, rules={n: r for n in ordered if (r := _rule(sources, n)) is not None},
        markers=tuple(markers),
    )  # fmt: skip


def _in_order(profile: Profile, series: Mapping[str, Series]) -> list[str]:
    """Channels in the order of the profile, members of a pattern in the order of the log."""
    families = [k.partition(":")[0] for k in profile.channels]
    families = [*(n for f in families for n in (EULER if f == ATTITUDE else (f,))), "x", "y"]  # east alone is y, under whatever name
    return sorted(series, key=lambda n: families.index(n.partition(":")[0]))


def _si(raw: Array, source: Source) -> Array:
    factor = source.sign / source.span * to_si(source.unit)
    if factor == 1.0 and not source.zero:
        return raw
    values = np.asarray((raw - source.zero if source.zero else raw) * factor)
    values.setflags(write=False)  # nobody else holds it: no copy is made of it
    return values


def _attitude(profile: Profile, signal: Signal, present: Flags, found: list[Finding]) -> dict[str, Series]:
    """Euler angles of the quaternion in the pair of axes that belongs to its world: fsd in ned, flu in enu and nwu."""
    q = signal.values[present]
    if (profile.frame_of(ATTITUDE) == "fsd") != (profile.world_of(ATTITUDE) == "ned"):
        w, x, y, z = q.T
        q = np.stack([-x, w, z, -y], axis=1)  # half a turn about the bow first: fsd <-> flu
    norm = np.linalg.norm(np.clip(q, -2.0, 2.0), axis=1)  # longer than one all the same, and the square of no number is too large
    unit = np.abs(norm - 1.0) < UNIT_WITHIN
    if not unit.all():
        found.append(Finding("not_a_rotation", ATTITUDE, f"{counted((~unit).sum(), 'quaternion')} not of length 1 to within {UNIT_WITHIN:g}; dropped"))
    euler = euler_from_quaternion(q[unit] / norm[unit, None])
    return {n: Series(signal.t[present][unit], euler[:, i], signal.stamp) for i, n in enumerate(EULER)}


def _geodetic(profile: Profile, series: dict[str, Series], facts: dict[str, str], found: list[Finding]) -> dict[str, Series]:
    """Latitude and longitude into metres north and east of the first sample, by the radii of curvature of WGS-84 there.

    Radii: Groves, Principles of GNSS, Inertial and Multisensor Navigation, 2nd ed., equations 2.105 and 2.106.
    """
    if "x" not in series or "y" not in series or profile.channels["x"].unit != GEODETIC:
        return {n: s for n, s in series.items() if n not in ("x", "y") or profile.channels["x"].unit != GEODETIC}
    lat, lon = (_on_earth(series[n], most, found) for n, most in (("x", 90.0), ("y", 360.0)))
    if not len(lat.t) or not len(lon.t):
        return {n: s for n, s in series.items() if n not in ("x", "y")}
    lat0, lon0 = float(lat.values[0]), float(lon.values[0])
    s2 = 1.0 - WGS84_E2 * np.sin(np.radians(lat0)) ** 2
    north, east = WGS84_A * (1.0 - WGS84_E2) / s2**1.5, WGS84_A / np.sqrt(s2) * np.cos(np.radians(lat0))
    facts |= {"origin_latitude_deg": repr(lat0), "origin_longitude_deg": repr(lon0)}
    dlon = (lon.values - lon0 + 180.0) % 360.0 - 180.0
    x = Series(lat.t, np.radians(lat.values - lat0) * north, lat.stamp)
    return series | {"x": x, "y": Series(lon.t, np.radians(dlon) * east, lon.stamp)}


def _on_earth(series: Series, most_deg: float, found: list[Finding]) -> Series:
    """The samples of a latitude or longitude that are one; how many are none is a finding."""
    on = np.abs(series.values) <= most_deg
    if on.all():
        return series
    found.append(Finding("out_of_range", "x, y", f"{counted((~on).sum(), 'sample')} beyond {most_deg:g} degrees, where there is no place on Earth; dropped"))
    return Series(series.t[on], series.values[on], series.stamp)


def _turned(profile: Profile, series: dict[str, Series]) -> dict[str, Series]:
    """Body components and world pose into forward-starboard-down and north-east-down (REP-103 to SNAME), each from the axes that it was logged in."""
    out = dict(series)
    for name in (*SIDEWAYS_OR_DOWN, "theta"):
        if name in out and _body_of(profile, name) == "flu":
            out[name] = _scaled(out[name], -1.0)
    if "z" in out and profile.world_of("z") != "ned":
        out["z"] = _scaled(out["z"], -1.0)
    if "psi" in out and (world := profile.world_of(ATTITUDE if "psi" not in profile.channels else "psi")) != "ned":
        out["psi"] = Series(out["psi"].t, -out["psi"].values + (np.pi / 2 if world == "enu" else 0.0), out["psi"].stamp)
    return out if "x" in profile.channels and profile.channels["x"].unit == GEODETIC else _north_and_east(profile, out)


def _body_of(profile: Profile, name: str) -> str:
    """Body axes of a channel; the pitch of a quaternion is in those that belong to its world."""
    if name == "theta" and ATTITUDE in profile.channels:
        return "fsd" if profile.world_of(ATTITUDE) == "ned" else "flu"
    return profile.frame_of(name)


def _north_and_east(profile: Profile, series: dict[str, Series]) -> dict[str, Series]:
    world = profile.world_of("x" if "x" in profile.channels else "y")
    if world == "ned":
        return series
    north, east = ("y", "x") if world == "enu" else ("x", "y")
    turned = {"x": series.get(north), "y": _scaled(series[east], -1.0 if world == "nwu" else 1.0) if east in series else None}
    return {n: s for n, s in series.items() if n not in turned} | {n: s for n, s in turned.items() if s is not None}


def _into_body(profile: Profile, series: dict[str, Series], found: list[Finding]) -> dict[str, Series]:
    """Velocity logged along world axes into the body, with the attitude interpolated at its stamps."""
    if not any(n in profile.channels and profile.channels[n].frame == "world" for n in WORLD_VELOCITY):
        return series
    rest = {n: s for n, s in series.items() if n not in WORLD_VELOCITY}
    if len(rest) == len(series):
        return series
    if not all(n in series for n in (*WORLD_VELOCITY, *EULER)):
        found.append(Finding("no_velocity", "u, v, w", "velocity along world axes needs all three axes and the attitude"))
        return rest
    t = series["u"].t
    inside = np.isin(t, series["v"].t) & np.isin(t, series["w"].t)
    for name in EULER:
        inside &= (t >= series[name].t[0]) & (t <= series[name].t[-1])
    t = t[inside]
    if len(t) < 1:
        found.append(Finding("no_velocity", "u, v, w", "no attitude at the stamps of the velocity"))
        return rest
    ned = np.stack([s.values[np.isin(s.t, t)] for s in (series[n] for n in WORLD_VELOCITY)], axis=1) @ TO_NED[profile.world_of("u")].T
    euler = np.stack([np.interp(t, series[n].t, np.unwrap(series[n].values)) for n in EULER], axis=1)
    body = np.einsum("nji,nj->ni", rotation_from_euler(euler), ned)
    return rest | {n: Series(t, body[:, i], series[n].stamp) for i, n in enumerate(WORLD_VELOCITY)}


def _scaled(series: Series, factor: float) -> Series:
    return series if factor == 1.0 else Series(series.t, series.values * factor, series.stamp)


def _angles(name: str, series: Series, found: list[Finding]) -> Series:
    """Angles beyond half a turn brought into (-pi, pi]; the others keep every bit, and absurd ones stay to be masked.

    A single sample far from two neighbours that agree is what averaging two angles across the wrap leaves: it is dropped.
    """
    if name not in EULER:
        return series
    beyond = (np.abs(series.values) > np.pi) & (np.abs(series.values) <= 7.0)
    values = np.where(beyond, wrap(series.values), series.values)
    step, over = np.abs(wrap(np.diff(values))), np.abs(wrap(values[2:] - values[:-2]))
    spike = np.concatenate(([False], (step[:-1] > SPIKE_RAD) & (step[1:] > SPIKE_RAD) & (over < SPIKE_RAD / 3), [False]))
    spike = spike[: len(values)] & (np.abs(values) <= np.pi)
    if not spike.any():
        return Series(series.t, values, series.stamp) if beyond.any() else series
    detail = f"{spike.sum()} single samples far from both neighbours, from t = {series.t[spike][0]:.1f} s; dropped"
    found.append(Finding("angle_spike", name, detail))
    return Series(series.t[~spike], values[~spike], series.stamp)


def _rule(sources: Mapping[str, Source], name: str) -> Rule | None:
    s = sources.get(ATTITUDE if name in EULER and name not in sources else name)
    if s is None:
        return None
    rule = Rule(s.resampling, s.longest_gap_s, s.stuck_s)
    return rule if rule != Rule() else None
