"""Time events: zeros of switching functions of time alone, such as t - 3.

The points of a table and the bounds of a piecewise law are such functions, of the form a + b t with rational numbers.
Their zeros are known exactly before a motion begins, so that steps end on them without a search.
"""

from collections.abc import Mapping
from fractions import Fraction
from math import inf, nan, prod
from operator import neg, sub
from typing import NamedTuple

from ..program.arithmetic import Arithmetic, run_program
from ..program.motion_problem import DependsOn, MotionProblem
from ..program.motion_program import Constant, Operation, Program, names_used
from ..program.rewriting import computing
from ..program.sign_pattern import program_with_values

# Degrees of polynomials in the time, infinite where an expression is none
DEGREE = Arithmetic(
    number=lambda _: 0,
    constants=dict.fromkeys(Constant, 0),
    power=lambda base, exponent: base * exponent if exponent.denominator == 1 and exponent > 0 else base and inf,
    operations=dict.fromkeys(Operation, lambda *degrees: inf if any(degrees) else 0)
    | {
        Operation.ADD: lambda *degrees: max(degrees),
        Operation.SUBTRACT: max,
        Operation.NEGATE: lambda degree: degree,
        Operation.MULTIPLY: lambda *degrees: sum(degrees),
        Operation.DIVIDE: lambda above, below: inf if below else above,
    },
)
# Rational numbers, nan where an expression may be none
RATIONAL = Arithmetic(
    number=Fraction,
    constants=dict.fromkeys(Constant, nan),
    power=lambda *_: nan,
    operations=dict.fromkeys(Operation, lambda *_: nan)
    | {
        Operation.ADD: lambda *terms: sum(terms),
        Operation.SUBTRACT: sub,
        Operation.NEGATE: neg,
        Operation.MULTIPLY: lambda *factors: prod(factors),
        Operation.DIVIDE: lambda above, below: above / below if below else nan,
    },
)


LATER = (Fraction(1, 10**6), Fraction(3, 10), Fraction(7, 10))  # parts of a time at which a function is looked at


class TimeEvent(NamedTuple):
    """The zero of a switching function of the time."""

    t: Fraction
    to: int  # the function's sign from then on; before, it is the opposite


class _Affine(NamedTuple):
    """a + b t."""

    a: Fraction
    b: Fraction


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


def remains_zero(problem: MotionProblem, function: Program, start: Fraction, end: Fraction) -> bool:
    """Return True if a function of the time is exactly zero at several times.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    function : Program
        One of its functions. It may contain the open parameters.
    start, end : Fraction
        Times between which it is looked at.

    Returns
    -------
    bool
        False where it is made of other functions than polynomials.
    """
    program = program_with_values(problem, function)
    if not _is_of_time(program):
        return False
    times = (start + part * (end - start) for part in LATER)
    return all(value == 0 for t in times for value in run_program(program, {"t": t}, RATIONAL).values())


def _is_of_time(program: Program) -> bool:
    return not names_used(program) & set(program.inputs) - {"t"}


def _affine(program: Program) -> _Affine | None:
    """Return the one output of a program as an affine function of t, or None."""
    if not _is_of_time(program):
        return None
    (degree,) = run_program(program, {"t": 1}, DEGREE).values()
    begun, later = (value for t in (0, 1) for value in run_program(program, {"t": Fraction(t)}, RATIONAL).values())
    return _Affine(begun, later - begun) if degree <= 1 and isinstance(later - begun, Fraction) else None
