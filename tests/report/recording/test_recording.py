"""The rerun recording, written and read back."""

import errno
import shutil
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from report_cases import diagnosis, make_run, make_sim

from rovval import vehicle
from rovval.comparison import compare
from rovval.core.channels import AXES
from rovval.core.data import Array, Comparison
from rovval.report.diagnosis.sentences.plain import holds
from rovval.report.recording import write as recording

MERLIN = vehicle.load("merlin")


def read(c: Comparison, path: Path, **more: Any) -> tuple[Mapping[str, Array], set[str], str, int]:
    """Scalars by entity (n, k), all entities, the notes, and the number of blueprints of a recording of ``c``."""
    from rerun.chunk import RrdReader

    recording.write(c, path, MERLIN, **more)
    reader, scalars, entities, notes = RrdReader(str(path)), {}, set(), ""
    for chunk in reader.stream():
        entities.add(chunk.entity_path)
        batch = chunk.to_record_batch()
        if "Scalars:scalars" in batch.schema.names:
            column = batch.column("Scalars:scalars")
            scalars[chunk.entity_path] = np.asarray(column.flatten()).reshape(len(column), -1)
        if "TextDocument:text" in batch.schema.names:
            notes = batch.column("TextDocument:text").flatten()[0].as_py()
    return scalars, entities, notes, len(reader.blueprints())


def test_what_was_compared_is_what_is_read_back(tmp_path: Path) -> None:
    run = make_run(300)
    sim = make_sim(run)
    scalars, entities, notes, blueprints = read(compare(run, sim), tmp_path / "run.rrd")
    real, windows, free = scalars["/velocity/surge"].T
    np.testing.assert_allclose(real, run.get("u"))
    np.testing.assert_allclose(windows, sim.windowed.nu[:, 0])
    np.testing.assert_allclose(free, sim.free.nu[:, 0])
    np.testing.assert_allclose(scalars["/velocity/yaw"][:, 0], np.degrees(run.get("r")))
    np.testing.assert_allclose(scalars["/error/sway"][:, 1], sim.free.nu[:, 1] - run.get("v"))
    np.testing.assert_allclose(scalars["/thruster/speed"], sim.thruster_speed * 60)
    np.testing.assert_allclose(scalars["/thruster/force"], sim.thrust)
    tracks = {"/world/track/measured", "/world/track/windows", "/world/track/free_run"}
    assert tracks | {"/world", "/world/measured", "/world/measured/thrust", "/world/free_run"} <= entities
    assert blueprints == 1 and "not measured" not in notes


def test_every_view_has_a_dark_ground_whatever_the_viewer_s_theme(tmp_path: Path) -> None:
    """In a light viewer the measured motion was white on white."""
    from rerun.chunk import RrdReader

    run, path = make_run(300), tmp_path / "run.rrd"
    recording.write(compare(run, make_sim(run)), path, MERLIN)
    [blueprint] = RrdReader(str(path)).blueprints()
    grounds = []
    for chunk in RrdReader(str(path)).stream(store=blueprint):
        batch = chunk.to_record_batch()
        grounds += [batch.column(name).flatten()[0].as_py() for name in batch.schema.names if name.endswith("ackground:color")]
    assert len(grounds) >= 14 and {g >> 8 for g in grounds} == {0x10151B}


def test_a_corrected_simulation_is_a_further_trace(tmp_path: Path) -> None:
    run = make_run(300)
    better = make_sim(run, gap=(0.0,) * 6)
    scalars, entities, _, _ = read(compare(run, make_sim(run)), tmp_path / "run.rrd", corrected=better)
    assert scalars["/velocity/surge"].shape == (300, 4) and "/world/track/corrected" in entities
    np.testing.assert_allclose(scalars["/velocity/surge"][:, 3], better.windowed.nu[:, 0])


def test_another_simulator_is_a_further_trace(tmp_path: Path) -> None:
    run = make_run(300)
    scalars, *_ = read(compare(run, make_sim(run), {"u": np.zeros(300)}, "unity"), tmp_path / "run.rrd")
    assert scalars["/velocity/surge"].shape == (300, 4) and scalars["/velocity/sway"].shape == (300, 3)


def test_what_was_not_measured_is_left_out_and_said(tmp_path: Path) -> None:
    run = make_run(300, absent=("x", "y", "p", "phi"), synthetic="a test")
    scalars, entities, notes, _ = read(compare(run, make_sim(run)), tmp_path / "run.rrd")
    assert "/world/measured" not in entities and "/world/track/measured" not in entities and "/world/free_run/thrust" in entities
    assert "/error/roll" not in scalars and scalars["/velocity/roll"].shape == (300, 2) and "/pose/roll_angle" not in scalars
    assert "x and y not measured" in notes and "Not measured in this log: roll" in notes and "SYNTHETIC DATA: a test" in notes


def test_attitude_that_was_not_measured_is_drawn_as_zero_and_said(tmp_path: Path) -> None:
    run = make_run(300, absent=("phi", "theta"))
    _, entities, notes, _ = read(compare(run, make_sim(run)), tmp_path / "run.rrd")
    assert "/world/measured" in entities and "roll angle and pitch angle; the vehicle is drawn with zero there" in notes


def test_holes_stops_and_a_log_without_epoch(tmp_path: Path) -> None:
    run = replace(make_run(300, holes={"u": slice(0, 50), "x": slice(100, 150)}), t0_ns=None)
    scalars, *_ = read(compare(run, make_sim(run, stop=120)), tmp_path / "run.rrd")
    assert np.isnan(scalars["/velocity/surge"][:50, 0]).all() and np.isnan(scalars["/velocity/surge"][120:, 2]).all()


def test_tracks_are_cut_where_they_are_missing_and_where_a_window_begins(tmp_path: Path) -> None:
    from rerun.chunk import RrdReader

    run = make_run(300, holes={"x": slice(120, 150)})
    recording.write(compare(run, make_sim(run)), tmp_path / "run.rrd", MERLIN)
    lengths: dict[str, list[int]] = {}
    for chunk in RrdReader(str(tmp_path / "run.rrd")).stream():
        batch = chunk.to_record_batch()
        if "LineStrips3D:strips" in batch.schema.names:
            lengths[chunk.entity_path] = [len(strip) for strip in batch.column("LineStrips3D:strips").flatten()]
    assert lengths["/world/track/measured"] == [120, 150]
    assert lengths["/world/track/windows"] == [100, 100, 100]
    assert lengths["/world/track/free_run"] == [300]


def test_a_recording_that_could_not_be_written_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """rerun writes in a thread of its own, whose failure is no OSError: it came out as an internal error."""
    import rerun as rr

    def stopped(self: object) -> None:
        raise RuntimeError("File-writer thread shut down prematurely")

    monkeypatch.setattr(rr.RecordingStream, "flush", stopped)
    run = make_run(50)
    for free, code in ((0, errno.ENOSPC), (1 << 40, errno.EIO)):
        monkeypatch.setattr(shutil, "disk_usage", lambda _folder, free=free: SimpleNamespace(free=free))
        with pytest.raises(OSError, match="writer stopped") as refused:
            recording.write(compare(run, make_sim(run)), tmp_path / "run.rrd", MERLIN)
        assert refused.value.errno == code


def test_the_recording_carries_the_diagnosis(tmp_path: Path) -> None:
    """Its words, lanes of what holds when, and per axis the force that is missing."""
    run = make_run(300, holes={"psi": slice(50, 60)})
    d = diagnosis()
    scalars, entities, notes, _ = read(compare(run, make_sim(run)), tmp_path / "run.rrd", diagnosis=d)
    assert "One effect explains part of the gap: Axial inflow loss" in notes
    lanes = {"/state/cause/inflow_loss", "/state/where/surge_u_0_6_m_s", "/state/where/yaw_r_8_deg_s", "/state/gap_level", "/state/log/psi"}
    assert {"/log", *(f"/force/{axis}" for axis in AXES)} | lanes <= entities
    assert scalars["/force/surge"].shape[1] == 1 and np.isfinite(scalars["/force/surge"]).any()


def test_a_lane_is_a_gap_where_nothing_holds(tmp_path: Path) -> None:
    from rerun.chunk import RrdReader

    run = make_run(300, holes={"psi": slice(50, 60)})
    recording.write(compare(run, make_sim(run)), tmp_path / "run.rrd", MERLIN, diagnosis=diagnosis())
    shown: dict[str, dict[str, bool]] = {}
    for chunk in RrdReader(str(tmp_path / "run.rrd")).stream():
        batch = chunk.to_record_batch()
        if "StateConfiguration:values" in batch.schema.names:
            values, visible = (batch.column(f"StateConfiguration:{name}").to_pylist()[0] for name in ("values", "visible"))
            shown[chunk.entity_path] = dict(zip(values, visible, strict=True))
    assert shown["/state/log/psi"] == {"-": False, "gap": True}
    assert all(any(lane.values()) for path, lane in shown.items() if path.startswith("/state/cause/"))


@pytest.mark.parametrize(
    ("name", "when"), [("u > 0.5 m/s", "u > 0.5"), ("|r| < 8 deg/s", "r < 8"), ("time 3 to 5 s", "t"), ("HFP turning forward", ""), ("depth > 12 m", "z")]
)
def test_when_a_regime_holds_is_read_off_the_log(name: str, when: str) -> None:
    run = make_run(100)
    known = {
        "u > 0.5": run.get("u") > 0.5, "r < 8": np.abs(np.degrees(run.get("r"))) < 8.0, "t": (run.t >= 3.0) & (run.t < 5.0), "z": run.get("z") > 12.0,
    }  # fmt: skip
    found = holds(run, name)
    assert (found is None) if not when else (found is not None and (found == known[when]).all())


def test_current_and_tether_are_arrows_on_the_vehicle(tmp_path: Path) -> None:
    from rerun.chunk import RrdReader

    run = make_run(300)
    mended = replace(make_sim(run), effects=("current_constant:north=0.2", "tether_tension:east=10"))
    _, entities, notes, _ = read(compare(run, make_sim(run)), tmp_path / "run.rrd", corrected=mended)
    assert {"/world/current", "/world/measured/force/tether_tension"} <= entities
    assert "Arrow of the current, as the simulation with effects has it: 0.2 m/s at most" in notes and "10 N at most" in notes
    vectors = [b.column("Arrows3D:vectors") for c in RrdReader(str(tmp_path / "run.rrd")).stream()
               if c.entity_path == "/world/current" and "Arrows3D:vectors" in (b := c.to_record_batch()).schema.names]  # fmt: skip
    drawn = np.array(vectors[0].to_pylist(), dtype=float).reshape(-1, 3)
    np.testing.assert_allclose(drawn / drawn[0, 0], np.tile([1.0, 0.0, 0.0], (300, 1)), atol=1e-6)
    _, plain, notes, _ = read(compare(run, make_sim(run)), tmp_path / "plain.rrd")
    assert not any("current" in e or "force/" in e for e in plain) and "Arrow" not in notes


def test_where_a_pose_is_missing_the_vehicle_is_a_speck_that_the_viewer_can_draw(tmp_path: Path) -> None:
    """A scale of nothing is no transform to the viewer, which warned of one at every step."""
    from rerun.chunk import RrdReader

    run = make_run(300, holes={"x": slice(100, 150)})
    recording.write(compare(run, make_sim(run)), tmp_path / "run.rrd", MERLIN)
    batches = [chunk.to_record_batch() for chunk in RrdReader(str(tmp_path / "run.rrd")).stream() if chunk.entity_path == "/world/measured"]
    scale = np.concatenate([np.array(b.column("Transform3D:scale").flatten().to_pylist()) for b in batches if "Transform3D:scale" in b.schema.names])
    assert scale.shape == (300, 3) and np.all(scale > 0.0)
    assert np.all(scale[100:150] < 0.01) and np.all(scale[:100] == 1.0)
