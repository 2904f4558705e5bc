"""Equations (1) to (11) of a derivation, compared with the independent evaluation.

Each function here takes one derivation and the relations of one equation, and states the comparison
that decides it. If the record has solved for a quantity, the comparison is with the solution of the bordered system,
and the record's closed forms (4), (8), (11) are the certificate of its proof.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement, product

import sympy as sp

from ..language import translatable
from ..record import Equation, Relation
from .independent import IndependentEquations
from .relations import (
    NO_RELATION,
    Entries,
    NotComparable,
    list_of,
    read_exactly,
    residual_pairs,
    solved_for,
    sparse_entries,
)
from .system import MechanicalSystem, gradient
from .verdict import Comparison, Pair

Relations = Sequence[Relation]
ClosedForm = Mapping[sp.Symbol, sp.Expr]


@dataclass(frozen=True)
class CheckedDerivation:
    """A derivation of the record, with the independent evaluation of its system."""

    stated: IndependentEquations  # of the system as it is described
    known: IndependentEquations  # of its independent constraints: what is solved
    equations: tuple[Equation, ...]
    size: int = 0  # predicted, of the closed forms
    closed: bool = True  # whether these belong in the record
    all_entries: bool = True  # whether (3a) holds all entries of A, its zeros among them

    @property
    def system(self) -> MechanicalSystem:
        """The system of the derivation."""
        return self.stated.system

    def driven_accelerations(self) -> ClosedForm | None:
        """Return the accelerations with multipliers (4), if the record holds them.

        Returns
        -------
        ClosedForm or None
            By the symbols of the accelerations, or None without them.
        """
        return self._solution("driven_accelerations", self.system.accelerations)

    def free_accelerations(self) -> ClosedForm | None:
        """Return the accelerations (4) with every multiplier zero.

        Returns
        -------
        ClosedForm or None
            By the symbols of the accelerations, or None if the record does not hold (4).
        """
        driven = self.driven_accelerations()
        released = dict.fromkeys(self.system.multipliers, sp.Integer(0))
        return driven and {a: value.xreplace(released) for a, value in driven.items()}

    def multipliers(self) -> ClosedForm | None:
        """Return the multipliers of the independent constraints in closed form (8).

        Returns
        -------
        ClosedForm or None
            By the symbols of the multipliers, or None if the record does not hold them.
        """
        solution = self._solution("multipliers", self.system.multipliers)
        return solution and {multiplier: solution[multiplier] for multiplier in self.known.system.multipliers}

    def motion(self) -> ClosedForm | None:
        """Return the accelerations (11) and multipliers (8) together.

        Returns
        -------
        ClosedForm or None
            By their symbols, or None if the record does not hold both.
        """
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


def constraints(checked: CheckedDerivation, relations: Relations) -> Comparison:
    """Compare the constraints (1), f_beta = 0.

    Parameters
    ----------
    checked : CheckedDerivation
        The derivation.
    relations : Relations
        Relations of the equation.

    Returns
    -------
    Comparison
    """
    return Comparison(residual_pairs(translatable("constraint"), relations, checked.system.constraints))


def equations_of_motion(checked: CheckedDerivation, relations: Relations) -> Comparison:
    """Compare the equations of motion (2) and (3).

    The left side less the right side is the residual of Lagrange's equation.

    Parameters
    ----------
    checked : CheckedDerivation
        The derivation.
    relations : Relations
        Relations of the equation.

    Returns
    -------
    Comparison
    """
    return Comparison(residual_pairs(translatable("equation of motion"), relations, checked.stated.motion))


def split_kinetic_energy(checked: CheckedDerivation, relations: Relations) -> Comparison:
    """Compare A, B and T0 of (3), the coefficients of T as a polynomial in velocities.

    Parameters
    ----------
    checked : CheckedDerivation
        The derivation.
    relations : Relations
        Relations of the equation: A, then B, then T0.

    Returns
    -------
    Comparison
    """
    T, v = checked.system.kinetic_energy, checked.system.velocities
    n = len(v)
    at_rest = dict.fromkeys(v, sp.Integer(0))
    momenta = gradient(T, v)
    if checked.all_entries:
        keys = list(product(range(1, n + 1), repeat=2))
        A = dict(zip(keys, read_exactly([["Subscript", "A", *key] for key in keys], relations[: n * n]), strict=True))
    else:
        A = sparse_entries("A", (n, n), (0, 1), relations[: max(len(relations) - n - 1, 0)])
        if missing := {(s, s) for s in range(1, n + 1)} - A.keys():
            raise NotComparable(NO_RELATION, left=f"A{list(min(missing))}")
    rest = relations[len(A) :]
    return Comparison(
        (
            *_sparse_pairs("A", A, {(s, k): a for s, p in enumerate(momenta, 1) for k, a in _slopes(p, v)}),
            *(
                Pair(f"B[{s}]", derived, momentum.xreplace(at_rest))
                for s, (derived, momentum) in enumerate(zip(list_of("B", n, rest[:n]), momenta, strict=True), 1)
            ),
            Pair("T0", *read_exactly(["T0"], rest[n:]), T.xreplace(at_rest)),
        )
    )


def _slopes(momentum: sp.Expr, velocities: Sequence[sp.Symbol]) -> list[tuple[int, sp.Expr]]:
    present = momentum.free_symbols
    return [(k, momentum.diff(v)) for k, v in enumerate(velocities, 1) if v in present]


def _sparse_pairs(name: str, derived: Entries, expected: Entries) -> tuple[Pair, ...]:
    """Pair the entries of the record, and all nonzero entries."""
    zero = sp.Integer(0)
    return tuple(
        Pair(f"{name}{list(key)}", derived.get(key, zero), expected.get(key, zero))
        for key in sorted(derived.keys() | {key for key, value in expected.items() if value != 0})
    )


def driven_accelerations(checked: CheckedDerivation, relations: Relations) -> Comparison:
    """Compare (4), the accelerations of Lagrange's equations, with free multipliers.

    Parameters
    ----------
    checked : CheckedDerivation
        The derivation.
    relations : Relations
        Relations of the equation.

    Returns
    -------
    Comparison
    """
    derived = solved_for(checked.system.accelerations, relations)
    return Comparison(_solved_pairs(derived), solves=(checked.known.driven,), certificate=derived)


def inverse_mass_matrix(checked: CheckedDerivation, relations: Relations) -> Comparison:
    """Compare (5): A^ls A_sk is the unit matrix.

    If A is singular, the inverse is that of A + J^T J.

    Parameters
    ----------
    checked : CheckedDerivation
        The derivation.
    relations : Relations
        Relations of the equation.

    Returns
    -------
    Comparison
    """
    n = len(checked.system.coordinates)
    keys = list(product(range(n), repeat=2))
    lefts = [["Subscript", "A_inverse", row + 1, s + 1] for row, s in keys]
    inverse = dict(zip(keys, read_exactly(lefts, relations), strict=True))
    A = checked.known.inverted
    return Comparison(
        tuple(
            Pair(
                translatable(
                    "row %(row)s of A_inverse, times column %(column)s of what it inverts", row=row + 1, column=k + 1
                ),
                sp.Add(*(inverse[row, s] * A[s][k] for s in range(n))),
                sp.Integer(row == k),
            )
            for row, k in keys
        )
    )


def christoffel_symbols(checked: CheckedDerivation, relations: Relations) -> Comparison:
    """Compare (6): half the second derivatives of Lagrange's terms by the velocities.

    The terms are d/dt dT/d dot(q_s) - dT/dq_s, and k <= m.

    Parameters
    ----------
    checked : CheckedDerivation
        The derivation.
    relations : Relations
        Relations of the equation. Zeros are left out.

    Returns
    -------
    Comparison
    """
    v = checked.system.velocities
    n = len(v)
    derived = sparse_entries("christoffel", (n, n, n), (2, 0, 1), relations)
    for k, m, s in derived:
        if k > m:
            raise NotComparable(
                translatable("christoffel[%(k)s, %(m)s, %(s)s], which is equal to christoffel[%(m)s, %(k)s, %(s)s]"),
                k=k,
                m=m,
                s=s,
            )
    at_rest = dict.fromkeys(checked.system.accelerations, sp.Integer(0))
    expected = {}
    for s, residual in enumerate(checked.stated.kinetic, 1):
        quadratic = residual.xreplace(at_rest)
        symbols = quadratic.free_symbols
        present = [k for k, velocity in enumerate(v, 1) if velocity in symbols]
        for k, m in combinations_with_replacement(present, 2):
            expected[k, m, s] = quadratic.diff(v[k - 1], v[m - 1]) / 2
    return Comparison(_sparse_pairs("christoffel", derived, expected))


def constraint_accelerations(checked: CheckedDerivation, relations: Relations) -> Comparison:
    """Compare (7), the second total derivative of each constraint.

    Parameters
    ----------
    checked : CheckedDerivation
        The derivation.
    relations : Relations
        Relations of the equation.

    Returns
    -------
    Comparison
    """
    expected = checked.stated.constraint_accelerations
    return Comparison(residual_pairs(translatable("constraint acceleration"), relations, expected))


def equations_for_multipliers(checked: CheckedDerivation, relations: Relations) -> Comparison:
    """Compare (8): the constraint accelerations with the accelerations of (4).

    Parameters
    ----------
    checked : CheckedDerivation
        The derivation.
    relations : Relations
        Relations of the equation.

    Returns
    -------
    Comparison
    """
    expected = checked.known.constraint_accelerations
    return Comparison(
        residual_pairs(translatable("equation for the multipliers"), relations, expected),
        solves=(checked.known.driven,),
        certificate=checked.driven_accelerations(),
    )


def multipliers(checked: CheckedDerivation, relations: Relations) -> Comparison:
    """Compare (8), solved: the multipliers of the bordered system.

    Those of redundant constraints are zero.

    Parameters
    ----------
    checked : CheckedDerivation
        The derivation.
    relations : Relations
        Relations of the equation.

    Returns
    -------
    Comparison
    """
    solved = set(checked.known.system.multipliers)
    return Comparison(
        tuple(
            Pair(multiplier.name, value, multiplier if multiplier in solved else sp.Integer(0))
            for multiplier, value in solved_for(checked.system.multipliers, relations).items()
        ),
        solves=(checked.known.bordered,),
        certificate=checked.motion(),
    )


def constraint_forces(checked: CheckedDerivation, relations: Relations) -> Comparison:
    """Compare (9): lambda_gamma df_gamma/dq_s with the bordered system's multipliers.

    Parameters
    ----------
    checked : CheckedDerivation
        The derivation.
    relations : Relations
        Relations of the equation.

    Returns
    -------
    Comparison
    """
    derived = list_of("Lambda", len(checked.system.coordinates), relations)
    return Comparison(
        tuple(
            Pair(f"Lambda[{s}]", value, force)
            for s, (value, force) in enumerate(zip(derived, checked.known.constraint_forces, strict=True), 1)
        ),
        solves=(checked.known.bordered,),
        certificate=checked.motion(),
    )


def free_motion_condition(checked: CheckedDerivation, relations: Relations) -> Comparison:
    """Compare (10): the constraint accelerations with every multiplier zero.

    Parameters
    ----------
    checked : CheckedDerivation
        The derivation.
    relations : Relations
        Relations of the equation.

    Returns
    -------
    Comparison
    """
    expected = checked.known.constraint_accelerations
    return Comparison(
        residual_pairs(translatable("condition of free motion"), relations, expected),
        solves=(checked.known.free,),
        certificate=checked.free_accelerations(),
    )


def accelerations(checked: CheckedDerivation, relations: Relations) -> Comparison:
    """Compare (11), the accelerations of the bordered system.

    Parameters
    ----------
    checked : CheckedDerivation
        The derivation.
    relations : Relations
        Relations of the equation.

    Returns
    -------
    Comparison
    """
    return Comparison(
        _solved_pairs(solved_for(checked.system.accelerations, relations)),
        solves=(checked.known.bordered,),
        certificate=checked.motion(),
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
