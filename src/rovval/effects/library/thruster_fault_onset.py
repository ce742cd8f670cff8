"""One thruster loses thrust at some moment of the log."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, clip
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

RAMP = 0.1  # s; a sample of the common grid, so that the onset has a gradient

EFFECT = Effect(
    name="thruster_fault_onset",
    title="Thruster fails during the log",
    place="input",
    equation="T_i <- (1 - loss s(t)) T_i, s rising from 0 to 1 within 0.1 s of the onset.",
    symbols={
        "T_i": "thrust of thruster i, along its axis; N",
        "loss": "share of it that is lost; 1 is a dead thruster",
        "t, onset": "time and time of the fault since the run's start; s",
    },
    parameters=(
        Parameter("loss", "1", 0.0, 1.0, 0.0, 0.3, "0: sound, 1: dead", vanishes_at="high"),
        Parameter("onset", "s", 0.0, 1e6, 0.0, 60.0, "any time of the log", role="onset"),
    ),
    per="thruster",
    signature="from one moment on, a wrench in that thruster's own direction, growing with its thrust",
    confused_with=("thruster_degraded", "voltage_sag", "payload_change"),
    separates="the change point; before it that thruster is sound",
    literature=("Zhao 2014: thruster faults of an ROV detected during a dive", "Omerdic and Roberts 2004: partial and total faults"),
)
ROWS = ("loss", "onset")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Loss and onset per thruster."""
    return {"loss": p["loss"], "onset": p["onset"]}


def static(loss: Number, onset: Number, T: Number, t: Number) -> Number:
    """Thrust after the fault."""
    return T * (1.0 - loss * clip((t - onset) * (1.0 / RAMP), 0.0, 1.0))
