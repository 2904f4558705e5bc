"""Prove that a motion is entire.

Its equations are linear in the state, with entire coefficients. Solutions of such equations are entire (Coddington &
Levinson, Theory of Ordinary Differential Equations, chapter 3, theorem 7.1). The proof follows the degree of each
expression in the state. No identity is used: "no" leaves it open.
"""

from collections.abc import Collection
from enum import IntEnum
from fractions import Fraction

from ..program.arithmetic import Arithmetic, run_program
from ..program.motion_program import Constant, Operation, Program


class Kind(IntEnum):
    """Kinds of functions of the time and the state, each with those before it."""

    CONSTANT = 0
    ENTIRE = 1  # in the time, without the state
    LINEAR = 2  # and inhomogeneous: with coefficients that are entire in the time
    OTHER = 3


def is_entire(program: Program, state: Collection[str], numbers: Collection[str] = ()) -> bool:
    """Return True if all outputs are linear in the state, with entire coefficients.

    Parameters
    ----------
    program : Program
        Accelerations and reactions.
    state : collection of str
        Names of coordinates and velocities.
    numbers : collection of str
        Inputs that are constant.

    Returns
    -------
    bool
    """
    kinds = dict.fromkeys(program.inputs, Kind.OTHER) | {"t": Kind.ENTIRE}
    kinds |= dict.fromkeys(state, Kind.LINEAR) | dict.fromkeys(numbers, Kind.CONSTANT)
    return max(run_program(program, kinds, KINDS).values()) <= Kind.LINEAR


def _product(*factors: Kind) -> Kind:
    return Kind.OTHER if factors.count(Kind.LINEAR) > 1 else max(factors)


def _power(base: Kind, exponent: Fraction) -> Kind:
    if exponent.denominator > 1 or exponent < 0:
        return _of_a_number(base)
    return _product(*[base] * int(exponent)) if exponent else Kind.CONSTANT


def _of_a_number(*arguments: Kind) -> Kind:
    return Kind.OTHER if any(arguments) else Kind.CONSTANT


def _of_the_time(argument: Kind) -> Kind:
    return argument if argument <= Kind.ENTIRE else Kind.OTHER


ENTIRE_FUNCTIONS = (Operation.SIN, Operation.COS, Operation.EXP, Operation.SINH, Operation.COSH, Operation.ERF)
KINDS = Arithmetic(
    number=lambda _: Kind.CONSTANT,
    constants=dict.fromkeys(Constant, Kind.CONSTANT),
    power=_power,
    operations=dict.fromkeys(Operation, _of_a_number)
    | dict.fromkeys(ENTIRE_FUNCTIONS, _of_the_time)
    | {
        Operation.ADD: lambda *terms: max(terms),
        Operation.SUBTRACT: lambda *terms: max(terms),
        Operation.NEGATE: lambda term: term,
        Operation.MULTIPLY: _product,
        Operation.DIVIDE: lambda above, below: Kind.OTHER if below else above,
    },
)
