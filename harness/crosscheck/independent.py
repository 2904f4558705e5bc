"""The independent evaluation: Lagrange's equations straight from T, V, Q and f.

T is differentiated by the total time derivative, as in

    d/dt dT/d dot(q_s) - dT/dq_s = Q_s + lambda_beta df_beta/dq_s,        d^2 f_beta/dt^2 = 0,

and in no other way: no split into A, B and T0, no Christoffel symbols, no symbolic inverse. Both sets of equations
are linear in accelerations and multipliers. Their coefficients make the bordered system [A -J^T; J 0].

The power of the reactions of moving constraints follows. A reaction lies along df/dq, and its power is lambda_b
(df_b/dq_s) dot(q_s). On a motion the constraints stay zero, and with them their time derivative, (df_b/dq_s) dot(q_s)
+ df_b/dt + (df_b/du_r) dot(u_r) = 0. So

    P = -lambda_b (df_b/dt + (df_b/du_r) dot(u_r)),

which is zero if the constraints are at rest, and if their multipliers are zero.
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
        """Return the n left sides d/dt dT/d dot(q_s) - dT/dq_s."""
        return self._lagrangian_derivatives(self.system.kinetic_energy)

    @cached_property
    def constraint_forces(self) -> tuple[sp.Expr, ...]:
        """The n reactions lambda_beta df_beta/dq_s."""
        system = self.system
        terms: dict[sp.Symbol, list[sp.Expr]] = {q: [] for q in system.coordinates}
        for multiplier, f in zip(system.multipliers, system.constraints, strict=True):
            present = sorted(f.free_symbols & terms.keys(), key=str)
            for q, slope in zip(present, gradient(f, present), strict=True):
                terms[q].append(multiplier * slope)
        return tuple(sp.Add(*each) for each in terms.values())

    @cached_property
    def constraint_derivatives(self) -> tuple[sp.Expr, ...]:
        """The g constraints, differentiated once."""
        return tuple(self.system.time_derivative(f) for f in self.system.constraints)

    @cached_property
    def constraint_accelerations(self) -> tuple[sp.Expr, ...]:
        """The g constraints, differentiated twice."""
        return tuple(self.system.time_derivative(rate) for rate in self.constraint_derivatives)

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
    def bordered_derivatives(self) -> LinearEquations:
        """The bordered system, differentiated.

        These are equations for the n jerks and the time derivatives of the g multipliers.
        """
        return LinearEquations(
            (*self.system.jerks, *self.system.multiplier_derivatives),
            tuple(self.system.time_derivative(residual) for residual in self.bordered.residuals),
        )

    @cached_property
    def _solvable_motion(self) -> tuple[sp.Expr, ...]:
        """The n residuals of Lagrange's equations, made regular.

        If A is singular, the constraint accelerations are added.
        """
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
        """Return d/dt dX/d dot(q_s) - dX/dq_s for each s, of a function X of the state."""
        system = self.system
        momenta, slopes = gradient(function, system.velocities), gradient(function, system.coordinates)
        return tuple(system.time_derivative(momentum) - slope for momentum, slope in zip(momenta, slopes, strict=True))
