"""Residuals of the constraints, and the condition of G.

A residual is measured along its constraint's gradient: |f_beta| / |df_beta/dq| is, to first order, how far the
coordinates are from the constraint. The largest of them is taken relative to the largest coordinate where that is more
than its nominal size; likewise for the velocities with df/dt, and for the accelerations with J a + c.
"""

from collections.abc import Mapping

import numpy as np

from .constraints.directions import weighted_constraints
from .evaluation import Numbers
from .matrices import Matrices, Vector
from .nominal import Nominal


def residuals(at: Matrices, state: Vector, accelerations: Vector, nominal: Nominal) -> Mapping[str, float]:
    """Residuals of the constraints at a state: ``position``, ``velocity``, ``acceleration``.

    Parameters
    ----------
    at : Matrices
        At the state.
    state : ndarray, shape (2n,)
    accelerations : ndarray, shape (n,)
    nominal : Nominal
        Sizes of the motion's quantities.
    """
    left = at.jacobian @ accelerations + at.curvature
    acceleration = scaled_residual(left, at.jacobian, accelerations, nominal.accelerations)
    found = {**constraint_residuals(at, state, nominal), "acceleration": acceleration}
    return {name: float(residual) for name, residual in found.items()}


def constraint_residuals(at: Matrices, state: Numbers, nominal: Nominal) -> dict[str, Numbers]:
    """Return the first two of them, at one state or, with a last axis more, at k of them."""
    coordinates, velocities = np.split(state, 2)
    return {
        "position": scaled_residual(at.residual, at.jacobian, coordinates, nominal.coordinates),
        "velocity": scaled_residual(at.residual_rate, at.jacobian, velocities, nominal.velocities),
    }


def condition(at: Matrices) -> float:
    """Condition number of G = J A^-1 J^T, each constraint scaled to length one in the mass metric.

    Infinite where constraints depend on one another.

    Raises
    ------
    HolonomError
        A is singular along a direction that the constraints leave free.
    """
    values = weighted_constraints(at.mass, at.jacobian).singular_values()
    with np.errstate(divide="ignore"):
        return float((values.max(initial=1.0) / values.min(initial=np.inf)) ** 2) if values.size else 1.0


def scaled_residual(residual: Numbers, jacobian: Numbers, moved: Numbers, sizes: Numbers) -> Numbers:
    """Return how far the coordinates, or their rates, are from the constraints, relative to the largest of them.

    All of them are taken in terms of their nominal sizes, and none counts as smaller than that.

    Parameters
    ----------
    residual : ndarray, shape (g, ...)
    jacobian : ndarray, shape (g, n, ...)
    moved : ndarray, shape (n, ...)
        What the residual is one of: coordinates, velocities or accelerations.
    sizes : ndarray, shape (n,) or (n, ...)
        Nominal ones of these.

    Returns
    -------
    ndarray, shape (...)
    """
    sizes = sizes if np.ndim(sizes) == moved.ndim else sizes[:, None]
    jacobian, moved = jacobian * sizes, moved / sizes
    gradients = np.max(np.abs(jacobian), axis=1, initial=0.0)
    peaks = np.where(gradients > 0, gradients, 1.0)
    lengths = np.maximum(1.0, np.linalg.norm(jacobian / peaks[:, None], axis=1))
    left = np.max(np.abs(residual) / peaks / lengths, axis=0, initial=0.0)
    return left / np.maximum(1.0, np.max(np.abs(moved), axis=0, initial=0.0))
