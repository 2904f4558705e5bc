"""The independent evaluation: Lagrange's equations straight from T, V, Q and f.

T is differentiated by the total time derivative, as in

    d/dt dT/d dot(q_s) - dT/dq_s = Q_s + lambda_beta df_beta/dq_s,        d^2 f_beta/dt^2 = 0,

and in no other way: no split into A, B and T0, no Christoffel symbols, no matrix inverted in
symbols. Both sets of equations are linear in accelerations and multipliers; their coefficients,
read off, make the bordered system [A -J^T; J 0].

What the reactions do as work, where the constraints move, follows: the knob costs power. A reaction lies along df/dq,
and so does its power along the velocities: lambda_b (df_b/dq_s) dot(q_s). On a motion the constraints stay zero, and
with them their rate, (df_b/dq_s) dot(q_s) + df_b/dt + (df_b/du_r) dot(u_r) = 0. So

    P = -lambda_b (df_b/dt + (df_b/du_r) dot(u_r)),

which is zero where nobody moves the constraints, and where they do not push.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from .linear import LinearEquations
from .system import MechanicalSystem, gradient


@dataclass(frozen=True)
class IndependentEquations:
    """The equations of motion of one system, as residuals that vanish on every motion."""

    system: MechanicalSystem
    # whether J^T times the constraint accelerations is added where accelerations are solved for: for a mass matrix that
    # is singular, and regular together with the constraints
    supported: bool = False

    @cached_property
    def motion(self) -> tuple[sp.Expr, ...]:
        """The n residuals of Lagrange's equations, left side less right side."""
        system = self.system
        lagrangian = system.kinetic_energy - system.potential_energy
        return tuple(
            left - force - reaction
            for left, force, reaction in zip(
                self._lagrangian_derivatives(lagrangian),
                system.forces,
                self.constraint_forces,
                strict=True,
            )
        )

    @cached_property
    def kinetic(self) -> tuple[sp.Expr, ...]:
        """The n left sides d/dt dT/d dot(q_s) - dT/dq_s."""
        return self._lagrangian_derivatives(self.system.kinetic_energy)

    @cached_property
    def constraint_forces(self) -> tuple[sp.Expr, ...]:
        """The n reactions lambda_beta df_beta/dq_s."""
        system = self.system
        power = sp.Add(*(multiplier * f for multiplier, f in zip(system.multipliers, system.constraints, strict=True)))
        return tuple(gradient(power, system.coordinates))

    @cached_property
    def constraint_rates(self) -> tuple[sp.Expr, ...]:
        """The g constraints, differentiated once."""
        return tuple(self.system.total_rate(f) for f in self.system.constraints)

    @cached_property
    def constraint_accelerations(self) -> tuple[sp.Expr, ...]:
        """The g constraints, differentiated twice."""
        return tuple(self.system.total_rate(rate) for rate in self.constraint_rates)

    @cached_property
    def driven(self) -> LinearEquations:
        """Equations for the n accelerations, the multipliers given."""
        return LinearEquations(self.system.accelerations, self._solvable_motion)

    @cached_property
    def free(self) -> LinearEquations:
        """Equations for the n accelerations, every multiplier zero."""
        released = dict.fromkeys(self.system.multipliers, sp.Integer(0))
        return LinearEquations(
            self.system.accelerations, tuple(residual.xreplace(released) for residual in self._solvable_motion)
        )

    @cached_property
    def bordered(self) -> LinearEquations:
        """Equations for the n accelerations and the g multipliers together."""
        return LinearEquations(
            (*self.system.accelerations, *self.system.multipliers),
            (*self.motion, *self.constraint_accelerations),
        )

    @cached_property
    def bordered_rates(self) -> LinearEquations:
        """Equations for the n jerks and the g multiplier rates: the bordered system, differentiated."""
        return LinearEquations(
            (*self.system.jerks, *self.system.multiplier_rates),
            tuple(self.system.total_rate(residual) for residual in self.bordered.residuals),
        )

    @cached_property
    def _solvable_motion(self) -> tuple[sp.Expr, ...]:
        """The n residuals of Lagrange's equations, the constraint accelerations added where A needs them."""
        if not self.supported:
            return self.motion
        pairs = list(zip(self.system.constraints, self.constraint_accelerations, strict=True))
        return tuple(
            residual + sp.Add(*(f.diff(q) * rate for f, rate in pairs))
            for q, residual in zip(self.system.coordinates, self.motion, strict=True)
        )

    @cached_property
    def inverted(self) -> list[list[sp.Expr]]:
        """The n x n matrix that is solved with: A, or A + J^T J."""
        return self.driven.coefficients

    def _lagrangian_derivatives(self, function: sp.Expr) -> tuple[sp.Expr, ...]:
        """d/dt dX/d dot(q_s) - dX/dq_s, over s, of a function X of the state."""
        system = self.system
        momenta, slopes = gradient(function, system.velocities), gradient(function, system.coordinates)
        return tuple(system.total_rate(momentum) - slope for momentum, slope in zip(momenta, slopes, strict=True))


def reaction_power(system: MechanicalSystem) -> sp.Expr:
    """Power of all reactions by the rates of the constraints at rest, in state, controls and multipliers."""
    return -sp.Add(
        *(
            multiplier * rate_at_rest(system, constraint)
            for multiplier, constraint in zip(system.multipliers, system.constraints, strict=True)
        )
    )


def rate_at_rest(system: MechanicalSystem, constraint: sp.Expr) -> sp.Expr:
    """Rate of a constraint where no coordinate moves: that of the time and the controls alone."""
    return system.total_rate(constraint).subs(dict.fromkeys(system.velocities, 0))


def power_of_forces(system: MechanicalSystem) -> sp.Expr:
    """Power of the generalized forces, those of the potential not among them."""
    return sp.Add(*(force * velocity for force, velocity in zip(system.forces, system.velocities, strict=True)))
