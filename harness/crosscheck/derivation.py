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
from .claims import Entries, NotComparable, list_of, read_exactly, residual_pairs, solved_for, sparse_entries
from .independent import IndependentEquations
from .system import MechanicalSystem, gradient
from .verdict import Comparison, Pair

Relations = Sequence[Relation]
ClosedForm = Mapping[sp.Symbol, sp.Expr]


@dataclass(frozen=True)
class DerivationClaims:
    """A derivation of the record beside the independent evaluation of its system."""

    stated: IndependentEquations  # of the system as it is described
    known: IndependentEquations  # of its independent constraints: what is solved
    equations: tuple[Equation, ...]
    size: int = 0  # predicted, of the closed forms
    all_entries: bool = True  # whether (3a) holds all entries of A, its zeros among them

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
    T, v = claims.system.kinetic_energy, claims.system.velocities
    n = len(v)
    at_rest = dict.fromkeys(v, sp.Integer(0))
    momenta = gradient(T, v)
    if claims.all_entries:
        keys = list(product(range(1, n + 1), repeat=2))
        A = dict(zip(keys, read_exactly([["Subscript", "A", *key] for key in keys], relations[: n * n]), strict=True))
    else:
        A = sparse_entries("A", (n, n), (0, 1), relations[: max(len(relations) - n - 1, 0)])
        if missing := {(s, s) for s in range(1, n + 1)} - A.keys():
            raise NotComparable(f"no relation for A{list(min(missing))}")
    rest = relations[len(A) :]
    return Comparison(
        (
            *_sparse_pairs("A", A, {(s, k): a for s, p in enumerate(momenta, 1) for k, a in _slopes(p, v)}),
            *(
                Pair(f"B[{s}]", claimed, momentum.xreplace(at_rest))
                for s, (claimed, momentum) in enumerate(zip(list_of("B", n, rest[:n]), momenta, strict=True), 1)
            ),
            Pair("T0", *read_exactly(["T0"], rest[n:]), T.xreplace(at_rest)),
        )
    )


def _slopes(momentum: sp.Expr, velocities: Sequence[sp.Symbol]) -> list[tuple[int, sp.Expr]]:
    present = momentum.free_symbols
    return [(k, momentum.diff(v)) for k, v in enumerate(velocities, 1) if v in present]


def _sparse_pairs(name: str, claimed: Entries, expected: Entries) -> tuple[Pair, ...]:
    """Pairs for all entries that the record holds, and for all that are not zero."""
    zero = sp.Integer(0)
    return tuple(
        Pair(f"{name}{list(key)}", claimed.get(key, zero), expected.get(key, zero))
        for key in sorted(claimed.keys() | {key for key, value in expected.items() if value != 0})
    )


def driven_accelerations(claims: DerivationClaims, relations: Relations) -> Comparison:
    """(4): the accelerations that Lagrange's equations give, the multipliers left open."""
    claimed = solved_for(claims.system.accelerations, relations)
    return Comparison(_solved_pairs(claimed), solves=(claims.known.driven,), certificate=claimed)


def inverse_mass_matrix(claims: DerivationClaims, relations: Relations) -> Comparison:
    """(5): A^ls A_sk is the unit matrix, or the inverse of A + J^T J where A is singular."""
    n = len(claims.system.coordinates)
    keys = list(product(range(n), repeat=2))
    lefts = [["Subscript", "A_inverse", row + 1, s + 1] for row, s in keys]
    inverse = dict(zip(keys, read_exactly(lefts, relations), strict=True))
    A = claims.known.inverted
    return Comparison(
        tuple(
            Pair(
                f"row {row + 1} of A_inverse, times column {k + 1} of what it inverts",
                sp.Add(*(inverse[row, s] * A[s][k] for s in range(n))),
                sp.Integer(row == k),
            )
            for row, k in keys
        )
    )


def christoffel_symbols(claims: DerivationClaims, relations: Relations) -> Comparison:
    """(6): half the second derivatives by the velocities of d/dt dT/d dot(q_s) - dT/dq_s, for k <= m."""
    v = claims.system.velocities
    n = len(v)
    claimed = sparse_entries("christoffel", (n, n, n), (2, 0, 1), relations)
    for k, m, s in claimed:
        if k > m:
            raise NotComparable(f"christoffel[{k}, {m}, {s}], which christoffel[{m}, {k}, {s}] stands for")
    at_rest = dict.fromkeys(claims.system.accelerations, sp.Integer(0))
    expected = {}
    for s, residual in enumerate(claims.stated.kinetic, 1):
        quadratic = residual.xreplace(at_rest)
        present = [k for k, velocity in enumerate(v, 1) if velocity in quadratic.free_symbols]
        for k, m in combinations_with_replacement(present, 2):
            expected[k, m, s] = quadratic.diff(v[k - 1], v[m - 1]) / 2
    return Comparison(_sparse_pairs("christoffel", claimed, expected))


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
    claimed = list_of("Lambda", len(claims.system.coordinates), relations)
    return Comparison(
        tuple(
            Pair(f"Lambda[{s}]", value, force)
            for s, (value, force) in enumerate(zip(claimed, claims.known.constraint_forces, strict=True), 1)
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
