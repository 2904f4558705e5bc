"""Constraints that are said to follow from the others, looked at again near configurations that keep all of them.

By the implicit function theorem, constraints with independent gradients at a configuration are a manifold around it.
The others follow from them there if they vanish on it. So a configuration that keeps all constraints, the start of a
scene or one that is found from a random point, is left by a small random step, in coordinates, controls and time;
Newton's method leads back to the manifold of the independent constraints alone, and there the others are evaluated.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import sympy as sp
from mpmath import mp

from .manifold import State, moved_onto, valuation
from .points import IrregularPoint, Valuation, random_point
from .report import Verdict
from .system import MechanicalSystem
from .verdict import ATTEMPTS, DIGITS, POINTS, WORKING_DIGITS, Judgement

STEP = sp.Rational(1, 1000)
"""Of the random step, in terms of the random numbers up to two."""


def judge_redundancy(
    described: MechanicalSystem, independent: MechanicalSystem, starts: Sequence[Mapping[sp.Symbol, sp.Expr]], seed: str
) -> Judgement:
    """Verdict on the constraints of a system that others are said to imply.

    Parameters
    ----------
    described : MechanicalSystem
        With all constraints.
    independent : MechanicalSystem
        Without those in question.
    starts : sequence of mapping of Symbol to Expr
        Configurations that keep all constraints: numbers for what is known of time, parameters, controls, coordinates.
    seed : str
        Makes the random steps.

    Returns
    -------
    Judgement
        ``agrees`` with the digits and points, ``disagrees`` with the first constraint that does not vanish, or
        ``undecided`` where too few configurations were found.
    """
    others = [f for f in described.constraints if f not in independent.constraints]
    jacobian = [[f.diff(q) for q in independent.coordinates] for f in independent.constraints]
    with mp.workdps(WORKING_DIGITS):
        compared = 0
        for state, step in _steps(described, starts, seed):
            try:
                moved_onto(state, independent.coordinates, independent.constraints, jacobian)
                if _first_left(others, state):
                    continue
                for symbol, by in step.items():
                    state[symbol] += by
                moved_onto(state, independent.coordinates, independent.constraints, jacobian)
                left = _first_left(others, state)
            except (IrregularPoint, ZeroDivisionError):
                continue
            if left:
                return Judgement(Verdict.DISAGREES, DIGITS, POINTS, f"{left} where the others hold")
            compared += 1
            if compared == POINTS:
                return Judgement(Verdict.AGREES, DIGITS, POINTS)
    reason = f"only {compared} configurations were found that keep all constraints, of {POINTS} looked for"
    return Judgement(Verdict.UNDECIDED, None, compared or None, reason)


def _steps(
    system: MechanicalSystem, starts: Sequence[Mapping[sp.Symbol, sp.Expr]], seed: str
) -> Iterator[tuple[State, State]]:
    """Configurations to begin with, and a random step away from each; parameters stay."""
    changing = {system.time, *system.coordinates, *system.controls}
    names = sorted(
        {symbol.name for f in system.constraints for symbol in f.free_symbols} | {q.name for q in system.coordinates}
    )
    for attempt in range(ATTEMPTS * POINTS):
        known = starts[attempt % len(starts)] if starts else {}
        drawn = random_point(names, 2 * attempt, seed)
        step = random_point(names, 2 * attempt + 1, seed)
        number = Valuation({})
        yield (
            {symbol: number(known.get(symbol, drawn[symbol])) for symbol in drawn},
            {symbol: number(STEP * by) for symbol, by in step.items() if symbol in changing},
        )


def _first_left(constraints: Sequence[sp.Expr], state: State) -> str:
    """Tell the first of the constraints that does not vanish; empty where all do."""
    value, size = valuation(state), max(1, *(abs(number) for number in state.values()))
    for f in constraints:
        if abs(left := value(f)) > mp.mpf(10) ** -DIGITS * size:
            return f"{f} is {mp.nstr(left, 12)}"
    return ""
