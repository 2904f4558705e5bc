"""Time events: zeros of switching functions of time alone, such as t - 3.

The points of a table and the bounds of a piecewise law are such functions, of the form a + b t with rational numbers.
Their zeros are known exactly before a motion begins, so that steps end on them without a search.
"""

from collections.abc import Mapping
from fractions import Fraction
from functools import reduce
from operator import add
from typing import NamedTuple

from ..program.arithmetic import Arithmetic, run_program
from ..program.motion_problem import DependsOn, MotionProblem
from ..program.motion_program import Constant, Operation, Program, names_used
from ..program.rewriting import computing
from ..program.sign_pattern import program_with_values


class TimeEvent(NamedTuple):
    """The zero of a switching function of the time."""

    t: Fraction
    to: int  # the function's sign from then on; before, it is the opposite


class Affine(NamedTuple):
    """a + b t."""

    a: Fraction
    b: Fraction


class _Otherwise(ArithmeticError):
    """The function is of another form."""


def time_events(problem: MotionProblem) -> Mapping[str, TimeEvent]:
    """Return the changes of signs that a function a + b t decides.

    Parameters
    ----------
    problem : MotionProblem
        The motion.

    Returns
    -------
    dict of str to TimeEvent
        By the sign's name.
    """
    found = {}
    for index, sign in enumerate(problem.signs, start=1):
        if sign.by is DependsOn.TIME:
            function = _affine(program_with_values(problem, computing(problem.switching, {f"switch[{index}]"})))
            if function is not None and function.b:
                found[sign.name] = TimeEvent(-function.a / function.b, 1 if function.b > 0 else -1)
    return found


def _affine(program: Program) -> Affine | None:
    """Return the one output of a program as an affine function of t, or None."""
    if names_used(program) & set(program.inputs) - {"t"}:
        return None
    try:
        (value,) = run_program(program, {"t": Affine(Fraction(0), Fraction(1))}, AFFINE).values()
    except _Otherwise:
        return None
    return value


def _constant(value: Fraction) -> Affine:
    return Affine(value, Fraction(0))


def _plus(*terms: Affine) -> Affine:
    return Affine(*(reduce(add, parts) for parts in zip(*terms, strict=True)))


def _scaled(factor: Fraction, function: Affine) -> Affine:
    return Affine(factor * function.a, factor * function.b)


def _product(first: Affine, *others: Affine) -> Affine:
    return reduce(_times, others, first)


def _times(first: Affine, second: Affine) -> Affine:
    if second.b and first.b:
        raise _Otherwise
    return _scaled(second.a, first) if not second.b else _scaled(first.a, second)


def _quotient(first: Affine, second: Affine) -> Affine:
    if second.b or not second.a:
        raise _Otherwise
    return _scaled(1 / second.a, first)


def _refused(*_: Affine | Fraction) -> Affine:
    raise _Otherwise


class _NoConstants(dict):
    """Mapping that rejects the constants pi and e, which are not fractions."""

    def __missing__(self, constant: Constant) -> Affine:
        raise _Otherwise


AFFINE = Arithmetic(
    number=_constant,
    constants=_NoConstants(),
    power=_refused,
    operations=dict.fromkeys(Operation, _refused)
    | {
        Operation.ADD: _plus,
        Operation.SUBTRACT: lambda a, b: _plus(a, _scaled(Fraction(-1), b)),
        Operation.NEGATE: lambda a: _scaled(Fraction(-1), a),
        Operation.MULTIPLY: _product,
        Operation.DIVIDE: _quotient,
    },
)
