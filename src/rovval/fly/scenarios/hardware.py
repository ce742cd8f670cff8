"""Scenario 4 (thesis 4.5 and 5.4): which of the hardware log's channels a log holds, with units and ranges."""

from __future__ import annotations

from typing import Any

import numpy as np

from rovval.core.channels import POSE, VELOCITIES, channel, members
from rovval.core.data import Run
from rovval.fly.scenarios import Check, Outcome


def hardware(run: Run) -> Outcome:
    """Every channel of the log with its range, and those of the thesis's list that it lacks."""
    thrusters = members(tuple(run.values), "n")
    expected = (*VELOCITIES, *POSE, "udot", "vdot", "wdot")
    checks = [_check(run, name) for name in expected]
    measured = any(run.measured(f"n:{t}") for t in thrusters)
    checks.append(Check("measured speed of each thruster", ", ".join(thrusters) or "none logged", measured))
    commanded = members(tuple(run.values), "n_cmd")
    checks.append(Check("commanded speed of each thruster", ", ".join(commanded) or "not logged", bool(commanded) or None))
    rows: list[dict[str, Any]] = [_range(run, name) for name in run.values]
    return Outcome(
        4,
        "channels of the hardware log",
        run.vehicle or "unknown",
        "",
        tuple(checks),
        {"run": run.id, "channels": rows},
        run=run,
    )


def _check(run: Run, name: str) -> Check:
    seen = f"{100 * run.ok(name).mean():.1f} % of the run" if run.measured(name) else "not logged"
    return Check(f"{name} ({channel(name).meaning}, {channel(name).unit})", seen, True if run.measured(name) else None)


def _range(run: Run, name: str) -> dict[str, Any]:
    ok = run.ok(name)
    values = run.get(name)[ok]
    low, high = (float(np.min(values)), float(np.max(values))) if len(values) else (None, None)
    return {
        "channel": name,
        "unit": channel(name).unit,
        "n": int(ok.sum()),
        "coverage": float(ok.mean()),
        "low": low,
        "high": high,
    }
