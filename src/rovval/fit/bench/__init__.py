"""A thruster on a bench: the motor's law (thesis 2.4) from a table of voltage and thrust, its time constant from a record of steps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rovval.core.errors import BadInput, all_at_once
from rovval.fit.bench import motor_law, step_response

Array = NDArray[np.float64]
MOST_PROBLEMS = 5  # wrong lines that are named


def table(path: Path, columns: Sequence[int]) -> Array:
    """Columns (n, len(columns)), counted from 1, of a text table with commas, semicolons, tabs or blanks; a first line of words is passed over.

    Raises BadInput: the file cannot be read, or lines that do not hold numbers in these columns, the first ones named.
    """
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise BadInput(f"{path}: {error}", "give a text table of numbers") from None
    rows, problems = [], []
    for number, line in enumerate(lines, 1):
        cells = line.replace(";", " ").replace(",", " ").split()
        if not cells:
            continue
        try:
            rows.append([float(cells[c - 1]) for c in columns])
        except ValueError:
            problems += [f"line {number}: {line[:60]!r}"] if number > 1 else []
        except IndexError:
            problems.append(f"line {number} has {len(cells)} columns, {max(columns)} are asked for")
    if problems or not rows:
        more = f" and {len(problems) - MOST_PROBLEMS} more" if len(problems) > MOST_PROBLEMS else ""
        said = all_at_once(problems[:MOST_PROBLEMS] or ["no line of numbers"], str(path)) + more
        raise BadInput(said, "say with --columns which columns hold the numbers")
    return np.array(rows)


def motor(path: Path, columns: Sequence[int]) -> tuple[str, dict[str, Any]]:
    """Equation 2.4 of a table of voltage (V) and thrust (N), both ways together and each by itself; as text and as rovval.motor/1."""
    volts, thrust = table(path, columns).T
    both = motor_law.fit(volts, thrust)
    found = {"both ways": both}
    for way, sign in (("ahead", 1.0), ("astern", -1.0)):
        part = thrust * sign > 0
        if part.sum() >= 3:
            found[way] = motor_law.fit(volts[part], thrust[part])
    text = "\n".join([f"{path.name}: {len(volts)} points", *(f"{way:<10} {law}" for way, law in found.items())])
    fits = {way: asdict(law) for way, law in found.items()}
    units = {"resistive": "V/N", "back_emf": "V/N^0.5", "rms": "V", "largest": "V", "lowest": "N", "highest": "N"}
    return text, {"schema": "rovval.motor/1", "file": path.name, "equation": "thesis 2.4", "units": units, "fits": fits}


def response(path: Path, columns: Sequence[int]) -> tuple[str, dict[str, Any]]:
    """Time constants of the steps of a record of time (s) and speed or thrust; as text and as rovval.response/1."""
    t, y = table(path, columns).T
    found = step_response.steps(t, y)
    text = "\n".join([f"{path.name}: {len(t)} samples of {np.median(np.diff(t)):.4g} s", *map(str, found)])
    hint = "as an effect: --effect thrust_lag:tau=SECONDS, one for both ways"
    return f"{text}\n{hint}", {"schema": "rovval.response/1", "file": path.name, "steps": [asdict(s) for s in found]}
