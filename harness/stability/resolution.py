"""Functions of the time, and of a motion, between nodes."""

from collections.abc import Iterator

import numpy as np
from numpy.polynomial import legendre

from ..program.motion_problem import MotionProblem
from ..program.table_numbers import TimeFunction
from ..simulation.constraints.directions import or_one
from ..simulation.matrices import Matrix, Vector
from ..simulation.nominal import nominal_of
from ..simulation.time_dependence import SAMPLES, time_expressions
from .linear_equations import ROWS, LinearEquations, Point

TOGETHER = 512  # times at which equations are evaluated together


def unresolved(equations: LinearEquations, times: Vector, degree: int) -> float:
    """Return the mean error of polynomials for the functions of the time.

    It is relative to each function's largest value. A frequency of the nodes, or a pulse between them, is met.

    Parameters
    ----------
    equations : LinearEquations
        Equations with these functions and the controls' law.
    times : ndarray, shape (k,)
        Equidistant nodes, in blocks that share those at their ends.
    degree : int
        Degree of the polynomials, the number of steps of a block.

    Returns
    -------
    float
    """
    if times[0] == times[-1]:
        return 0.0
    starts, length = times[:-1:degree], degree * (times[1] - times[0])
    count = max(2 * degree, SAMPLES // len(starts))
    cells = (np.arange(count) + 0.5) / count
    places = np.arange(degree + 1) / degree
    nodes, values = (_values(equations, starts[:, None] + length * parts) for parts in (places, cells))
    sizes = np.max(np.abs(values), axis=(1, 2), initial=0.0)
    r = len(equations.controls)
    for order in (1, 2):  # what is less than a control over the duration is rounding
        rates = slice(order * r, (order + 1) * r)
        sizes[rates] = np.maximum(sizes[rates], sizes[:r] / (times[-1] - times[0]) ** order)
    return _largest_error(nodes, values, cells, sizes)


def unresolved_motion(
    problem: MotionProblem, equations: LinearEquations, times: Vector, states: Matrix, degree: int, parts: int
) -> float:
    """Return the mean error of polynomials for gradients along a motion.

    They are those of the equations. It is relative to the largest one of each.

    Parameters
    ----------
    problem, equations : MotionProblem, LinearEquations
        The motion.
    times : ndarray, shape (k,)
        Equidistant times.
    states : ndarray, shape (2n, k)
        Coordinates and velocities.
    degree : int
        Degree of the polynomials, the number of steps of a block.
    parts : int
        Parts of a step, at whose ends the times are.

    Returns
    -------
    float
    """
    count = degree * parts
    places = np.arange(0, len(times) - 1, count)[:, None] + np.arange(count + 1)
    gradients = np.concatenate(list(_gradients(problem, equations, times, states)), axis=2)
    sizes = np.repeat(np.max(np.abs(gradients), axis=(1, 2), initial=0.0), gradients.shape[1])
    values = gradients.reshape(-1, len(times))[:, places]
    return _largest_error(values[:, :, ::parts], values, np.arange(count + 1) / count, sizes)


def _gradients(problem: MotionProblem, equations: LinearEquations, times: Vector, states: Matrix) -> Iterator[Matrix]:
    """Yield slopes of each row in directions of q, v and a, shape (rows, 3, times).

    The directions are random. Accelerations and multipliers are random numbers.
    """
    nominal, random = nominal_of(problem), np.random.default_rng(0)
    sizes = {"q": nominal.coordinates, "v": nominal.velocities, "a": nominal.accelerations}
    directions = {group: size * random.uniform(0.5, 1.5, size.shape) for group, size in sizes.items()}
    multipliers = random.normal(size=(len(equations.multipliers), 1))
    controls = equations.controls_at(times).reshape(-1, len(times))
    for first in range(0, len(times), TOGETHER):
        at = slice(first, first + TOGETHER)
        one = np.ones((1, len(times[at])))
        found = np.zeros((len(equations.found) + equations.drives, one.size))
        accelerations = directions["a"][:, None] * one
        point = Point(times[at], states[:, at], accelerations, multipliers * one, controls[:, at], found)
        here = equations.at(point, problem.independent)
        yield np.concatenate([
            np.stack([np.einsum("ijk,j->ik", here[f"{row}_by_{group}"], x) for group, x in directions.items()], axis=1)
            for row in ROWS[:-1]
        ])  # fmt: skip


def _largest_error(nodes: Matrix, values: Matrix, cells: Vector, sizes: Vector) -> float:
    """Return the largest mean error of polynomials through nodes, relative to sizes.

    Both have the shape (functions, blocks, places), and the values are at the cells of each block.
    """
    degree = nodes.shape[2] - 1
    through = legendre.legvander(2 * cells - 1, degree) @ np.linalg.inv(
        legendre.legvander(np.linspace(-1, 1, degree + 1), degree)
    )
    errors = np.mean(np.abs(nodes @ through.T - values), axis=(1, 2))
    return float(np.max(errors / or_one(sizes), initial=0.0))


def _values(equations: LinearEquations, times: Vector) -> Vector:
    """Return the functions of the time, shape (functions, *times), first u, du, ddu."""
    flat, expressions = times.reshape(-1), time_expressions(equations.program)
    rows = [equations.controls_at(flat).reshape(-1, flat.size)]
    if expressions.outputs:
        rows.append(TimeFunction(expressions, ())(flat))
    return np.concatenate(rows).reshape(-1, *times.shape)
