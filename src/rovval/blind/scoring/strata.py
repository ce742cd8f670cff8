"""Strata of a sealed set: logs that are scored together, and never averaged with others."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rovval.blind.cases.grid import lasting
from rovval.blind.scoring import ground_truth

RICH = ("rich", "steps", "protocol", "joystick", "square", "pirouette")  # missions of both plants that move the vehicle on all axes
MAGNITUDES = ((1.25, "about 1"), (1.6, "about 1.5"), (float("inf"), "about 2"))  # upper end of |severity|, in words
DISTINGUISHABLE = 0.10  # share of the gap that the oracle must close for an effect to be called distinguishable


def strata(label: Mapping[str, Any], best: Mapping[str, float]) -> list[str]:
    """Every stratum that a log belongs to; ``best`` is what the oracle closes (`oracle`)."""
    effects, mission, oracle = label["effects"], label["mission"], best.get("seen")
    if label["left_out"]:
        seen = ["left out, distinguishable"] if (oracle or 0.0) >= DISTINGUISHABLE else ["left out, not distinguishable"]
        return ["left out", *seen]
    if not effects:
        return ["null", f"null, {mission}"]
    if any(ground_truth.foreign(e) for e in effects):
        return ["foreign"] if len(effects) == 1 else ["foreign with others"]
    if len(effects) > 1:
        several = {2: "two", 3: "three"}.get(len(effects), "many")
        return [several, f"{several}, each distinguishable"] if best.get("each", 0.0) >= DISTINGUISHABLE else [several]
    one = effects[0]
    if one["onset_s"] is not None and one["name"] in lasting():
        return ["single, begins in mid-log"] + ["single, begins in mid-log, distinguishable"] * ((oracle or 0.0) >= DISTINGUISHABLE)
    form = "same form" if one["form"] == "equal" else "different form"
    excitation = "rich" if mission in RICH else "poor"
    size = next(words for end, words in MAGNITUDES if abs(one["severity"]) < end)
    found = ["single", f"single, {form}", f"single, {excitation}", f"single, severity {size}"]
    if one["place"] == "sensor":
        found.append("single, sensor")
    if (oracle or 0.0) >= DISTINGUISHABLE:
        found += [
            "single, distinguishable",
            f"single, distinguishable, {form}",
            f"single, distinguishable, {form}, {excitation}",
        ]
    else:
        found.append("single, not distinguishable")
    return found
