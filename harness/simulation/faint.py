"""Functions of the state that are faint nearly everywhere, and strong in a narrow place.

An exponential is so small away from there, or so near to its limit, that rounding swallows it, and a high power is no
better. What they do shows neither at a few states, however chosen, nor at the beginning of a step.
"""

from collections.abc import Collection, Iterator
from fractions import Fraction

from ..program.motion_program import Call, Expression, Operation, Program, names_in

FAINT = frozenset({Operation.EXP, Operation.SINH, Operation.COSH, Operation.TANH, Operation.ERF})
HIGH = 16  # exponents from which a power is as faint as an exponential


def may_hide(program: Program, parameters: Collection[str] = ()) -> bool:
    """Whether a program contains such a function of the state.

    Parameters
    ----------
    program : Program
        One of its inputs is ``t``; the others are the state, and parameters.
    parameters : collection of str
        Which inputs are.
    """
    moving = set(program.inputs) - {"t", *parameters}
    for name, expression in program.assignments:
        if any(_is_faint(call) and names_in(call) & moving for call in _calls(expression)):
            return True
        if names_in(expression) & moving:
            moving.add(name)
    return False


def _calls(expression: Expression) -> Iterator[Call]:
    if isinstance(expression, Call):
        yield expression
        for argument in expression.arguments:
            yield from _calls(argument)


def _is_faint(call: Call) -> bool:
    if call.operation is not Operation.POWER:
        return call.operation in FAINT
    exponent = call.arguments[1]
    return not isinstance(exponent, Fraction) or abs(exponent) >= HIGH
