"""Directions of constraints in the mass metric: their rank and near dependence.

With A = L L^T and every row of J scaled to length one, W = L^-1 J^T D holds the constraints' directions as columns.
Its singular values measure their independence (Golub & Van Loan, Matrix Computations, section 5.3).

Where A is not positive definite, A + J^T rho J with a diagonal rho takes its place: under J a = -c, with h - J^T rho c
for h, it has the same accelerations and the same multipliers.
"""

from dataclasses import dataclass

import numpy as np

from ...failures import ErrorKind, HolonomError
from ..matrices import Matrix, Vector

EPSILON = float(np.finfo(float).eps)
DEPENDENT = 1e-12  # singular values of the scaled constraints, relative to the largest, that count as rounding
NEGATIVE = 1e-12  # masses below zero, relative to the largest, that are more than rounding
SINGULAR_MASS = 64 * EPSILON  # reciprocal condition number of A, its diagonal one, below which A counts as singular


@dataclass(frozen=True)
class WeightedConstraints:
    """The constraints' directions in the mass metric.

    Of k states, all arrays have a leading axis of length k.
    """

    factor: Matrix  # shape (n, n): L, the Cholesky factor of the metric
    inverse: Matrix  # shape (n, n): L^-1
    scale: Vector  # shape (g,): D, the factors that bring the columns of W to length one
    directions: Matrix  # shape (n, g): W = L^-1 J^T D
    stiffening: Matrix | None  # shape (n, g): J^T rho where A is not positive definite

    def singular_values(self) -> Vector:
        """Return the singular values of W.

        Returns
        -------
        ndarray, shape (min(n, g),) or (k, min(n, g))
            The largest first.
        """
        return np.linalg.svd(self.directions, compute_uv=False)


def weighted_constraints(mass: Matrix, jacobian: Matrix) -> WeightedConstraints:
    """Put the constraints into the mass metric.

    Parameters
    ----------
    mass : ndarray, shape (n, n) or (k, n, n)
        A, symmetric. Positive definite together with the constraints.
    jacobian : ndarray, shape (g, n) or (k, g, n)
        J. Its rows may be dependent, and of any scale.

    Returns
    -------
    WeightedConstraints

    Raises
    ------
    HolonomError
        A is singular along a direction that the constraints leave free, or it is indefinite and the constraints do not
        make up for it.
    """
    peaks = or_one(np.max(np.abs(jacobian), axis=-1, initial=0.0))
    rows = jacobian / peaks[..., None]
    factors, stiffening = cholesky(mass), None
    if factors is None:
        stiffening = _stiffening(mass, jacobian)
        factors = cholesky(mass + stiffening @ jacobian)
    if factors is None:
        raise not_positive_definite(mass)
    directions = factors[1] @ np.matrix_transpose(rows)
    lengths = or_one(np.sqrt(np.einsum("...sb,...sb->...b", directions, directions)))
    return WeightedConstraints(*factors, 1 / (peaks * lengths), directions / lengths[..., None, :], stiffening)


def _stiffening(mass: Matrix, jacobian: Matrix) -> Matrix:
    """Return J^T rho with masses of the size that A has along each constraint.

    Massless coordinates have those that the constraints give them which contain others, or else the largest.
    """
    sizes, lengths = np.abs(jacobian), np.sqrt(np.abs(np.diagonal(mass, axis1=-2, axis2=-1)))
    while True:
        peaks = _ratios(sizes, lengths[..., None, :]).max(axis=-1, initial=0.0)
        given = np.where(lengths > 0, 0.0, _ratios(sizes, peaks[..., None]).max(axis=-2, initial=0.0))
        if not given.any():
            break
        lengths = lengths + given
    largest = or_one(lengths.max(axis=-1, keepdims=True))
    peaks = np.where(peaks > 0, peaks, or_one(sizes.max(axis=-1, initial=0.0)) / largest)
    return 2 / peaks[..., None, :] ** 2 * np.matrix_transpose(jacobian)


def _ratios(sizes: Matrix, lengths: Matrix) -> Matrix:
    """Return sizes divided by lengths, zero where these are."""
    return np.where(lengths > 0, sizes / or_one(lengths), 0.0)


def rank_of(singular_values: Vector, negligible: float = DEPENDENT) -> int:
    """Return the number of constraints that are independent up to rounding.

    Parameters
    ----------
    singular_values : ndarray
        Of W, the largest first.
    negligible : float
        Singular values that do not count, relative to the largest.

    Returns
    -------
    int
    """
    return int(np.count_nonzero(singular_values > negligible * singular_values.max(initial=0.0)))


def cholesky(metric: Matrix) -> tuple[Matrix, Matrix] | None:
    """Return L, lower triangular, and its inverse, or None if a metric is singular.

    The diagonal of the metric is scaled to one. The last pivot alone does not decide, because the pivots before it can
    first amplify rounding errors.

    Parameters
    ----------
    metric : ndarray, shape (n, n) or (k, n, n)
        Symmetric.

    Returns
    -------
    tuple of ndarray, or None
        Each of the shape of the metric.
    """
    lengths = np.sqrt(or_one(np.diagonal(metric, axis1=-2, axis2=-1)))[..., None]
    scaled = metric / (lengths * np.matrix_transpose(lengths))
    try:
        factor = np.linalg.cholesky(scaled)
        inverse = np.linalg.inv(factor)
    except np.linalg.LinAlgError:
        return None
    squares = scaled, np.matrix_transpose(inverse) @ inverse
    condition = np.prod([np.abs(each).sum(axis=-2).max(axis=-1, initial=0.0) for each in squares], axis=0)
    regular = (condition * SINGULAR_MASS <= 1).all()
    return (lengths * factor, inverse / np.matrix_transpose(lengths)) if regular else None


def is_indefinite(masses: Matrix) -> np.ndarray:
    """Return True for mass matrices that are negative along a direction.

    Parameters
    ----------
    masses : ndarray, shape (n, n, k)
        A of k states.

    Returns
    -------
    ndarray of bool, shape (k,)
    """
    diagonals = np.diagonal(masses)
    negative = (diagonals < 0).any(axis=-1)
    if np.count_nonzero(masses) == np.count_nonzero(diagonals):
        return negative
    return negative | _is_negative(np.moveaxis(np.where(np.isfinite(masses), masses, 0.0), -1, 0))


def _is_negative(mass: Matrix) -> np.ndarray:
    values = np.linalg.eigvalsh(mass)
    return values[..., 0] < -NEGATIVE * np.max(np.abs(values), axis=-1)


def not_positive_definite(mass: Matrix) -> HolonomError:
    """Return the error of a mass matrix that is singular or indefinite.

    Parameters
    ----------
    mass : ndarray, shape (n, n) or (k, n, n)
        A.

    Returns
    -------
    HolonomError
    """
    return HolonomError(ErrorKind.MASS_INDEFINITE if _is_negative(mass).any() else ErrorKind.MASS_SINGULAR)


def or_one(lengths: Vector) -> Vector:
    """Return lengths to divide by, with one in place of zero.

    Parameters
    ----------
    lengths : ndarray
        Not negative, of any shape.

    Returns
    -------
    ndarray
        Of the same shape.
    """
    return np.where(lengths > 0, lengths, 1.0)
