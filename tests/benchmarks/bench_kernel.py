"""How fast the batch kernel is, in one run beside what it has to be measured against:  pytest -m benchmark -s tests/benchmarks

Rates are steps of one vehicle per second of one core (CPU time of the calling thread, best of several, so that other work on the
machine counts little), and on all cores by the wall clock. Rates are given with every step written out, which is bound by memory, and
with five steps a sample (`peers.md` gives its figures without output).
"""

from __future__ import annotations

import ctypes
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rovval import effects, vehicle
from rovval.plant import Inputs, Plant, Slot, parse_settings
from rovval.plant.arguments import ABSENT
from rovval.plant.codegen import cache as kernel
from rovval.plant.codegen import spec as specs
from rovval.plant.codegen import text
from rovval.plant.codegen.layout import layout
from rovval.plant.integration import blocked
from rovval.plant.lowering import lower, pack
from rovval.plant.reference import plant as oracle

HERE = Path(__file__).parent
FLAGS = "-O3 -march=native -ffp-contract=fast -fno-math-errno -fno-trapping-math -shared -fPIC".split()
LANES, STEPS = 2048, 500
SHARE_OF_C, TIMES_MUJOCO, SHARE_NOMINAL, SHARE_FULL = 0.75, 250.0, 0.60, 0.25  # issue 3, part 4
REFERENCE = 1769  # flop a nominal step: 792 additions and 975 multiplications, counted by a number type that counts (`peers.md`, part 2)
SOME = ["inflow_loss:loss=0.3", "waves:cosine=0.2", "thrust_lag:tau=0.2"]
FLOP = """double peak(long n){double a[96];for(int i=0;i<96;i++)a[i]=1e-9*i;for(long j=0;j<n;j++)
for(int i=0;i<96;i++)a[i]=a[i]*0.999999999+1e-12;double s=0;for(int i=0;i<96;i++)s+=a[i];return s;}"""

pytestmark = pytest.mark.benchmark


def inputs(plant: Plant, samples: int = 1000) -> Inputs:
    rng = np.random.default_rng(0)
    speed = np.repeat(rng.normal(size=(samples // 20, len(plant.vehicle.thruster))), 20, axis=0) * 1.2
    return Inputs(0.1, speed, False, turned=np.linspace(0.0, 6.0, len(speed)))


def best(call, repeats=7, clock=time.thread_time):
    times = []
    for _ in range(repeats):
        start = clock()
        call()
        times.append(clock() - start)
    return min(times)


def ours(plant: Plant, beta) -> tuple[str, float]:
    """Name of the kernel and steps/s of one core, the kernel alone."""
    kept: dict[str, Any] = {}

    def spy(spec, blocks, steps, arguments):
        kept.update(spec=spec, blocks=blocks, arguments=arguments)
        real(spec, blocks, steps, arguments)

    real, kernel.run = kernel.run, spy
    try:
        zero = np.zeros((LANES, 6))
        plant.simulate(inputs(plant), np.zeros(LANES, int), STEPS, zero, zero, np.tile(beta, (LANES, 1)))
    finally:
        kernel.run = real
    function = kernel.module(kept["spec"]).run
    return kept["spec"].name, LANES * STEPS * plant.substeps / best(lambda: function(0, kept["blocks"], *kept["arguments"]))


def built(source: Path, target: Path):
    if not shutil.which("gcc"):
        pytest.skip("no gcc: the C yardstick cannot be built")
    subprocess.run(["gcc", *FLAGS, "-o", str(target), str(source), "-lm"], check=True)
    return ctypes.CDLL(str(target))


def pointer(a):
    return a.ctypes.data_as(ctypes.c_void_p)


def c_rate(plant: Plant, folder: Path) -> float:
    """Steps/s of one core of the plain C kernel, after it has given the same motion."""
    library = built(HERE / "plant_soa.c", folder / "soa.so")
    lowered = lower(plant.nominal, plant.slots, plant.index, plant.null, np.tile(plant.null, (LANES, 1)))
    spec = specs.Spec(7, False, False, False)
    where = layout(spec)
    first = where.first
    columns = [*range(first["mass"], first["mass"] + 31), *range(first["restoring"], first["restoring"] + 4)]
    columns += [first[k] + i for k in ("added", "linear", "quadratic") for i in range(6)] + list(range(where.body_rows, where.rows))
    numbers = blocked(pack(lowered, spec, 0.1, 1)[:, columns])
    state = np.zeros((LANES, 13))
    state[:, 3] = 1
    states, start, log = blocked(state), np.zeros(LANES, dtype=np.int64), inputs(plant)
    out = np.empty((LANES, STEPS, 13))

    def call():
        s = states.copy()
        library.run(
            0, LANES // specs.W, pointer(numbers), pointer(s), pointer(start), pointer(log.speed),
            ctypes.c_double(0.1 / plant.substeps), STEPS, plant.substeps, pointer(out),
        )  # fmt: skip

    call()
    zero = np.zeros((LANES, 6))
    motion = plant.simulate(log, start, STEPS, zero, zero, np.tile(plant.null, (LANES, 1)))
    assert np.abs(motion.nu[:, 1:] - out[..., 7:]).max() < 1e-12
    return float(LANES * STEPS * plant.substeps / best(call))


def flops_per_step() -> int:
    """Additions and multiplications of one nominal step, counted in the kernel's own text (the quaternion's length and output left out)."""
    source = text.render(specs.Spec(7, False, False, False))
    stage = source[source.index(" half = ") : source.index("take_step(m, stopped[b]")]
    rest = source[source.index("for s in range(again, 3)") : source.index("for stage in range(4)")]
    end = source[source.index(" n0, ") : source.index(" inverse = ")]

    def count(part: str) -> int:
        return sum(len(re.findall(r"(?<=[\w)\]]) [-+*/]=? (?=[\w(])", re.sub(r"m\[[^]]*\]|tv\[[^]]*\]", "m", line))) for line in part.splitlines())

    return 4 * count(stage) + 2 * count(rest) + count(end)


def held(slot: Slot) -> bool:
    """Whether the log of `inputs`, which holds thruster speeds and the turns of the vehicle alone, has the channels that a parameter acts with."""
    return not {*effects.load(slot.effect).needs, slot.parameter.needs} & set(ABSENT)


def away(slot: Slot, share: float) -> float:
    """A parameter by a share of its typical size from where it changes nothing, to the side on which there is room."""
    p = slot.parameter
    return p.null + share * p.typical if p.null + share * p.typical <= p.high else p.null - share * p.typical


def instead_of_channels(plant: Plant, slot: Slot) -> list[int]:
    """What of the same hypothesis stands in the place of a channel that the log of `inputs` does not hold: without it the hypothesis is refused."""
    return [i for i, other in enumerate(plant.slots) if other.hypothesis == slot.hypothesis and other.parameter.instead_of]


def everything(plant: Plant):
    """A little of every effect whose channel the log holds, in every lane."""
    beta = plant.null.copy()
    for c, slot in enumerate(plant.slots):
        if held(slot):
            beta[c] = away(slot, 0.01)
    return beta


def flop_rate(folder: Path) -> float:
    """Multiply-adds that one core does, flop/s, measured now."""
    source = folder / "peak.c"
    source.write_text(FLOP, encoding="utf-8")
    library = built(source, folder / "peak.so")
    library.peak.restype = ctypes.c_double
    return float(96 * 2 * 4_000_000 / best(lambda: library.peak(ctypes.c_long(4_000_000))))


def mujoco_rate() -> float | None:
    """Steps/s of one core of MuJoCo: ellipsoid fluid, seven thrusters with exact lag, RK4, many vehicles (`rollout`)."""
    try:
        import mujoco
        from mujoco import rollout
    except ImportError:
        return None
    v = vehicle.load("merlin")
    sites = "".join(f'<site name="s{i}" pos="{t.position[0]} {t.position[1]} {t.position[2]}"/>' for i, t in enumerate(v.thruster))
    motors = "".join(
        f'<general site="s{i}" gear="{t.direction[0]} {t.direction[1]} {t.direction[2]} 0 0 0" dyntype="filterexact" dynprm="0.2" gainprm="100"/>'
        for i, t in enumerate(v.thruster)
    )
    xml = f"""<mujoco><option timestep="0.1" integrator="RK4" density="1025" viscosity="0.001" gravity="0 0 0"/><worldbody><body><freejoint/>
    <geom type="ellipsoid" size="1.25 0.75 0.75" mass="2936" fluidshape="ellipsoid"/>{sites}</body></worldbody><actuator>{motors}</actuator></mujoco>"""
    one = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(one)
    lanes, steps = 64, 200
    state = np.zeros((lanes, mujoco.mj_stateSize(one, mujoco.mjtState.mjSTATE_FULLPHYSICS)))
    mujoco.mj_getState(one, data, state[0], mujoco.mjtState.mjSTATE_FULLPHYSICS)
    state[1:] = state[0]
    control = np.random.default_rng(0).normal(size=(lanes, steps, 7))
    return float(lanes * steps / best(lambda: rollout.rollout(one, [data], state, control), 5))


def numpy_rate(plant: Plant) -> float:
    lanes, steps = 1000, 5
    zero = np.zeros((lanes, 6))
    null = np.tile(plant.null, (lanes, 1))
    return float(lanes * steps / best(lambda: oracle.simulate(plant, inputs(plant), np.zeros(lanes, int), steps, zero, zero, null), 2))


def test_the_kernel_beside_c_mujoco_numpy_and_the_limit(tmp_path):
    limit = flop_rate(tmp_path) / REFERENCE
    mujoco = mujoco_rate()
    print(f"\n{REFERENCE} flop a nominal step ({flops_per_step()} as the kernel is written), limit {limit:.3g} steps/s of one core")
    for substeps, written in ((1, "every step written"), (5, "five steps a sample")):
        plant = Plant(vehicle.load("merlin"), substeps=substeps)
        nominal = ours(plant, plant.null)[1]
        full = ours(plant, parse_settings(plant, SOME))[1]
        c = c_rate(plant, tmp_path)
        work = ours(plant, everything(plant))[1]
        rows: list[tuple[str, float | None]] = [("ours, nominal", nominal), ("every effect in, 3 act", full)]
        rows += [("every effect at work", work), ("plain C, nominal", c)]
        rows += [("MuJoCo rollout RK4", mujoco)]
        rows += [("NumPy oracle", numpy_rate(plant))] if substeps == 1 else []
        print(f"\n{written}")
        for name, rate in rows:
            if rate is not None:
                print(f"{name:22}{rate:10.3g}  {rate / limit:7.1%} of the limit, {rate / c:8.4f} of C, {rate / (mujoco or np.nan):8.2f} times MuJoCo")
        assert nominal / c > SHARE_OF_C
        assert full / c > 0.2, "the kernel with every effect is not vectorised"
    print(f"targets: nominal {SHARE_NOMINAL:.0%} of the limit or {SHARE_OF_C} of C, {TIMES_MUJOCO:.0f} times MuJoCo; full {SHARE_FULL:.0%} of the limit")


@pytest.mark.parametrize("lanes", [1, 100, 10_000])
def test_whole_calls(lanes):
    """Stretches of 10 s at 10 Hz, with lowering, sensors and everything, on all cores by the wall clock."""
    plant = Plant(vehicle.load("merlin"))
    log, zero = inputs(plant), np.zeros((lanes, 6))
    start = np.arange(lanes) % 800
    for name, beta in (("nominal", plant.null), ("inflow loss", parse_settings(plant, ["inflow_loss:loss=0.3"]))):
        spread = np.tile(beta, (lanes, 1))
        plant.simulate(log, start, 100, zero, zero, spread)
        took = best(lambda b=spread: plant.simulate(log, start, 100, zero, zero, b), 5, time.perf_counter)
        print(f"\n{lanes:6} stretches of 10 s, {name:12}: {took * 1e3:9.2f} ms, {lanes * 100 / took:.3g} steps/s")
        if lanes == 10_000:
            assert took < 1.0 * (3 if os.getloadavg()[0] > 3 else 1)
    screen = np.tile(plant.null, (lanes, 1))
    for b in range(lanes):
        c = b % len(plant.slots)
        for i in (c, *instead_of_channels(plant, plant.slots[c])):
            screen[b, i] = away(plant.slots[i], 1.0) if held(plant.slots[i]) else plant.null[i]
    plant.simulate(log, start, 100, zero, zero, screen)
    took = best(lambda: plant.simulate(log, start, 100, zero, zero, screen), 3, time.perf_counter)
    print(f"{lanes:6} stretches of 10 s, every slot in turn: {took * 1e3:9.2f} ms")


def test_cold_and_cached_start(tmp_path):
    """A process from nothing to its first motion, kernels compiled and then found."""
    code = "import sys; sys.path.insert(0, sys.argv[1]); import plant_cases as c; from rovval.plant import Plant; c.run(Plant(c.merlin()))"
    environment = {**os.environ, "ROVVAL_CACHE": str(tmp_path)}
    for name in ("cold", "cached"):
        start = time.perf_counter()
        subprocess.run([sys.executable, "-c", code, str(HERE.parent / "cases")], env=environment, check=True, capture_output=True)
        print(f"\n{name} start: {time.perf_counter() - start:.1f} s")
