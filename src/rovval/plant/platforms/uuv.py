"""uuv_simulator's model, which the thesis installs for its ROS simulator (appendix A): Fossen's equation in Gazebo's steps.

Gazebo's engine (ODE) integrates the rigid body; a plugin adds the hydrodynamic forces of each step. Added mass is such a force, of a filtered
acceleration of the steps before, since the engine's own mass matrix cannot take it.
"""

from __future__ import annotations

import numpy as np

from rovval.core.errors import UsageProblem
from rovval.plant.platforms import Engine, Platform
from rovval.vehicle.model import Vehicle, as_matrix, rigid_body_mass

STEP_S = 0.002  # max_step_size of its worlds (empty_underwater.world)
SHARE = 0.3  # HydrodynamicModel.cc, HMFossen: FilterAcc(acc, 0.3)
TIME_CONSTANT_S = 0.05  # its RexROV (rexrov_actuators.xacro, dyn_time_constant); the thesis prints none for Merlin


def vehicle(nominal: Vehicle) -> Vehicle:
    """With the diagonal of quadratic drag alone, and thrust of the shaft's speed alone, by the file's [uuv] table where it has one.

    Raises UsageProblem where added mass is so large beside the body that the explicit force makes the steps unstable, as it does in the original.
    """
    added, rigid = as_matrix(nominal.body.added_mass), rigid_body_mass(nominal.body)
    ratio = float(np.abs(np.linalg.eigvals(np.linalg.solve(rigid, added))).max())
    if SHARE * ratio >= 2.0 - SHARE:  # the filter's memory decays by |1 - SHARE - SHARE ratio| a step
        raise UsageProblem(
            f"{nominal.name}: added mass is {ratio:.3g} times the body's own; uuv's explicit added-mass force is unstable from {(2 - SHARE) / SHARE:.3g} on",
            "use --model fossen, which has added mass in the mass matrix",
        )
    body = nominal.body.model_copy(update={"quadratic_drag": tuple(np.diag(as_matrix(nominal.body.quadratic_drag)).tolist())})
    own = nominal.uuv
    gains = zip(own.k_pos, own.k_neg, strict=True) if own and own.k_pos else ((t.k_pos, t.k_neg) for t in nominal.thruster)
    at_rest: dict[str, object] = {"advance_pos": (0.0, 0.0, 0.0), "advance_neg": (0.0, 0.0, 0.0)}
    thruster = tuple(t.model_copy(update=at_rest | {"k_pos": a, "k_neg": b}) for t, (a, b) in zip(nominal.thruster, gains, strict=True))
    return nominal.model_copy(update={"body": body, "thruster": thruster})


def time_constant(nominal: Vehicle) -> float:
    """Of the thrusters, s: the file's, or RexROV's."""
    return nominal.uuv.time_constant if nominal.uuv else TIME_CONSTANT_S


PLATFORM = Platform(
    title="uuv_simulator in Gazebo, which the thesis installs for ROS (appendix A)",
    equations="M_RB nu_dot + C_RB(nu) nu = tau - M_A a - C_A(nu_r) nu_r - (D_l + D_q |nu_r|) nu_r - g(eta), a <- 0.7 a + 0.3 (change of nu_r over the last "
    "step) / h; D_q diagonal; thruster speed n' = (n_cmd - n) / T, thrust k n |n|; semi-implicit Euler steps of h = 2 ms",
    source="github.com/uuvsimulator/uuv_simulator: HydrodynamicModel.cc (HMFossen), Dynamics.cc (FirstOrder), ThrusterConversionFcn.cc (Basic), "
    "empty_underwater.world (step), rexrov_actuators.xacro (T = 0.05 s); thesis 3.2 has the same equation, appendix A the installation",
    leaves_out=(
        "couplings of quadratic drag: its input is a matrix, of which its damping takes the diagonal",
        "an inflow that lowers thrust: its conversion functions know the speed of the shaft alone",
        "the force of accelerating water on the displaced volume, but as an effect of the library",
        "its surface ramp of buoyancy, the sensors' noise, and contact: the engine's other plugins",
    ),
    assumed=(
        "the thesis prints neither time constant nor conversion curve of its ROS simulator: T is RexROV's; Merlin's thrust per speed is the ROS column "
        "of table 6.1, at 70 rpm",
        "velocity steps in the body frame, where ODE steps in the world's: the difference is of the order of one step of 2 ms",
        "wherever a stretch begins the filter has settled; the original spawns at rest with an empty one, which settles in some steps",
    ),
    vehicle=vehicle,
    engine=Engine(STEP_S, SHARE, time_constant),
)
