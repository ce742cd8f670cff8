"""A Vehicle: the nominal numbers of one ROV, as its TOML file states them, each with a source.

Frames: body forward-starboard-down with its origin where the file says, world north-east-down; SI, except thrust gains
in N per rpm^2, as thruster tables print them. Added mass and damping are positive (M_A and D of Fossen 2021, 6.3 and 6.4).
"""

from __future__ import annotations

import hashlib
import json
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

Array = NDArray[np.float64]
Vector3 = tuple[float, float, float]
Diagonal = Annotated[tuple[float, ...], Field(min_length=6, max_length=6)]
Matrix = Annotated[tuple[Diagonal, ...], Field(min_length=6, max_length=6)]
Positive = Annotated[float, Field(gt=0)]
NotNegative = Annotated[float, Field(ge=0)]


class Strict(BaseModel):
    """Immutable, and a misspelt key is an error rather than ignored."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Body(Strict):
    """Rigid body and hydrodynamics (thesis 3.11 to 3.14). A list of six is a diagonal, a list of six lists a matrix."""

    mass: Positive
    Ixx: Positive
    Iyy: Positive
    Izz: Positive
    Ixy: float = 0.0
    Ixz: float = 0.0
    Iyz: float = 0.0
    added_mass: Diagonal | Matrix
    linear_drag: Diagonal | Matrix
    quadratic_drag: Diagonal | Matrix
    volume: Positive
    centre_of_gravity: Vector3
    centre_of_buoyancy: Vector3
    size: Vector3 = (1.0, 0.6, 0.5)


class Water(Strict):
    """Density kg/m3 and gravity m/s2."""

    density: Positive
    gravity: Positive


class Thruster(Strict):
    """One thruster: where it is, which way positive thrust pushes the vehicle, and its law.

    At rest in the water T = k_pos n^2 for n > 0 and -k_neg n^2 for n < 0 (n in rpm, N). With ``diameter`` and the advance-ratio
    rows (c1, c2, c3) the thrust becomes T (1 + c1/c0 J + ...): rho D^4 n|n| theta K_T(J_a), J_a = u_a / (n D), as the thesis's
    Simulink model has it; k_pos and k_neg then hold the J = 0 part. ``rpm_max``, if the file states it, is a limit for logs, not for the
    simulator: a recorded speed beyond it is a finding.
    """

    name: str
    position: Vector3
    direction: Vector3
    k_pos: Positive
    k_neg: Positive
    diameter: NotNegative = 0.0
    advance_pos: Vector3 = (0.0, 0.0, 0.0)
    advance_neg: Vector3 = (0.0, 0.0, 0.0)
    handedness: Literal[-1, 1] = 1
    rpm_max: Positive | None = None

    @property
    def vertical(self) -> bool:
        """Whether it pushes up or down more than aside: within 60 degrees of the vertical axis."""
        return abs(self.direction[2]) > 0.5 * float(np.linalg.norm(self.direction))


class Mixer(Strict):
    """How a pilot's sticks become pulse widths: pwm = neutral + span * sum(factor * stick), clipped by the autopilot at +-span.

    A stick is positive as its axis is: ahead, to starboard, down, roll right, nose up, turn right. A pulse width above ``neutral_us`` is
    positive thrust. ``frame`` names the autopilot's frame (`rovval.vehicle.ardusub`) whose published factors these are.
    """

    neutral_us: Positive
    span_us: Positive
    frame: str | None = None
    factors: dict[str, tuple[float, ...]]


class PulseTable(Strict):
    """Pulse width (us) to thrust (N) and, where it was measured, shaft speed (rpm, signed) at one supply voltage. The simulator needs
    the thrust alone: speeds of a log that holds pulse widths are those at which the thruster's law gives it.

    ``k_pos`` and ``k_neg`` are the gains (N/rpm2, one for each thruster) of thrusters that give this thrust, where the vehicle's own differ from
    them: those then give as much more or less at the same pulse width. Without them the table is of the vehicle's own thrusters.
    """

    voltage: Positive
    pwm_us: tuple[float, ...]
    rpm: tuple[float, ...] | None = None
    thrust: tuple[float, ...]
    k_pos: tuple[Positive, ...] = ()
    k_neg: tuple[Positive, ...] = ()


class Uuv(Strict):
    """What uuv_simulator has of its own of this vehicle (platform `uuv`): the ``time_constant`` (s) of its thrusters' first-order answer, and its
    conversion curves as gains ahead and astern (N/rpm2, one for each thruster), where they are not the vehicle's."""

    time_constant: NotNegative
    k_pos: tuple[Positive, ...] = ()
    k_neg: tuple[Positive, ...] = ()


class Vehicle(Strict):
    """One vehicle. ``sources`` names where each number comes from; ``convention`` guards against drag stored as negative.

    ``calibration`` is how far `rovval fit` has moved each of its unknowns from the numbers that it began with: the next fit counts from there.
    ``tolerance_correlation`` is how its tolerances go together: correlations of each with those before it.
    """

    name: str
    title: str = ""
    convention: Literal["fossen-positive"] = "fossen-positive"
    notes: tuple[str, ...] = ()
    sources: dict[str, str] = {}
    body: Body
    water: Water
    thruster: Annotated[tuple[Thruster, ...], Field(min_length=1)]
    mixer: Mixer | None = None
    pulse_table: PulseTable | None = None
    uuv: Uuv | None = None
    effects: dict[str, dict[str, float]] = {}
    calibration: dict[str, float] = {}
    tolerance_correlation: dict[str, tuple[float, ...]] = {}

    @property
    def thrusters(self) -> tuple[str, ...]:
        """Names of the thrusters in file order."""
        return tuple(t.name for t in self.thruster)

    @property
    def weight(self) -> float:
        """W = m g, N."""
        return self.body.mass * self.water.gravity

    @property
    def longest_arm(self) -> float:
        """Distance of the furthest thruster from the origin, m."""
        return max(float(np.linalg.norm(t.position)) for t in self.thruster)

    @property
    def buoyancy(self) -> float:
        """B = rho g volume, N."""
        return self.water.density * self.water.gravity * self.body.volume

    @property
    def correlation(self) -> Array:
        """Correlations (c, c) of the c tolerances that go together, in the order of ``tolerance_correlation``."""
        found = np.eye(len(self.tolerance_correlation))
        for i, row in enumerate(self.tolerance_correlation.values()):
            found[i, :i] = found[:i, i] = row
        return found

    @property
    def hash(self) -> str:
        """Short content hash: two vehicles with one hash move alike."""
        left_out: Any = {
            "sources": True, "notes": True, "title": True, "calibration": True, "tolerance_correlation": True,
            "thruster": {"__all__": {"rpm_max"}}, "mixer": {"frame": True},
        }  # fmt: skip
        numbers = self.model_dump(mode="json", exclude=left_out)
        if (table := numbers["pulse_table"]) and not table["k_pos"]:
            numbers["pulse_table"] = {key: value for key, value in table.items() if key not in ("k_pos", "k_neg")}
        if numbers["uuv"] is None:
            del numbers["uuv"]
        text = json.dumps(numbers, sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:12]


def as_matrix(values: tuple[float, ...] | tuple[tuple[float, ...], ...]) -> Array:
    """A diagonal of six or a 6 x 6 matrix, as a matrix."""
    a = np.array(values, dtype=float)
    return np.diag(a) if a.ndim == 1 else a


def inertia(body: Body) -> Array:
    """Inertia tensor about the body origin, kg m2 (3, 3); products of inertia carry the minus sign of thesis 3.11."""
    return np.array(
        [
            [body.Ixx, -body.Ixy, -body.Ixz],
            [-body.Ixy, body.Iyy, -body.Iyz],
            [-body.Ixz, -body.Iyz, body.Izz],
        ]
    )


def rigid_body_mass(body: Body) -> Array:
    """M_RB about the body origin (thesis 3.11; Fossen 2021, 3.50), (6, 6)."""
    x, y, z = body.centre_of_gravity
    m = body.mass
    cross = m * np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    mass = np.zeros((6, 6))
    mass[:3, :3] = m * np.eye(3)
    mass[:3, 3:] = -cross
    mass[3:, :3] = cross
    mass[3:, 3:] = inertia(body)
    return mass


def allocation(vehicle: Vehicle) -> Array:
    """T of tau = T U (thesis 3.15): column j is the wrench of 1 N of thruster j, (6, k)."""
    direction = np.array([t.direction for t in vehicle.thruster])
    direction = direction / np.linalg.norm(direction, axis=1, keepdims=True)
    return np.concatenate([direction, np.cross([t.position for t in vehicle.thruster], direction)], axis=1).T
