"""Equations (1) to (11) of a derivation, each against the independent evaluation.

Every function here takes the claims of one derivation and the relations of one equation, and
states the comparison that decides it. Where the record has solved for something, the comparison
is with the solution of the bordered system, and the record's closed forms (4), (8), (11) serve
as the certificate of its proof.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement, product

import sympy as sp

from ..record import Equation, Relation
from .claims import Entries, NotComparable, entries_of, require_names, residual_pairs, solved_for
from .independent import IndependentEquations
from .system import MechanicalSystem
from .verdict import Comparison, Pair

Relations = Sequence[Relation]
ClosedForm = Mapping[sp.Symbol, sp.Expr]


@dataclass(frozen=True)
class DerivationClaims:
    """A derivation of the record beside the independent evaluation of its system."""

    stated: IndependentEquations  # of the system as it is described
    known: IndependentEquations  # of its independent constraints: what is solved
    equations: tuple[Equation, ...]

    @property
    def system(self) -> MechanicalSystem:
        """The system that the derivation is of."""
        return self.stated.system

    def driven_accelerations(self) -> ClosedForm | None:
        """Accelerations with multipliers (4), where the record holds them."""
        return self._solution("driven_accelerations", self.system.accelerations)

    def free_accelerations(self) -> ClosedForm | None:
        """Accelerations (4) with every multiplier zero."""
        driven = self.driven_accelerations()
        released = dict.fromkeys(self.system.multipliers, sp.Integer(0))
        return driven and {a: value.xreplace(released) for a, value in driven.items()}

    def multipliers(self) -> ClosedForm | None:
        """Multipliers of the independent constraints in closed form (8), where the record holds them."""
        solution = self._solution("multipliers", self.system.multipliers)
        return solution and {multiplier: solution[multiplier] for multiplier in self.known.system.multipliers}

    def motion(self) -> ClosedForm | None:
        """Accelerations (11) and multipliers (8) together."""
        accelerations = self._solution("accelerations", self.system.accelerations)
        multipliers = self.multipliers()
        if accelerations is None or multipliers is None:
            return None
        return {**accelerations, **multipliers}

    def _solution(self, name: str, symbols: Sequence[sp.Symbol]) -> ClosedForm | None:
        for equation in self.equations:
            if equation.id == name:
                try:
                    return solved_for(symbols, equation.relations)
                except NotComparable:
                    continue
        return None


def constraints(claims: DerivationClaims, relations: Relations) -> Comparison:
    """(1): f_beta = 0."""
    return Comparison(residual_pairs("constraint", relations, claims.system.constraints))


def equations_of_motion(claims: DerivationClaims, relations: Relations) -> Comparison:
    """(2) and (3): left less right side is the residual of Lagrange's equation."""
    return Comparison(residual_pairs("equation of motion", relations, claims.stated.motion))


def split_kinetic_energy(claims: DerivationClaims, relations: Relations) -> Comparison:
    """(3), its coefficients: A, B and T0 are those of T as a polynomial in the velocities."""
    require_names(("A", "B", "T0"), relations)
    T, v = claims.system.kinetic_energy, claims.system.velocities
    n = len(v)
    A, B = entries_of("A", (n, n), relations), entries_of("B", (n,), relations)
    at_rest = dict.fromkeys(v, sp.Integer(0))
    T0 = {relation.left.name: relation.right for relation in relations if relation.left.is_Symbol}
    return Comparison(
        (
            *(Pair(f"A[{s + 1},{k + 1}]", _entry(A, s, k), T.diff(v[s], v[k])) for s, k in product(range(n), repeat=2)),
            *(Pair(f"B[{s + 1}]", _entry(B, s), T.diff(v[s]).xreplace(at_rest)) for s in range(n)),
            Pair("T0", T0.get("T0", sp.Integer(0)), T.xreplace(at_rest)),
        )
    )


def driven_accelerations(claims: DerivationClaims, relations: Relations) -> Comparison:
    """(4): the accelerations that Lagrange's equations give, the multipliers left open."""
    claimed = solved_for(claims.system.accelerations, relations)
    return Comparison(_solved_pairs(claimed), solves=(claims.known.driven,), certificate=claimed)


def inverse_mass_matrix(claims: DerivationClaims, relations: Relations) -> Comparison:
    """(5): A^ls A_sk is the unit matrix, or the inverse of A + J^T J where A is singular."""
    require_names(("A_inverse",), relations)
    n = len(claims.system.coordinates)
    inverse = entries_of("A_inverse", (n, n), relations)
    A = claims.known.inverted
    return Comparison(
        tuple(
            Pair(
                f"row {row + 1} of A_inverse, times column {k + 1} of what it inverts",
                sp.Add(*(_entry(inverse, row, s) * A[s][k] for s in range(n))),
                sp.Integer(row == k),
            )
            for row, k in product(range(n), repeat=2)
        )
    )


def christoffel_symbols(claims: DerivationClaims, relations: Relations) -> Comparison:
    """(6): half the second derivatives by the velocities of d/dt dT/d dot(q_s) - dT/dq_s."""
    require_names(("christoffel",), relations)
    v = claims.system.velocities
    n = len(v)
    claimed = entries_of("christoffel", (n, n, n), relations)
    at_rest = dict.fromkeys(claims.system.accelerations, sp.Integer(0))
    pairs = []
    for s, residual in enumerate(claims.stated.kinetic):
        quadratic = residual.xreplace(at_rest)
        for k, m in combinations_with_replacement(range(n), 2):
            symbol = claimed.get((k + 1, m + 1, s + 1), claimed.get((m + 1, k + 1, s + 1)))
            expected = quadratic.diff(v[k], v[m]) / 2
            if symbol is not None or expected != 0:
                name = f"christoffel[{k + 1},{m + 1},{s + 1}]"
                pairs.append(Pair(name, symbol or sp.Integer(0), expected))
    return Comparison(tuple(pairs))


def constraint_accelerations(claims: DerivationClaims, relations: Relations) -> Comparison:
    """(7): the second total derivative of each constraint."""
    expected = claims.stated.constraint_accelerations
    return Comparison(residual_pairs("constraint acceleration", relations, expected))


def equations_for_multipliers(claims: DerivationClaims, relations: Relations) -> Comparison:
    """(8): the constraint accelerations where the accelerations are those of (4)."""
    expected = claims.known.constraint_accelerations
    return Comparison(
        residual_pairs("equation for the multipliers", relations, expected),
        solves=(claims.known.driven,),
        certificate=claims.driven_accelerations(),
    )


def multipliers(claims: DerivationClaims, relations: Relations) -> Comparison:
    """(8), solved: the multipliers of the bordered system, zero for redundant constraints."""
    solved = set(claims.known.system.multipliers)
    return Comparison(
        tuple(
            Pair(multiplier.name, value, multiplier if multiplier in solved else sp.Integer(0))
            for multiplier, value in solved_for(claims.system.multipliers, relations).items()
        ),
        solves=(claims.known.bordered,),
        certificate=claims.motion(),
    )


def constraint_forces(claims: DerivationClaims, relations: Relations) -> Comparison:
    """(9): lambda_gamma df_gamma/dq_s with the multipliers of the bordered system."""
    require_names(("Lambda",), relations)
    claimed = entries_of("Lambda", (len(claims.system.coordinates),), relations)
    return Comparison(
        tuple(
            Pair(f"Lambda[{s + 1}]", _entry(claimed, s), force)
            for s, force in enumerate(claims.known.constraint_forces)
        ),
        solves=(claims.known.bordered,),
        certificate=claims.motion(),
    )


def free_motion_condition(claims: DerivationClaims, relations: Relations) -> Comparison:
    """(10): the constraint accelerations where every multiplier is zero."""
    expected = claims.known.constraint_accelerations
    return Comparison(
        residual_pairs("condition of free motion", relations, expected),
        solves=(claims.known.free,),
        certificate=claims.free_accelerations(),
    )


def accelerations(claims: DerivationClaims, relations: Relations) -> Comparison:
    """(11): the accelerations of the bordered system."""
    return Comparison(
        _solved_pairs(solved_for(claims.system.accelerations, relations)),
        solves=(claims.known.bordered,),
        certificate=claims.motion(),
    )


def _solved_pairs(solution: ClosedForm) -> tuple[Pair, ...]:
    return tuple(Pair(symbol.name, value, symbol) for symbol, value in solution.items())


def _entry(entries: Entries, *indices: int) -> sp.Expr:
    """Look up an entry by indices that count from zero."""
    return entries.get(tuple(i + 1 for i in indices), sp.Integer(0))


COMPARISONS = {
    "constraints": constraints,
    "lagrange_equations": equations_of_motion,
    "kinetic_energy": split_kinetic_energy,
    "expanded_equations": equations_of_motion,
    "driven_accelerations": driven_accelerations,
    "inverse_mass_matrix": inverse_mass_matrix,
    "christoffel_symbols": christoffel_symbols,
    "constraint_accelerations": constraint_accelerations,
    "multiplier_equations": equations_for_multipliers,
    "multipliers": multipliers,
    "constraint_forces": constraint_forces,
    "free_motion_condition": free_motion_condition,
    "accelerations": accelerations,
}
"""The comparison that decides each equation, by its id."""
