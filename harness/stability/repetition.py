"""Equations that repeat for ever or after whole turns, by their programs.

Of a value f of a program, f -> f + c or f -> c - f with a number c is known, or nothing, where the time moves on by a
period, a coordinate by a turn, or some change their signs. A sine repeats if c of its argument is a multiple of 2 pi,
and changes its sign if it is an odd one of pi.
"""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from math import e, isfinite, pi, prod
from typing import NamedTuple

import numpy as np

from ..program.arithmetic import Arithmetic, run_program
from ..program.motion_program import Constant, Operation
from ..program.numpy_function import UFUNCS
from .equivalence import TURN
from .linear_equations import ROWS, LinearEquations

ROWS_OF_MOTION = ROWS[:-1]  # their gradients by the state repeat with them
COMMENSURATE = 1e-8  # of a phase after a period, whose digits are limited


class Later(NamedTuple):
    """The later value sign f + change of f, or a number."""

    sign: int = 1
    change: float = 0.0
    number: float | None = None


Known = Later | None
REPEATED = Later()


def equations_repeat(equations: LinearEquations, period: float) -> bool:
    """Return True if equations are known to repeat at all times, in all states.

    Parameters
    ----------
    equations : LinearEquations
        Equations of a motion.
    period : float
        Time after which they are the same.

    Returns
    -------
    bool
    """
    if equations.tables:
        return False
    time = {"t": Later(1, period)}
    law = {} if equations.law is None else run_program(equations.law, time, LATER)
    return set(_rows_after(equations, time | law).values()) <= {1}


def whole_turns(equations: LinearEquations) -> list[int]:
    """Return the places of coordinates that whole turns are known not to change.

    Parameters
    ----------
    equations : LinearEquations
        Equations that do not contain the time.

    Returns
    -------
    list of int
    """
    turned = [_rows_after(equations, {name: Later(1, TURN)}) for name in equations.coordinates]
    return [k for k, rows in enumerate(turned) if set(rows.values()) <= {1}]


def reversible(equations: LinearEquations, places: Sequence[int]) -> bool:
    """Return True if other signs of some coordinates are known to be the same state.

    Parameters
    ----------
    equations : LinearEquations
        Equations that do not contain the time.
    places : sequence of int
        Places of these coordinates.

    Returns
    -------
    bool
    """
    names = [equations.coordinates[k] for k in places]
    moved = {each.format(name): Later(-1) for name in names for each in ("{}", "dot({})", "ddot({})")}
    odd = {f"equation[{k + 1}]" for k in places}
    return all(sign == (-1 if row in odd else 1) for row, sign in _rows_after(equations, moved).items())


def _rows_after(equations: LinearEquations, changes: Mapping[str, Known]) -> dict[str, int]:
    """Return the later signs of the equations' rows, 0 where nothing is known."""
    inputs = dict.fromkeys(equations.program.inputs, REPEATED) | changes
    found = run_program(equations.program, inputs, LATER)
    rows = {name: each for name, each in found.items() if name.partition("[")[0] in ROWS_OF_MOTION}
    return {name: 0 if each is None or each.change else each.sign for name, each in rows.items()}


def _repeated(*values: Known) -> Known:
    """Return that a function of values repeats, if all of them do."""
    return REPEATED if all(each is not None and each[:2] == (1, 0) for each in values) else None


def _numeric(value: float) -> Known:
    return Later(number=float(value)) if isfinite(value) else None


def _sum(*terms: Later) -> Known:
    signs = {each.sign for each in terms if each.number is None}
    if len(signs) > 1:
        return None
    (sign,) = signs
    return Later(sign, sum(each.change if each.number is None else (1 - sign) * each.number for each in terms))


def _product(*factors: Later) -> Known:
    numbers = prod(each.number for each in factors if each.number is not None)
    changing = [each for each in factors if each.number is None]
    if len(changing) == 1:
        return Later(changing[0].sign, numbers * changing[0].change)
    return None if any(each.change for each in changing) else Later(prod(each.sign for each in changing))


def _quotient(above: Later, below: Later) -> Known:
    if below.number is None:
        return None if below.change else _product(above, below)
    return _product(above, Later(number=1 / below.number)) if below.number else None


def _even(argument: Later) -> Known:
    return None if argument.change else REPEATED


def _odd(argument: Later) -> Known:
    return None if argument.change else Later(argument.sign)


def _wave(half_turned: int, otherwise: Callable[[Later], Known]) -> Callable[[Later], Known]:
    """Return the rule of a function that half a turn multiplies by a factor.

    Where the argument does not change by half turns, it is another one.
    """

    def rule(argument: Later) -> Known:
        half_turns = round(argument.change / pi)
        if argument.sign == 1 and half_turns and abs(argument.change - half_turns * pi) <= COMMENSURATE:
            return Later(half_turned ** abs(half_turns))
        return otherwise(argument)

    return rule


ODD = (
    Operation.SIGN,
    Operation.TAN,
    Operation.SINH,
    Operation.TANH,
    Operation.ARCSIN,
    Operation.ARCTAN,
    Operation.ARSINH,
)
RULES: dict[Operation, Callable[..., Known]] = {
    **dict.fromkeys(ODD, _odd),
    **dict.fromkeys((Operation.ABS, Operation.COSH), _even),
    Operation.SIN: _wave(-1, _odd),
    Operation.COS: _wave(-1, _even),
    Operation.TAN: _wave(1, _odd),
    Operation.ADD: _sum,
    Operation.SUBTRACT: lambda one, other: _sum(one, _product(MINUS, other)),
    Operation.NEGATE: lambda one: _product(MINUS, one),
    Operation.MULTIPLY: _product,
    Operation.DIVIDE: _quotient,
}
MINUS = Later(number=-1.0)
NUMBERS: dict[Operation, Callable[..., float]] = {
    **UFUNCS,
    Operation.ADD: lambda *terms: sum(terms),
    Operation.SUBTRACT: np.subtract,
    Operation.NEGATE: np.negative,
    Operation.MULTIPLY: lambda *factors: prod(factors),
    Operation.DIVIDE: np.divide,
    Operation.POWER: np.power,
}


def _rule(operation: Operation) -> Callable[..., Known]:
    of_numbers, of_values = NUMBERS.get(operation), RULES.get(operation, _repeated)

    def rule(*arguments: Known) -> Known:
        if None in arguments:
            return None
        numbers = [each.number for each in arguments if each.number is not None]
        if of_numbers is None or len(numbers) < len(arguments):
            return of_values(*arguments)
        with np.errstate(all="ignore"):
            return _numeric(of_numbers(*numbers))

    return rule


def _power(base: Known, exponent: Fraction) -> Known:
    if base is not None and base.number is None and not base.change and exponent.denominator == 1:
        return Later(base.sign ** abs(exponent.numerator))
    return _rule(Operation.POWER)(base, _numeric(exponent))


LATER = Arithmetic(
    number=_numeric,
    constants={Constant.PI: _numeric(pi), Constant.E: _numeric(e)},
    power=_power,
    operations={operation: _rule(operation) for operation in Operation},
)
