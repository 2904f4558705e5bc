"""Residuals of the constraints, and the condition of G.

A residual is measured along its constraint's gradient: |f_beta| / |df_beta/dq| is, to first order, how far the
coordinates are from the constraint. The largest of them is taken relative to the largest coordinate where that is more
than its nominal size. Likewise for the velocities with df/dt, and for the accelerations with J a + c.
"""

from collections.abc import Mapping

import numpy as np

from .constraints.directions import or_one, weighted_constraints
from .evaluation import Numbers
from .matrices import Matrices, Vector
from .nominal import Nominal


def residuals(at: Matrices, state: Vector, accelerations: Vector, nominal: Nominal) -> Mapping[str, float]:
    """Return the residuals of the constraints at a state, by name.

    The names are ``position``, ``velocity`` and ``acceleration``.

    Parameters
    ----------
    at : Matrices
        Matrices at the state.
    state : ndarray, shape (2n,)
        Coordinates, then velocities.
    accelerations : ndarray, shape (n,)
        Accelerations at the state.
    nominal : Nominal
        Sizes of the motion's quantities.

    Returns
    -------
    dict of str to float
        Dimensionless.
    """
    left = at.jacobian @ accelerations + at.curvature
    acceleration = scaled_residual(left, at.jacobian, accelerations, nominal.accelerations)
    found = {**constraint_residuals(at, state, nominal), "acceleration": acceleration}
    return {name: float(residual) for name, residual in found.items()}


def constraint_residuals(at: Matrices, state: Numbers, nominal: Nominal) -> dict[str, Numbers]:
    """Return the residuals of position and velocity.

    Parameters
    ----------
    at : Matrices
        Matrices at the state.
    state : ndarray, shape (2n,) or (2n, k)
        Coordinates, then velocities.
    nominal : Nominal
        Sizes of the motion's quantities.

    Returns
    -------
    dict of str to ndarray, shape () or (k,)
        ``position`` and ``velocity``, dimensionless.
    """
    coordinates, velocities = np.split(state, 2)
    return {
        "position": scaled_residual(at.residual, at.jacobian, coordinates, nominal.coordinates),
        "velocity": scaled_residual(at.residual_rate, at.jacobian, velocities, nominal.velocities),
    }


def condition(at: Matrices) -> float:
    """Return the condition number of G = J A^-1 J^T.

    Each constraint is scaled to length one in the mass metric.

    Parameters
    ----------
    at : Matrices
        Matrices at a state.

    Returns
    -------
    float
        Infinite for dependent constraints.

    Raises
    ------
    HolonomError
        A is singular along a direction that the constraints leave free.
    """
    values = weighted_constraints(at.mass, at.jacobian).singular_values()
    with np.errstate(divide="ignore"):
        return float((values.max(initial=1.0) / values.min(initial=np.inf)) ** 2) if values.size else 1.0


def scaled_residual(residual: Numbers, jacobian: Numbers, moved: Numbers, sizes: Numbers) -> Numbers:
    """Return the distance of coordinates or velocities from the constraints.

    It is relative to the largest of them, in terms of their nominal sizes. None counts as smaller than its nominal
    size.

    Parameters
    ----------
    residual : ndarray, shape (g, ...)
        Residual of each constraint.
    jacobian : ndarray, shape (g, n, ...)
        J.
    moved : ndarray, shape (n, ...)
        The coordinates, velocities or accelerations to which the residual belongs.
    sizes : ndarray, shape (n,) or (n, ...)
        Their nominal sizes.

    Returns
    -------
    ndarray, shape (...)
        Dimensionless.
    """
    sizes = sizes if np.ndim(sizes) == moved.ndim else sizes[:, None]
    jacobian, moved = jacobian * sizes, moved / sizes
    gradients = np.max(np.abs(jacobian), axis=1, initial=0.0)
    peaks = or_one(gradients)
    lengths = np.maximum(1.0, np.linalg.norm(jacobian / peaks[:, None], axis=1))
    left = np.max(np.abs(residual) / peaks / lengths, axis=0, initial=0.0)
    return left / np.maximum(1.0, np.max(np.abs(moved), axis=0, initial=0.0))
