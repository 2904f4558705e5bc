"""Evaluate motion programs, and others of a motion, in many digits.

Its arithmetic uses mpmath's low-level numbers, which takes half the time of the type `mpf`. Functions are those of
`tape`.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import lru_cache, partial
from itertools import product
from typing import Any

from mpmath import mp
from mpmath.libmp import (
    from_rational,
    fzero,
    mpf_add,
    mpf_cos,
    mpf_div,
    mpf_exp,
    mpf_mul,
    mpf_neg,
    mpf_pow_int,
    mpf_sin,
    mpf_sub,
    round_nearest,
    to_rational,
)

from ..program.motion_problem import DependsOn, MotionProblem
from ..program.motion_program import VARIADIC, Call, Constant, Expression, Name, Operation, Program
from ..program.rewriting import computing
from .irregular_point import IrregularPoint
from .tape import value_of
from .taylor import Polynomial, Taylor

Values = dict[str, Polynomial]
Step = tuple[Callable[..., "Number"], int, int]  # an operation, and the places of what it takes
Number = tuple  # sign, mantissa, exponent, bits of the mantissa, as mpmath keeps a number
STATE = Taylor(0)
ENTIRE = {Operation.SIN: mpf_sin, Operation.COS: mpf_cos, Operation.EXP: mpf_exp}
LARGEST_POWER = 64  # up to which a power is made of products


class Same:
    """A program with identity as equality."""

    def __init__(self, program: Program) -> None:
        self.program = program

    def __hash__(self) -> int:
        return id(self.program)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Same) and self.program is other.program


def run(program: Program, inputs: Mapping[str, Polynomial]) -> Values:
    """Return values of all names and outputs of a program for values of its inputs.

    The values begin with those of the inputs.

    Parameters
    ----------
    program : Program
    inputs : mapping of str to Polynomial
        Polynomial of each input. Only its constant is used.

    Returns
    -------
    Values
        Constant polynomials by name.

    Raises
    ------
    IrregularPoint
        One of them has no finite real value.
    """
    steps, places = _steps(Same(program))
    values = [inputs[name][0]._mpf_ for name in program.inputs]
    precision, append = mp.prec, values.append
    for function, i, k in steps:
        append(function(values[i], values[k], precision, round_nearest))
    return {name: (mp.make_mpf(values[place]),) for name, place in places.items()}


@lru_cache(maxsize=32)
def _steps(same: Same) -> tuple[list[Step], dict[str, int]]:
    """Return a program as operations on two places in a list, and the places of names.

    The list begins with the inputs.
    """
    program = same.program
    places: dict[str, int] = {name: place for place, name in enumerate(program.inputs)}
    steps: list[Step] = []
    numbers: dict[Fraction | Constant, int] = {}

    def added(function: Callable[..., Number], i: int = 0, k: int = 0) -> int:
        steps.append((function, i, k))
        return len(program.inputs) + len(steps) - 1

    def place_of(expression: Expression) -> int:
        match expression:
            case Name(text):
                return places[text]
            case Call(Operation.POWER, (base, exponent)) if _is_whole(exponent):
                return added(partial(_whole_power, int(exponent)), place_of(base))
            case Call(operation, arguments):
                first, *others = map(place_of, arguments)
                for other in others or [first] * (operation not in VARIADIC):
                    first = added(BINARY.get(operation) or partial(_function, operation, len(arguments)), first, other)
                return first
            case _:
                if expression not in numbers:
                    numbers[expression] = added(partial(_constant, expression))
                return numbers[expression]

    for name, expression in program.assignments:
        places[name] = place_of(expression)
    return steps, places | {name: place_of(atom) for name, atom in program.outputs.items()}


def outputs_of(program: Program, inputs: Mapping[str, Polynomial]) -> Values:
    """Return values of the outputs of a program.

    Parameters
    ----------
    program : Program
    inputs : mapping of str to Polynomial
        Polynomial of each input. Only its constant is used.

    Returns
    -------
    Values
        Constant polynomials by name.

    Raises
    ------
    IrregularPoint
        As `run`.
    """
    values = run(program, inputs)
    return {name: values[name] for name in program.outputs}


def run_along(program: Program, inputs: Mapping[str, Polynomial], taylor: Taylor) -> Values:
    """Return values of all names and outputs of a program along a curve.

    Parameters
    ----------
    program : Program
    inputs : mapping of str to Polynomial
        Polynomial of each input.
    taylor : Taylor
        Arithmetic up to the order of the polynomials.

    Returns
    -------
    Values
        Polynomials by name.

    Raises
    ------
    IrregularPoint
        As `run`.
    """
    known: Values = {name: inputs[name] for name in program.inputs}

    def evaluate(expression: Expression) -> Polynomial:
        match expression:
            case Name(text):
                return known[text]
            case Call(operation, arguments):
                return value_of(taylor, str(operation), list(map(evaluate, arguments)))
            case _:
                return (mp.make_mpf(_constant(expression)),)

    for name, expression in program.assignments:
        known[name] = evaluate(expression)
    return known | {name: evaluate(atom) for name, atom in program.outputs.items()}


def _is_whole(exponent: Expression) -> bool:
    return isinstance(exponent, Fraction) and exponent.denominator == 1 and 0 <= exponent <= LARGEST_POWER


def _whole_power(exponent: int, base: Number, _: Number, precision: int, rounding: str) -> Number:
    return mpf_pow_int(base, exponent, precision, rounding)


def _constant(constant: Fraction | Constant, *_: Any) -> Number:
    match constant:
        case Fraction():
            return from_rational(*constant.as_integer_ratio(), mp.prec, round_nearest)
        case Constant.PI:
            return (+mp.pi)._mpf_
        case _:
            return (+mp.e)._mpf_


def _quotient(x: Number, y: Number, precision: int, rounding: str) -> Number:
    if y == fzero:
        raise IrregularPoint
    return mpf_div(x, y, precision, rounding)


def _negative(x: Number, *_: Any) -> Number:
    return mpf_neg(x)


def _function(operation: Operation, count: int, x: Number, y: Number, precision: int, rounding: str) -> Number:
    if operation in ENTIRE:
        return ENTIRE[operation](x, precision, rounding)
    arguments = [(mp.make_mpf(each),) for each in (x, y)[:count]]
    (found,) = value_of(STATE, str(operation), arguments)
    if isinstance(found, mp.mpf) and mp.isfinite(found):
        return found._mpf_
    raise IrregularPoint


BINARY: dict[Operation, Callable[..., Number]] = {
    Operation.ADD: mpf_add,
    Operation.MULTIPLY: mpf_mul,
    Operation.SUBTRACT: mpf_sub,
    Operation.DIVIDE: _quotient,
    Operation.NEGATE: _negative,
}


def with_signs(problem: MotionProblem, inputs: Values) -> Values:
    """Return the inputs with the signs that a motion depends on.

    A function may contain the signs before its own.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    inputs : Values
        Inputs without signs.

    Returns
    -------
    Values
        The inputs, and 1 or -1 for each sign.

    Raises
    ------
    IrregularPoint
        A switching function is zero, or no sign pattern is consistent.
    """
    found = inputs | {sign.name: (mp.one,) for sign in problem.signs}
    for place, sign in enumerate(problem.signs, 1):
        if sign.by is DependsOn.REACTION:
            continue
        name = f"switch[{place}]"
        switch = run(computing(problem.switching, {name}), found)[name][0]
        if not switch:
            raise IrregularPoint
        found[sign.name] = (mp.mpf(1 if switch > 0 else -1),)
    return _with_signs_of_reactions(problem, found)


def _with_signs_of_reactions(problem: MotionProblem, inputs: Values) -> Values:
    """Return the inputs with the one sign pattern that agrees with its multipliers."""
    multipliers = {sign.of: sign.name for sign in problem.signs if sign.by is DependsOn.REACTION}
    consistent = []
    for signs in product((mp.one, -mp.one), repeat=len(multipliers)):
        tried = inputs | {name: (sign,) for name, sign in zip(multipliers.values(), signs, strict=True)}
        found = run(problem.motion, tried) if multipliers else {}
        if all(sign * found[multiplier][0] > 0 for multiplier, sign in zip(multipliers, signs, strict=True)):
            consistent.append(tried)
    if len(consistent) != 1:
        raise IrregularPoint
    return consistent[0]


def symbols_of_tables(problem: MotionProblem, time: mp.mpf) -> Values:
    """Return the numbers of the polynomial that each table is at a given time.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    time : mpf
        Time, in the scene's unit.

    Returns
    -------
    Values
        Value of each input of a table.
    """
    found: Values = {}
    for table in problem.tables:
        piece = table.pieces[bisect_right(table.begins, Fraction(*to_rational(time._mpf_))) - 1]
        found |= {name: (_number(text),) for name, text in zip(table.inputs, piece, strict=True)}
    return found


def _number(text: str) -> mp.mpf:
    number = Fraction(text)
    return mp.mpf(number.numerator) / number.denominator
