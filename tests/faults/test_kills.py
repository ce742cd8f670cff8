"""Kill -9 at random moments: every result is there once, and equal to an undisturbed night's."""

from __future__ import annotations

import json

import fault_case
import pytest

pytestmark = pytest.mark.slow

INGEST, PAGES = '["ingest"]', '["ingest", "simulate", "compare"]'
MOMENTS = 10  # a part; five parts make the fifty of each kind
PARTS = [*((seed, INGEST) for seed in range(4)), (4, PAGES)]


@pytest.mark.parametrize("strike", [fault_case.parent, fault_case.worker, fault_case.everything], ids=lambda strike: strike.__name__)
@pytest.mark.parametrize(("seed", "steps"), PARTS)
def test_killed_at_random_moments(tmp_path, logs, undisturbed, strike, seed, steps):
    night = fault_case.Night(tmp_path / "night", logs, steps)
    tally = fault_case.disturb(night, undisturbed(steps), strike, MOMENTS, seed, "--workers", "2")
    print(f"\n{strike.__name__}, {steps}: {tally.struck} kills, {tally.ended} nights came to their end, all equal")
    assert tally.struck == MOMENTS and tally.ended >= 1


def test_the_harness_sees_what_it_is_there_for(tmp_path, logs, undisturbed):
    """Another byte, a result too few, a row twice, a leftover: each would be found."""
    night, whole = fault_case.Night(tmp_path / "night", logs), undisturbed(INGEST)
    assert night.whole() == 0
    fault_case.check_all(night, whole)
    table = next((night.folder / "archive").glob("*/run.parquet"))
    for what in ("another", "fewer", "left over", "page"):
        content, left = table.read_bytes(), table.with_name(".run.parquet.0.part")
        if what == "another":
            table.write_bytes(content[:-1])
        elif what == "fewer":
            table.unlink()
        elif what == "left over":
            left.touch()
        else:
            (night.folder / "reports" / "summary.json").write_text(json.dumps({"exit_code": 2}))
        with pytest.raises((AssertionError, KeyError)):
            fault_case.check_all(night, whole)
        if what == "another":
            with pytest.raises(AssertionError):
                fault_case.check_part(night, whole)
        table.write_bytes(content)
        left.unlink(missing_ok=True)
