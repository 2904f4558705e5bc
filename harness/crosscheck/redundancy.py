"""Check redundant constraints and the mass matrix by ranks on the manifold.

By the implicit function theorem, constraints with independent gradients at a configuration are a manifold around it.
The others follow from them there if they vanish on it. So a configuration near the initial state of a scene, or a
random one, is moved by Newton's method onto the constraints that the record lists as independent. If the others hold as
well, the rank of the gradients of all constraints is the number of independent ones.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import islice
from typing import NamedTuple

import sympy as sp
from mpmath import mp

from ..language import translatable
from .digits import DIGITS, WORKING_DIGITS
from .draws import Point
from .evaluation import Steps
from .irregular_point import IrregularPoint
from .manifold import Gradients, State, left_over, moved_onto
from .points import random_point
from .ranks import Elimination
from .report import CheckResult, Verdict
from .system import MechanicalSystem, gradient

STEP = sp.Rational(1, 1000)
"""Of the random step away from an initial state, in terms of the random numbers up to two."""

CONFIGURATIONS = 3
"""Configurations on the manifold at which ranks are found."""

DRAWS = 60
"""Configurations from which one on the manifold is looked for."""


Configuration = Mapping[sp.Symbol, sp.Expr]


class Ranks(NamedTuple):
    """Ranks of the mass matrix and of the constraint gradients at a configuration.

    The gradients are those of all constraints, and of the independent ones.
    """

    mass: int
    every: int
    independent: int


def verify_redundancy(
    described: MechanicalSystem,
    independent: Sequence[str],
    regular: bool,
    starts: Sequence[Configuration],
    seed: str,
) -> CheckResult:
    """Return the verdict on redundant constraints and the kind of the mass matrix.

    Parameters
    ----------
    described : MechanicalSystem
        With all constraints.
    independent : sequence of str
        Multipliers of the constraints that the record lists as independent.
    regular : bool
        True if the mass matrix is regular by the record.
    starts : sequence of mapping of Symbol to Expr
        Configurations that satisfy all constraints: numbers for known times, parameters, controls, coordinates.
    seed : str
        Seed of the random steps.

    Returns
    -------
    CheckResult
        Agreement, disagreement with the reason, or undecided. Undecided, too, is what is true of random parameters and
        not of those of the scenes.
    """
    manifold = _Manifold(described, independent)
    found = manifold.ranks_at_some(_configurations(manifold.names, described, starts, seed))
    if not found and manifold.only_independent_hold:
        detail = translatable("where the independent constraints hold, the others do not")
        return CheckResult(Verdict.DISAGREES, DIGITS, manifold.only_independent_hold, detail)
    if not found:
        reason = translatable("no configuration was found that satisfies all constraints")
        return CheckResult(Verdict.UNDECIDED, None, None, reason)
    contradiction = partial(_contradiction, len(independent), len(described.coordinates), regular)
    detail = contradiction(found)
    states = _states_alone(described, starts)
    if detail and states != starts:
        general = manifold.ranks_at_some(_configurations(manifold.names, described, states, seed))
        if general and not contradiction(general):
            reason = translatable("so for random parameters; for those of the scenes, %(detail)s", detail=detail)
            return CheckResult(Verdict.UNDECIDED, None, None, reason)
    return CheckResult(Verdict.DISAGREES if detail else Verdict.AGREES, DIGITS, len(found), detail)


def _contradiction(independent: int, coordinates: int, regular: bool, at: Sequence[Ranks]) -> str:
    """Return a contradiction of the largest ranks to the record, or an empty text."""
    found = Ranks(*(max(ranks) for ranks in zip(*at, strict=True)))
    if found.every != independent or found.independent != independent:
        return translatable(
            "%(every)s constraints are independent, and %(found)s of the %(independent)s listed as such",
            every=found.every,
            found=found.independent,
            independent=independent,
        )
    if (found.mass == coordinates) != regular:
        return translatable(
            "the mass matrix has the rank %(rank)s of %(coordinates)s", rank=found.mass, coordinates=coordinates
        )
    return ""


class _Manifold:
    """The constraints and the mass matrix of a system, evaluated at configurations."""

    def __init__(self, system: MechanicalSystem, independent: Sequence[str]) -> None:
        q, v = system.coordinates, system.velocities
        own = [f for f, name in zip(system.constraints, system.multipliers, strict=True) if name.name in independent]
        self._independent = Steps(own), Gradients(own, q)
        self._every = Steps(system.constraints), Gradients(system.constraints, q)
        self._mass = Gradients(gradient(system.kinetic_energy, v), v)
        symbols = set().union(*(f.free_symbols for f in (*system.constraints, system.kinetic_energy)))
        self.names = sorted({x.name for x in symbols | {*q}} - {x.name for x in v})
        self.only_independent_hold = 0  # configurations where the independent constraints hold, and not all others

    def ranks_at_some(self, points: Iterable[Point]) -> list[Ranks]:
        """Return ranks near the first points that lead to the manifold."""
        with mp.workdps(WORKING_DIGITS):
            found = (ranks for point in points if (ranks := self._ranks_near(point)) is not None)
            return list(islice(found, CONFIGURATIONS))

    def _ranks_near(self, point: Point) -> Ranks | None:
        """Return ranks at a configuration of the manifold near a point, or None."""
        state: State = {x: mp.mpf(number.p) / number.q for x, number in point.items()}
        try:
            moved_onto(state, *self._independent)
            if left_over(state, *self._every):
                self.only_independent_hold += 1
                return None
            matrices = self._mass.at(state), self._every[1].at(state), self._independent[1].at(state)
        except IrregularPoint:
            return None
        return Ranks(*(Elimination(rows).rank for rows in matrices))


def _configurations(
    names: Sequence[str], system: MechanicalSystem, starts: Sequence[Configuration], seed: str
) -> Iterator[Point]:
    """Yield points a random step away from the initial configurations.

    Unknown values are random.
    """
    moving = _moving(system)
    exact = [_rational_values(start) for start in starts]
    for attempt in range(DRAWS):
        known = exact[attempt % len(exact)] if exact else {}
        drawn = random_point(names, 2 * attempt, seed)
        step = random_point(names, 2 * attempt + 1, seed)
        yield {x: known[x] + (STEP * step[x] if x in moving else 0) if x in known else drawn[x] for x in drawn}


def _moving(system: MechanicalSystem) -> set[sp.Symbol]:
    return {system.time, *system.coordinates, *system.controls}


def _states_alone(system: MechanicalSystem, starts: Sequence[Configuration]) -> list[Configuration]:
    """Return configurations without the values of parameters."""
    moving = _moving(system)
    return [{x: value for x, value in start.items() if x in moving} for start in starts]


def _rational_values(start: Configuration) -> dict[sp.Symbol, sp.Rational]:
    with mp.workdps(WORKING_DIGITS):
        values = Steps(list(start.values())).at({})
    return {
        x: sp.Rational(str(mp.nstr(value, WORKING_DIGITS)))
        for x, value in zip(start, values, strict=True)
        if value is not None and not mp.im(value)
    }
