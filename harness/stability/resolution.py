"""Functions of the time between nodes."""

import numpy as np
from numpy.polynomial import legendre

from ..program.table_numbers import TimeFunction
from ..simulation.constraints.directions import or_one
from ..simulation.matrices import Vector
from ..simulation.time_dependence import SAMPLES, time_expressions
from .linear_equations import LinearEquations


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
    through = legendre.legvander(2 * cells - 1, degree) @ np.linalg.inv(legendre.legvander(2 * places - 1, degree))
    nodes, values = (_values(equations, starts[:, None] + length * parts) for parts in (places, cells))
    sizes = np.max(np.abs(values), axis=(1, 2), initial=0.0)
    r = len(equations.controls)
    for order in (1, 2):  # a rate that is less than a control over the duration is rounding
        rates = slice(order * r, (order + 1) * r)
        sizes[rates] = np.maximum(sizes[rates], sizes[:r] / (times[-1] - times[0]) ** order)
    errors = np.mean(np.abs(nodes @ through.T - values), axis=(1, 2))
    return float(np.max(errors / or_one(sizes), initial=0.0))


def _values(equations: LinearEquations, times: Vector) -> Vector:
    """Return the functions of the time, shape (functions, *times), first u, du, ddu."""
    flat, expressions = times.reshape(-1), time_expressions(equations.program)
    rows = [equations.controls_at(flat).reshape(-1, flat.size)]
    if expressions.outputs:
        rows.append(TimeFunction(expressions, ())(flat))
    return np.concatenate(rows).reshape(-1, *times.shape)
