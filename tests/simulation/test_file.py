"""A simulation in a file comes back as it was."""


import numpy as np
from command_case import write_dive

from rovval import demo
from rovval.simulation import simulate
from rovval.simulation.file import load_simulation, save_simulation
from rovval.storage.archive import open_run
from rovval.vehicle import load


def test_a_simulation_file_round_trips_exactly(tmp_path):
    sim = simulate(open_run(write_dive(tmp_path)), load("merlin"), effects=(demo.EFFECT,))
    save_simulation(sim, tmp_path / "s.parquet")
    back = load_simulation(tmp_path / "s.parquet")
    for name in sim.__dataclass_fields__:
        one, two = getattr(sim, name), getattr(back, name)
        if name in ("free", "windowed"):
            assert all(np.array_equal(getattr(one, f), getattr(two, f), equal_nan=True) for f in one.__dataclass_fields__)
        elif isinstance(one, np.ndarray):
            assert np.array_equal(one, two, equal_nan=True)
        else:
            assert one == two
