"""Equations that are the same with either sign of a function, to first order.

Forces such as -c |v| v have a switching function, v, and derivatives where it is zero. There the equations of motion
and their gradients, `LinearEquations.program`, have the same values with either sign. A linearization needs no more:
its eigenvalues decide about stability where the right sides have continuous derivatives (Khalil, Nonlinear Systems,
4.3).
"""

from collections.abc import Mapping
from fractions import Fraction
from itertools import product

import numpy as np

from ..program.motion_program import Call, Expression, Operation, Program
from ..program.numpy_function import NumpyFunction
from ..program.rewriting import with_calls
from ..simulation.matrices import Vector
from .linear_equations import LinearEquations, Point

ON_SURFACE = 1e-6  # of what they are nearby: switching functions, and effects of their signs, that count as zero
MOST_SIGNS = 4  # that are zero together; their combinations are tried


def is_smooth(equations: LinearEquations, point: Point, sizes: Vector) -> bool:
    """Return True if no sign that is zero at a point has an effect to first order.

    Parameters
    ----------
    equations : LinearEquations
    point : Point
        State with accelerations, multipliers and controls.
    sizes : ndarray, shape (2n,)
        Nominal sizes of the state. A function that is small relative to its changes by them counts as zero.

    Returns
    -------
    bool
    """
    zeros = _zero_arguments(equations, point, sizes)
    if not 0 < len(zeros) <= MOST_SIGNS:
        return not zeros
    sides = [
        NumpyFunction(_with_signs(equations.program, dict(zip(zeros, signs, strict=True))))
        for signs in product((1, -1), repeat=len(zeros))
    ]
    inputs = [equations.inputs(each) for each in _here_and_nearby(point, sizes)]
    here, *nearby = (np.ptp([side(each) for side in sides], axis=0) for each in inputs)
    return bool((here <= ON_SURFACE * np.max(nearby, axis=0)).all())


def _here_and_nearby(point: Point, sizes: Vector) -> list[Point]:
    """Return a point, and the points that are a nominal size away in one direction."""
    return [point, *(point._replace(state=point.state + move) for move in np.diag(sizes))]


def _zero_arguments(equations: LinearEquations, point: Point, sizes: Vector) -> list[Expression]:
    """Return the functions in the equations whose signs are zero."""
    functions, evaluate = equations.signed_functions
    if not functions:
        return []
    here, *nearby = (np.array(evaluate(equations.inputs(each))) for each in _here_and_nearby(point, sizes))
    away = np.abs(here) > ON_SURFACE * np.max(np.abs(np.subtract(nearby, here)), axis=0)
    return [each for each, is_away in zip(functions, away, strict=True) if not is_away]


def _with_signs(program: Program, signs: Mapping[Expression, int]) -> Program:
    """Return a program with numbers for the signs of some functions."""
    known: dict[Call, Expression] = {}
    for function, sign in signs.items():
        known[Call(Operation.SIGN, (function,))] = Fraction(sign)
        known[Call(Operation.ABS, (function,))] = Call(Operation.MULTIPLY, (Fraction(sign), function))
    return with_calls(program, known)
