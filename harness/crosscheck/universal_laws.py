"""Verify control laws that Maxima finds to make every motion free.

Under such a law every multiplier is zero: at every state on the constraint manifold the bordered equations,
Lagrange's with multipliers and d^2 f/dt^2 = 0, have the solution lambda = 0. States are drawn at random and moved
onto the manifold by Newton's method, first the positions, then the velocities. Neither (10) nor a solution of the
constraints by Maxima is used.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial

import sympy as sp
from mpmath import mp

from .digits import DIGITS, POINTS, WORKING_DIGITS
from .evaluation import Steps
from .independent import IndependentEquations
from .irregular_point import IrregularPoint
from .linear import LinearEquations
from .manifold import Gradients, moved_onto
from .points import random_point
from .report import CheckResult, Verdict
from .seed import fresh_seed
from .system import MechanicalSystem, dotted
from .verdict import confirmed

DRAWS = 40
"""Draws for each state before the search for a regular one is given up."""


@dataclass(frozen=True)
class ControlLaw:
    """A law for the controls."""

    controls: Mapping[sp.Symbol, sp.Expr]  # by control, in the time, in constants and in controls that stay free
    positive: tuple[sp.Expr, ...] = ()  # what must be positive where the law holds


def verify_law(
    system: MechanicalSystem,
    values: Mapping[sp.Symbol, sp.Expr],
    law: ControlLaw,
    span: tuple[sp.Expr, sp.Expr] | None = None,
) -> CheckResult:
    """Return the verdict on a law, by the multipliers in random states.

    The verdict is undecided if too few regular states are found, for example because the law is not real there.

    Parameters
    ----------
    system : MechanicalSystem
    values : mapping of Symbol to Expr
        Values of parameters. Others are random.
    law : ControlLaw
    span : tuple of (Expr, Expr) or None
        First and last time of the states, or None for no limits.

    Returns
    -------
    CheckResult
        Agreement, disagreement with the state's seed, or undecided.
    """
    moved = _MovedByLaw(system, values, law)
    seed = fresh_seed()
    draws = (_within(span, random_point(moved.names, attempt, seed), system.time) for attempt in range(DRAWS * POINTS))
    with mp.workdps(WORKING_DIGITS):
        for found in range(POINTS):
            detail = _residual_at_next_state(moved, draws)
            if detail is None:
                reason = f"only {found} regular states were found on the constraint manifold, of {POINTS} looked for"
                return CheckResult(Verdict.UNDECIDED, None, found or None, reason)
            if detail:
                return CheckResult(Verdict.DISAGREES, DIGITS, POINTS, f"{detail}, in a state drawn with seed {seed}")
    return CheckResult(Verdict.AGREES, DIGITS, POINTS)


def _within(
    span: tuple[sp.Expr, sp.Expr] | None, point: dict[sp.Symbol, sp.Rational], time: sp.Symbol
) -> dict[sp.Symbol, sp.Rational]:
    """Move the time of a point from the interval [-2, 2] into the time span."""
    if span is None or time not in point:
        return point
    first, last = (sp.Rational(str(sp.N(end, 30))) for end in span)
    return point | {time: first + (last - first) * (point[time] + 2) / 4}


def _residual_at_next_state(moved: _MovedByLaw, draws: Iterator[Mapping[sp.Symbol, sp.Rational]]) -> str | None:
    """Return the first nonzero multiplier at the next state, empty if all are zero.

    None if the draws end without a state.
    """
    for point in draws:
        try:
            return confirmed(partial(moved.residual, point))
        except (IrregularPoint, ZeroDivisionError):
            continue
    return None


def _under_law(system: MechanicalSystem, law: ControlLaw) -> MechanicalSystem:
    """Substitute a law before equations are derived."""
    history = {}  # under u = 0, sqrt(u) has a value and no derivative by u
    for control, expression in law.controls.items():
        rate = system.time_derivative(expression)
        history |= {
            control: expression,
            dotted("dot", control): rate,
            dotted("ddot", control): system.time_derivative(rate),
        }
    return replace(
        system,
        kinetic_energy=system.kinetic_energy.xreplace(history),
        potential_energy=system.potential_energy.xreplace(history),
        forces=tuple(force.xreplace(history) for force in system.forces),
        constraints=tuple(constraint.xreplace(history) for constraint in system.constraints),
    )


class _MovedByLaw:
    """The equations of a system with a law and parameter values substituted."""

    def __init__(self, system: MechanicalSystem, values: Mapping[sp.Symbol, sp.Expr], law: ControlLaw) -> None:
        moved = _under_law(system, law)
        equations = IndependentEquations(moved)

        def valued(expressions: Iterable[sp.Expr]) -> tuple[sp.Expr, ...]:
            return tuple(expression.xreplace(values) for expression in expressions)

        constraints, rates = valued(moved.constraints), valued(equations.constraint_derivatives)
        positive, laws = valued(law.positive), valued(law.controls.values())
        self.multipliers = system.pushing_multipliers
        self.motion = LinearEquations(equations.bordered.unknowns, valued(equations.bordered.residuals))
        self.constraints, self.rates = Steps(constraints), Steps(rates)
        self.positions = Gradients(constraints, system.coordinates)
        self.speeds = Gradients(rates, system.velocities)
        self.positive, self.law = Steps(positive), Steps(laws)
        everything = (*constraints, *rates, *self.motion.residuals, *positive, *laws)
        symbols = set().union(*(expression.free_symbols for expression in everything))
        state = {*system.coordinates, *system.velocities}
        self.names = sorted(symbol.name for symbol in (symbols | state) - {*self.motion.unknowns})

    def residual(self, point: Mapping[sp.Symbol, sp.Rational]) -> str:
        """Return the first nonzero multiplier, empty if all are zero."""
        state: dict[sp.Symbol, mp.mpf] = {symbol: mp.mpf(number.p) / number.q for symbol, number in point.items()}
        if any(value <= 0 for value in self.positive.real_at(state)):
            raise IrregularPoint
        self.law.real_at(state)  # irregular if it is not real, though its square may be
        moved_onto(state, self.constraints, self.positions)
        moved_onto(state, self.rates, self.speeds)
        found = self.motion.solution(state, real=True)
        if None in found.values():
            raise IrregularPoint
        scale = max(1, *(abs(number) for number in (*state.values(), *found.values()))) ** 2
        for multiplier in self.multipliers:
            if abs(left := found[multiplier]) > mp.mpf(10) ** -DIGITS * scale:
                return f"{multiplier} is {mp.nstr(left, 12)}"
        return ""
