"""Equations that are the same with either sign of a function, to first order.

Forces such as -c |v| v have a switching function, v, and derivatives where it is zero. There the equations of motion
and their gradients, `LinearEquations.program`, have the same values with either sign. A linearization needs no more:
its eigenvalues decide about stability where the right sides have continuous derivatives (Khalil, Nonlinear Systems,
4.3).

The drag -c |v| v in a plane has a gradient, -c (|v| + v v^T/|v|), that is zero by zero at rest, and has the limit zero.
A continuous function whose gradients around a point have a limit there has this gradient at the point, by the mean
value theorem. The limit is that of random points nearby.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ..program.motion_program import Call, Expression, Name, Operation, Program, calls_of
from ..program.numpy_function import NumpyFunction
from ..program.rewriting import ZERO, untaken, with_calls
from ..simulation.matrices import Vector
from .linear_equations import LinearEquations, Point

ON_SURFACE = 1e-6  # of what they are nearby: switching functions, and effects of their signs, that count as zero
MOST_SIGNS = 4  # that are zero together; their combinations are tried
NEAR = 1e-8  # nominal sizes to points at which a gradient differs from its limit by less than ON_SURFACE
WAYS = 16  # to points nearby
ROUNDED = 16 * np.finfo(float).eps  # of a gradient
NO_VALUE = Call(Operation.SQRT, (Fraction(-1),))


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
    equations = with_limits(equations, [point], sizes)
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


def with_limits(equations: LinearEquations, points: Sequence[Point], sizes: Vector) -> LinearEquations:
    """Return equations with limits where they divide by zero.

    Parameters
    ----------
    equations : LinearEquations
    points : sequence of Point
        Divisors that are zero at all of them are looked at.
    sizes : ndarray, shape (2n,)
        Nominal sizes of the state.

    Returns
    -------
    LinearEquations
        Its rows have no value if they have no limit at one of the points.
    """
    poles = _poles(equations, points)
    if not poles:
        return equations
    limits = with_calls(equations.program, dict.fromkeys(poles, ZERO))
    limited = replace(equations, program=limits)
    found = np.all([_has_limits(equations, limited, each, sizes) for each in points], axis=0)
    values = zip(limits.outputs.items(), found, strict=True)
    undefined = untaken("undefined", [*limits.inputs, *dict(limits.assignments)])
    outputs = {name: value if exists else Name(undefined) for (name, value), exists in values}
    assignments = (undefined, NO_VALUE), *limits.assignments
    return replace(equations, program=replace(limits, assignments=assignments, outputs=outputs))


def _has_limits(equations: LinearEquations, limited: LinearEquations, point: Point, sizes: Vector) -> NDArray[np.bool_]:
    """Return True for rows whose values in the second are limits in the first."""
    ways = np.random.default_rng(0).normal(size=(WAYS, sizes.size)) * sizes
    moved = (point._replace(state=point.state + scale * way) for scale in (NEAR, 1.0) for way in ways)
    here, limit = (each.rows(point) for each in (equations, limited))
    near, far = np.split(np.array([equations.rows(each) for each in moved]), 2)
    apart, change = (np.abs(each - limit) for each in (near, far))
    largest = np.max(np.where(np.isfinite(change), np.maximum(ON_SURFACE * change, ROUNDED * np.abs(far)), 0.0), axis=0)
    return np.where(np.isfinite(here), here == limit, np.max(apart, axis=0) <= largest)


def _poles(equations: LinearEquations, points: Sequence[Point]) -> list[Expression]:
    """Return the quotients and powers with divisors that are zero at all points."""
    divisors: dict[Expression, Expression] = {}
    for call in calls_of(equations.program):
        match call:
            case Call(Operation.DIVIDE, (_, divisor)):
                divisors[call] = divisor
            case Call(Operation.POWER, (base, Fraction() as exponent)) if exponent < 0:
                divisors[call] = base
    if not divisors:
        return []
    evaluate = equations.evaluating(divisors.values())
    zero = np.all([evaluate(equations.inputs(each)) == 0 for each in points], axis=0)
    return [call for call, is_zero in zip(divisors, zero, strict=True) if is_zero]


def _zero_arguments(equations: LinearEquations, point: Point, sizes: Vector) -> list[Expression]:
    """Return the functions in the equations whose signs are zero."""
    functions, evaluate = equations.signed_functions
    if not functions:
        return []
    here, *nearby = (evaluate(equations.inputs(each)) for each in _here_and_nearby(point, sizes))
    away = np.abs(here) > ON_SURFACE * np.max(np.abs(np.subtract(nearby, here)), axis=0)
    return [each for each, is_away in zip(functions, away, strict=True) if not is_away]


def _with_signs(program: Program, signs: Mapping[Expression, int]) -> Program:
    """Return a program with numbers for the signs of some functions."""
    known: dict[Call, Expression] = {}
    for function, sign in signs.items():
        known[Call(Operation.SIGN, (function,))] = Fraction(sign)
        known[Call(Operation.ABS, (function,))] = Call(Operation.MULTIPLY, (Fraction(sign), function))
    return with_calls(program, known)
