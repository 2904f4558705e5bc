"""Radii of convergence of the initial motions of a sweep, from their power series.

The series are expanded in batches.
"""

from typing import Any

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import NDArray

from ..program.arithmetic import run_program
from ..program.heyoka_function import dynamics, heyoka_expressions, import_heyoka
from ..program.motion_problem import MotionProblem, require_expandable
from ..program.rewriting import computing
from ..series.entire import is_entire
from ..series.radius import Radius, estimate_radii
from ..series.singularities import COMPLEX
from ..simulation.inputs import heyoka_inputs, named_inputs

ORDER = 40
ELEMENTS = 8
DETERMINED = 0.05  # relative uncertainty of a radius that is recorded
PROBES = np.array([0.3, 0.7, 1.1, 2.3])  # complex times, by size and direction, where a polynomial is tried
SATISFIED = 1e-9  # of an acceleration there: what is rounding

Floats = NDArray[np.float64]


def batch_radii(problem: MotionProblem, states: Floats, values: Floats) -> Floats:
    """Return the radius of convergence of each motion about its initial time.

    It is infinite where the equations prove that the motion is entire or a polynomial, nan where neither they nor the
    orders determine it to `DETERMINED`.

    Parameters
    ----------
    problem : MotionProblem
        With open parameters, without signs and obstruction.
    states : ndarray, shape (2n, k)
        Initial coordinates and velocities.
    values : ndarray, shape (p, k)
        Open parameters.

    Returns
    -------
    ndarray, shape (k,)
        In the scene's unit of time.
    """
    series = _expanded(problem, states, values)
    finite, radii = np.isfinite(series).all(axis=(0, 1)), np.full(states.shape[1], np.nan)
    expanded_names = {*problem.accelerations, *problem.multipliers}
    constants = (*problem.multipliers, *problem.parameters)
    if is_entire(computing(problem.motion, expanded_names), problem.state, constants):
        return np.where(finite, np.inf, np.nan)
    radii[finite] = [_number(found) for found in estimate_radii(series[:, :, finite])]
    ended = finite & ~series[:, ORDER // 2 :].any(axis=(0, 1))
    radii[ended] = np.where(_solves(problem, series[:, :, ended], values[:, ended]), np.inf, np.nan)
    return radii


def _solves(problem: MotionProblem, series: Floats, values: Floats) -> NDArray[np.bool_]:
    """Return True for polynomials that satisfy the equations at complex times.

    The polynomials have shape (n + g, orders, k).
    """
    n, z = len(problem.coordinates), PROBES * np.exp(1j * PROBES)
    rates = [polynomial.polyder(np.moveaxis(series[:n], 1, 0), order) for order in range(3)]
    paths = [np.moveaxis(polynomial.polyval(z, rate), -1, 1) for rate in rates]
    elements = np.zeros((len(z), series.shape[2]), dtype=complex)
    t, state = float(problem.start["t"]) + z[:, None] + elements, [*paths[0], *paths[1]]
    inputs = named_inputs(problem, t, state, elements, [elements + row for row in values])
    with np.errstate(all="ignore"):
        found = run_program(problem.motion, inputs, COMPLEX)
        accelerations = np.array([found[name] + elements for name in problem.accelerations])
        missed = np.abs(accelerations - paths[2]) <= SATISFIED * (1 + np.abs(paths[2]))
    return missed.all(axis=(0, 1))


def _expanded(problem: MotionProblem, states: Floats, values: Floats) -> Floats:
    """Return power series of the coordinates and multipliers about the initial time.

    Coefficients of t - t0, the constants first, have the shape (n + g, ORDER + 1, k).
    """
    require_expandable(problem)
    integrator = problem.once("expansion", problem.motion, lambda: _expanding(problem))
    k, n, g = states.shape[1], len(problem.coordinates), len(problem.multipliers)
    found = np.empty((n + g, ORDER + 1, k))
    for first in range(0, k, ELEMENTS):
        here = np.minimum(np.arange(first, first + ELEMENTS), k - 1)
        integrator.set_time(float(problem.start["t"]))
        integrator.state[: 2 * n] = states[:, here]
        integrator.state[2 * n :] = 0.0
        integrator.pars[:] = values[: len(integrator.pars), here]
        integrator.step(write_tc=True)
        count = min(ELEMENTS, k - first)
        found[:n, :, first : first + count] = integrator.tc[:n, : ORDER + 1, :count]
        rates = integrator.tc[2 * n :, 1:, :count] * np.arange(1, integrator.tc.shape[1])[:, None]
        found[n:, :, first : first + count] = rates[:, : ORDER + 1]
    return found


def _expanding(problem: MotionProblem) -> Any:
    """Return a batch integrator of the state and the integrals of the multipliers."""
    heyoka = import_heyoka()
    given = heyoka_inputs(problem)
    solved = heyoka_expressions(problem.motion, given)
    integrals = [(heyoka.expression(f"integral of {name}"), solved[name]) for name in problem.multipliers]
    return heyoka.taylor_adaptive_batch(
        [*dynamics(problem.motion, given), *integrals],
        np.zeros((len(problem.state) + len(integrals), ELEMENTS)),
        tol=float(np.exp(-2 * ORDER)),
        compact_mode=True,
    )


def _number(found: Radius) -> float:
    certain = found.estimate is not None and found.uncertainty <= DETERMINED * found.estimate
    return found.estimate if certain else np.nan
