"""What the reactions do as work, where the constraints move: the knob costs power.

A reaction lies along df/dq, and so does its power along the velocities: lambda_b (df_b/dq_s) dot(q_s). On a motion the
constraints stay zero, and with them their rate, (df_b/dq_s) dot(q_s) + df_b/dt + (df_b/du_r) dot(u_r) = 0. So

    P = -lambda_b (df_b/dt + (df_b/du_r) dot(u_r)),

which is zero where nobody moves the constraints, and where they do not push.
"""

import sympy as sp
from sympy import Expr

from .system import MechanicalSystem


def reaction_power(system: MechanicalSystem) -> Expr:
    """Power of all reactions by the rates of the constraints at rest, in state, controls and multipliers."""
    return -sp.Add(
        *(
            multiplier * rate_at_rest(system, constraint)
            for multiplier, constraint in zip(system.multipliers, system.constraints, strict=True)
        )
    )


def rate_at_rest(system: MechanicalSystem, constraint: Expr) -> Expr:
    """Rate of a constraint where no coordinate moves: that of the time and the controls alone."""
    return system.total_rate(constraint).subs(dict.fromkeys(system.velocities, 0))


def power_of_forces(system: MechanicalSystem) -> Expr:
    """Power of the generalized forces, those of the potential not among them."""
    return sp.Add(*(force * velocity for force, velocity in zip(system.forces, system.velocities, strict=True)))
