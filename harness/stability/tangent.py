"""The tangent space of the constraint manifold at a state.

Its coordinates are orthonormal in the mass metric.
"""

from copy import copy
from functools import cached_property

import numpy as np
import scipy.linalg

from ..simulation.constraints.directions import cholesky, not_positive_definite, or_one
from ..simulation.matrices import Matrix, Vector

DEPENDENT = 1e-9  # singular values of the scaled constraints, relative to the largest, that count as zero


class Tangent:
    """The solutions of J x = 0, and of linear equations of motion.

    The former are x = N xi with N^T A N = 1. Of all such N, one is chosen for the m most independent coordinates,
    each scaled by the root of its mass: as functions of xi they have a symmetric positive definite matrix. If these
    are masses on lines, N gives each of them its own xi.

    Parameters
    ----------
    mass : ndarray, shape (n, n)
        A, which may be singular if the constraints make the system regular.
    jacobian : ndarray, shape (g, n)
        J, whose rows may depend on one another.
    masses : ndarray, shape (n,)
        A_ii near the state. What vanishes in the state alone is rounding there.
    reactions : ndarray, shape (n, f), or None
        Directions of the forces that satisfy the constraints, if they are other than J^T: those of controls.

    Attributes
    ----------
    rank : int
        Rank of J.
    least : float
        Least of the counted singular values over the largest: the distance from a singular configuration.
    basis : ndarray, shape (n, m)
        N.
    leading : tuple of int
        Indices of the m coordinates.

    Raises
    ------
    HolonomError
        A is singular along a direction that the constraints leave free.

    Examples
    --------
    >>> tangent = Tangent(np.diag([4.0, 1.0]), np.array([[0.0, 1.0]]), np.ones(2))
    >>> tangent.basis.tolist(), tangent.leading
    ([[0.5], [0.0]], (0,))
    """

    def __init__(self, mass: Matrix, jacobian: Matrix, masses: Vector, reactions: Matrix | None = None) -> None:
        self._mass, self._jacobian, self._reactions = mass, jacobian, reactions
        self._roots = or_one(np.sqrt(np.fmax(np.abs(mass.diagonal()), np.abs(masses))))
        self._lengths = or_one(np.linalg.norm(jacobian / self._roots, axis=1))
        _, values, directions = np.linalg.svd(self._directions)
        self.rank = int(np.count_nonzero(values > DEPENDENT * values.max(initial=0.0)))
        self.least = float(values[self.rank - 1] / values[0]) if self.rank else 1.0
        free = _orthonormal(directions[self.rank :].T / self._roots[:, None], mass)
        moved = self._roots[:, None] * free
        _, _, order = scipy.linalg.qr(moved.T, mode="economic", pivoting=True)
        self.leading = tuple(sorted(map(int, order[: free.shape[1]])))
        left, _, right = np.linalg.svd(moved[list(self.leading)])
        self.basis = free @ (left @ right).T

    def next_to(self, basis: Matrix) -> "Tangent":
        """Return the tangent space with the basis nearest to a given basis.

        Nearest in the mass metric.

        Parameters
        ----------
        basis : ndarray, shape (n, m)

        Returns
        -------
        Tangent
        """
        turned = copy(self)
        left, _, right = np.linalg.svd(self.basis.T @ self._mass @ basis)
        turned.basis = self.basis @ (left @ right)
        return turned

    def shortest(self, constrained: Matrix) -> Matrix:
        """Return the solution x of J x = b that is orthogonal to N in the mass metric.

        Parameters
        ----------
        constrained : ndarray, shape (g, k)
            b.

        Returns
        -------
        ndarray, shape (n, k)
        """
        x = self._inverse @ constrained
        x = x - self.basis @ (self.basis.T @ (self._mass @ x))
        return x + self._inverse @ (constrained - self._jacobian @ x)  # rounding errors of light coordinates

    def solve(self, force: Matrix, constrained: Matrix) -> tuple[Matrix, Matrix]:
        """Return x and mu of A x - R mu = F, J x = b, where R are the reactions.

        If they depend on one another, mu is the shortest solution.

        Parameters
        ----------
        force : ndarray, shape (n, k)
            F.
        constrained : ndarray, shape (g, k)
            b.

        Returns
        -------
        x : ndarray, shape (n, k)
        mu : ndarray, shape (f, k), or (g, k) without other reactions
        """
        x = self.shortest(constrained)
        if self._reactions is None:
            x = x + self.basis @ (self.basis.T @ force)
            return x, self._inverse.T @ (self._mass @ x - force)
        moved, forces = np.split(self._pushed @ (force - self._mass @ x), [self.basis.shape[1]])
        return x + self.basis @ moved, forces

    @cached_property
    def determined(self) -> bool:
        """True if the reactions are sufficient and independent."""
        return self._reactions is None or np.linalg.matrix_rank(self._scaled[0], DEPENDENT) == self._scaled[0].shape[1]

    @cached_property
    def _pushed(self) -> Matrix:
        """Return the inverse of [A N, -R], which may have more rows than columns."""
        matrix, rows, columns = self._scaled
        return np.linalg.pinv(matrix, rcond=DEPENDENT) / columns[:, None] * rows

    @cached_property
    def _scaled(self) -> tuple[Matrix, Vector, Vector]:
        """Return [A N, -R] in scaled units, with the factors of rows and columns."""
        rows = 1 / self._roots
        matrix = rows[:, None] * np.hstack([self._mass @ self.basis, -self._reactions])
        columns: Vector = or_one(np.linalg.norm(matrix, axis=0))
        return matrix / columns, rows, columns

    def sizes_of_multipliers(self, force: Matrix, constrained: Matrix) -> Matrix:
        """Return the sizes of the terms that mu of `solve` is the sum of.

        Parameters
        ----------
        force : ndarray, shape (n, ...)
            Sizes of the terms of F, not negative.
        constrained : ndarray, shape (g, ...)
            Sizes of the terms of b, not negative.

        Returns
        -------
        ndarray, shape (g, ...)
        """
        inverse = np.abs(self._inverse)
        return inverse.T @ (np.abs(self._mass) @ (inverse @ constrained) + force)

    @cached_property
    def _inverse(self) -> Matrix:
        """Return the inverse of J, with lengths in units of the roots of the masses."""
        return np.linalg.pinv(self._directions, rcond=DEPENDENT) / self._roots[:, None] / self._lengths

    @property
    def _directions(self) -> Matrix:
        return self._jacobian / self._roots / self._lengths[:, None]


def _orthonormal(basis: Matrix, mass: Matrix) -> Matrix:
    """Return a basis of the same space, orthonormal in the mass metric."""
    factors = cholesky(basis.T @ mass @ basis)
    if factors is None:
        raise not_positive_definite(mass)
    return basis @ factors[1].T
