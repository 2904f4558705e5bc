"""A motion program, or another of a motion, evaluated in many digits.

Its arithmetic is done on mpmath's own numbers, below the type `mpf`, which would take twice the time; functions are
those of `tape`.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Mapping
from fractions import Fraction

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

from ..program.motion_problem import MotionProblem
from ..program.motion_program import Call, Constant, Expression, Name, Operation, Program
from .irregular_point import IrregularPoint
from .tape import value_of
from .taylor import Polynomial, Taylor

Values = dict[str, Polynomial]
Number = tuple  # sign, mantissa, exponent, bits of the mantissa, as mpmath keeps a number
STATE = Taylor(0)
ENTIRE = {Operation.SIN: mpf_sin, Operation.COS: mpf_cos, Operation.EXP: mpf_exp}
LARGEST_POWER = 64  # up to which a power is made of products


def run(program: Program, inputs: Mapping[str, Polynomial]) -> Values:
    """Values of all names and outputs of a program, where its inputs have the values that they begin with.

    Raises
    ------
    IrregularPoint
        One of them has no finite real value.
    """
    known = {name: inputs[name][0]._mpf_ for name in program.inputs}
    evaluate = _evaluation(known)
    for name, expression in program.assignments:
        known[name] = evaluate(expression)
    known |= {name: evaluate(atom) for name, atom in program.outputs.items()}
    return {name: (mp.make_mpf(x),) for name, x in known.items()}


def outputs_of(program: Program, inputs: Mapping[str, Polynomial]) -> Values:
    """Values of the outputs of a program; raises as `run`."""
    values = run(program, inputs)
    return {name: values[name] for name in program.outputs}


def run_along(program: Program, inputs: Mapping[str, Polynomial], taylor: Taylor) -> Values:
    """Values of all names and outputs of a program along a curve; raises as `run`."""
    known: Values = {name: inputs[name] for name in program.inputs}

    def evaluate(expression: Expression) -> Polynomial:
        match expression:
            case Name(text):
                return known[text]
            case Call(operation, arguments):
                return value_of(taylor, str(operation), list(map(evaluate, arguments)))
            case _:
                return (mp.make_mpf(_evaluation({})(expression)),)

    for name, expression in program.assignments:
        known[name] = evaluate(expression)
    return known | {name: evaluate(atom) for name, atom in program.outputs.items()}


def _evaluation(known: Mapping[str, Number]) -> Callable[[Expression], Number]:
    precision, numbers = mp.prec, {}

    def evaluate(expression: Expression) -> Number:
        match expression:
            case Name(text):
                return known[text]
            case Call(operation, arguments):
                return applied(operation, arguments)
            case Fraction():
                if expression not in numbers:
                    numbers[expression] = from_rational(*expression.as_integer_ratio(), precision, round_nearest)
                return numbers[expression]
            case Constant.PI:
                return (+mp.pi)._mpf_
            case _:
                return (+mp.e)._mpf_

    def applied(operation: Operation, arguments: tuple[Expression, ...]) -> Number:
        if operation is Operation.POWER and _is_whole(arguments[1]):
            return mpf_pow_int(evaluate(arguments[0]), int(arguments[1]), precision, round_nearest)
        first, *others = map(evaluate, arguments)
        match operation:
            case Operation.ADD:
                for other in others:
                    first = mpf_add(first, other, precision, round_nearest)
            case Operation.MULTIPLY:
                for other in others:
                    first = mpf_mul(first, other, precision, round_nearest)
            case Operation.SUBTRACT:
                first = mpf_sub(first, others[0], precision, round_nearest)
            case Operation.NEGATE:
                first = mpf_neg(first)
            case Operation.DIVIDE:
                if others[0] == fzero:
                    raise IrregularPoint
                first = mpf_div(first, others[0], precision, round_nearest)
            case _:
                return _of_function(operation, [first, *others])
        return first

    return evaluate


def _is_whole(exponent: Expression) -> bool:
    return isinstance(exponent, Fraction) and exponent.denominator == 1 and 0 <= exponent <= LARGEST_POWER


def _of_function(operation: Operation, x: list[Number]) -> Number:
    if operation in ENTIRE:
        return ENTIRE[operation](x[0], mp.prec, round_nearest)
    (found,) = value_of(STATE, str(operation), [(mp.make_mpf(each),) for each in x])
    if isinstance(found, mp.mpf) and mp.isfinite(found):
        return found._mpf_
    raise IrregularPoint


def with_signs(problem: MotionProblem, inputs: Values) -> Values:
    """The inputs with the signs that a motion depends on: a function may contain the signs before its own."""
    found = inputs | {sign.name: (mp.one,) for sign in problem.signs}
    for place, sign in enumerate(problem.signs, 1):
        switch = run(problem.switching, found)[f"switch[{place}]"][0]
        if not switch:
            raise IrregularPoint
        found[sign.name] = (mp.mpf(1 if switch > 0 else -1),)
    return found


def letters_of_tables(problem: MotionProblem, instant: mp.mpf) -> Values:
    """The numbers of the polynomial that each table is at an instant."""
    found: Values = {}
    for table in problem.tables:
        piece = table.pieces[bisect_right(table.begins, Fraction(*to_rational(instant._mpf_))) - 1]
        found |= {name: (_number(text),) for name, text in zip(table.inputs, piece, strict=True)}
    return found


def _number(text: str) -> mp.mpf:
    number = Fraction(text)
    return mp.mpf(number.numerator) / number.denominator
