"""Factorization of A a - J^T lambda = h and J a = -c at a state, with pivots.

Bad scales of masses and constraints, and dependent constraints, are allowed. G = J A^-1 J^T is never formed: near a
singular configuration the accelerations retain about half of the digits that it would lose.

If all constraints count as independent, the equations are one sparse system. With S the inverse roots of the masses on
A's diagonal, D the scale that brings the rows of J S to length one, and a small alpha,

    | alpha S A S  (D J S)^T |   |     S^-1 a         |     | alpha S h |
    | D J S            0     |   | -alpha D^-1 lambda |  =  |   - D c   |

is symmetric, and its condition number grows no faster than that of D J S while alpha is small relative to the latter's
singular values (Arioli, Duff & de Rijk, On the augmented system approach to sparse least-squares problems, 1989).
SuperLU factors it with partial pivoting. Its cost grows like the fill, linearly along a chain of bodies. A step or two
of refinement reduce the error to a rounding in each nonzero entry (Skeel, Iterative refinement implies numerical
stability for Gaussian elimination, 1980).

If some are dependent, a singular value decomposition of the constraints' directions W drops the vanishing ones (Golub &
Van Loan, Matrix Computations, sections 5.3 and 6.1). An orthonormal basis Q of their span splits every acceleration L^T
a in two: along Q it is determined by the constraints, across Q by the forces. It costs O(n^3) operations for n
coordinates.
"""

from abc import ABC, abstractmethod
from math import prod
from typing import Any

import numpy as np

from ..matrices import Matrix, Vector
from .directions import EPSILON, or_one, rank_of, weighted_constraints

ALPHA = 2.0**-10
REFINEMENTS = 5
CONTRACTION = 0.5  # smallest ratio of a change to the last one at which the iteration does not converge
ROUNDING = 4 * EPSILON  # relative change of the accelerations that is none


class FactoredConstraints(ABC):
    """The factored equations of motion at a state, or at several states.

    For several states, all arrays have a leading axis. Methods take and return forces and accelerations of shape (n,).
    Residuals, curvatures c and multipliers are of shape (g,).
    """

    @abstractmethod
    def length(self, change: Vector) -> Vector:
        """Return the length of a change, each component weighted with its mass.

        Parameters
        ----------
        change : ndarray, shape (n,)
            Of coordinates or velocities.

        Returns
        -------
        float
        """

    @abstractmethod
    def distances(self, residual: Vector) -> Vector:
        """Return the distance from each constraint in the mass metric, to first order.

        Parameters
        ----------
        residual : ndarray, shape (g,)
            f or df/dt.

        Returns
        -------
        ndarray, shape (g,)
        """

    def accelerations(self, force: Vector, curvature: Vector) -> Vector:
        """Return a of A a - J^T lambda = h, J a = -c.

        Parameters
        ----------
        force : ndarray, shape (n,)
            h.
        curvature : ndarray, shape (g,)
            c.

        Returns
        -------
        ndarray, shape (n,)
        """
        return self.unknowns(force, curvature)[0]

    @abstractmethod
    def correction(self, residual: Vector) -> Vector:
        """Return the least change d in the mass metric with J d = -residual, by one solve.

        Parameters
        ----------
        residual : ndarray, shape (g,)
            f or df/dt.

        Returns
        -------
        ndarray, shape (n,)
        """

    @abstractmethod
    def unknowns(self, force: Vector, curvature: Vector) -> tuple[Vector, Vector]:
        """Return a and the least multipliers of A a - J^T lambda = h, J a = -c.

        Parameters
        ----------
        force : ndarray, shape (n,)
            h.
        curvature : ndarray, shape (g,)
            c.

        Returns
        -------
        accelerations : ndarray, shape (n,)
        multipliers : ndarray, shape (g,)
        """


class IndependentConstraints(FactoredConstraints):
    """Independent constraints, factored as a sparse system.

    The systems of several states are one uncoupled system. Arguments as `factored_constraints`.
    """

    def __init__(self, mass: Matrix, jacobian: Matrix) -> None:
        self._mass, self._jacobian = mass, jacobian
        masses = np.abs(np.diagonal(mass, axis1=-2, axis2=-1))
        self._roots = np.sqrt(np.where(masses > 0, masses, or_one(np.max(masses, axis=-1, keepdims=True))))
        directions = jacobian / self._roots[..., None, :]
        peaks = or_one(np.max(np.abs(directions), axis=-1, initial=0.0))
        directions /= peaks[..., None]
        lengths = or_one(np.linalg.norm(directions, axis=-1))
        self._scale = 1 / (peaks * lengths)
        directions /= lengths[..., None]
        k = prod(mass.shape[:-2])
        self._factors = self._factored(
            *(each.reshape(k, *each.shape[mass.ndim - 2 :]) for each in (mass, self._roots, directions))
        )

    def length(self, change: Vector) -> Vector:
        """Return the length by A's diagonal (see `FactoredConstraints.length`)."""
        return np.linalg.norm(self._roots * change, axis=-1)

    def distances(self, residual: Vector) -> Vector:
        """Return distances by A's diagonal (see `FactoredConstraints.distances`)."""
        return np.abs(self._scale * residual)

    def correction(self, residual: Vector) -> Vector:
        """Return the change, unrefined (see `FactoredConstraints.correction`)."""
        return self._solved(np.zeros_like(self._roots), residual)[0]

    def unknowns(self, force: Vector, curvature: Vector) -> tuple[Vector, Vector]:
        """Return the unknowns, refined to rounding (see `FactoredConstraints.unknowns`)."""
        accelerations, multipliers = self._solved(force, curvature)
        last, open_ = np.inf, True
        for _ in range(REFINEMENTS):
            missed = force - np.matvec(self._mass, accelerations) + np.vecmat(multipliers, self._jacobian)
            change, further = self._solved(missed, curvature + np.matvec(self._jacobian, accelerations))
            size = self.length(change) / or_one(self.length(accelerations))
            open_ = open_ & (size <= CONTRACTION * last)
            if not np.any(open_):
                break
            chosen = np.asarray(open_)[..., None]
            accelerations = np.where(chosen, accelerations + change, accelerations)
            multipliers = np.where(chosen, multipliers + further, multipliers)
            last, open_ = size, open_ & (size > ROUNDING)
        return accelerations, multipliers

    def _factored(self, mass: Matrix, roots: Matrix, directions: Matrix) -> Any:
        """Return SuperLU's factors of the system of k states, or None if it is singular."""
        (k, g, n), size = directions.shape, sum(directions.shape[1:])
        s, r = np.nonzero((mass != 0).any(axis=0))
        beta, q = np.nonzero((directions != 0).any(axis=0))
        places = np.concatenate([s * size + r, q * size + n + beta, (n + beta) * size + q])  # it is symmetric
        along = directions[:, beta, q]
        order = np.argsort(places)
        entries = np.concatenate([ALPHA * mass[:, s, r] / (roots[:, s] * roots[:, r]), along, along], axis=1)[:, order]
        columns, rows = np.divmod(places[order], size)
        states = np.arange(k)[:, None]
        rows = (rows + size * states).ravel()
        starts = (np.searchsorted(columns, np.arange(size)) + len(order) * states).ravel()
        from scipy.sparse import csc_array  # of all simulations only those that need it wait for SciPy
        from scipy.sparse.linalg import splu

        compressed = entries.ravel(), rows.astype(np.intc), np.append(starts, entries.size).astype(np.intc)
        try:
            return splu(csc_array(compressed, shape=(k * size, k * size)), permc_spec="COLAMD", diag_pivot_thresh=1.0)
        except RuntimeError:
            for each in zip(mass, self._jacobian.reshape(k, g, n), strict=True):
                weighted_constraints(*each)  # rejects masses that make it so
            return None

    def _solved(self, force: Vector, curvature: Vector) -> tuple[Vector, Vector]:
        """Return accelerations and multipliers, nan if the system is singular."""
        if self._factors is None:
            return np.full_like(force, np.nan), np.full_like(curvature, np.nan)
        sides = np.concatenate([ALPHA * force / self._roots, -self._scale * curvature], axis=-1)
        found, n = self._factors.solve(sides.ravel()).reshape(sides.shape), force.shape[-1]
        return found[..., :n] / self._roots, -self._scale * found[..., n:] / ALPHA


class DependentConstraints(FactoredConstraints):
    """Dependent constraints, factored by singular values up to the rank.

    Arguments as for `factored_constraints`.
    """

    def __init__(self, mass: Matrix, jacobian: Matrix, rank: int | None = None) -> None:
        self._weighted = weighted_constraints(mass, jacobian)
        u, values, v = np.linalg.svd(self._weighted.directions)
        rank = rank_of(values) if rank is None else rank
        self._basis, self._complement = u[..., :rank], u[..., rank:]
        # shape (r, g): transposed pseudo-inverse of C, W = Q C
        self._inverse = v[..., :rank, :] / values[..., :rank, None]

    def length(self, change: Vector) -> Vector:
        """Return the length in the mass metric (see `FactoredConstraints.length`)."""
        return np.linalg.norm(np.vecmat(change, self._weighted.factor), axis=-1)

    def distances(self, residual: Vector) -> Vector:
        """Return distances in the mass metric (see `FactoredConstraints.distances`)."""
        return np.abs(self._weighted.scale * residual)

    def free_directions(self) -> Matrix:
        """Return an orthonormal basis, in the mass metric, of the null space of J.

        Returns
        -------
        ndarray, shape (n, n - r)
        """
        return self._unweighted(self._complement.T).T

    def accelerations(self, force: Vector, curvature: Vector) -> Vector:
        """Return them across Q and along Q (see `FactoredConstraints.accelerations`)."""
        free = np.vecmat(self._weighted_force(force, curvature), self._complement)
        along = np.matvec(self._basis, self._along(curvature))
        return self._unweighted(along + np.matvec(self._complement, free))

    def correction(self, residual: Vector) -> Vector:
        """Return the change along Q (see `FactoredConstraints.correction`)."""
        return self._unweighted(np.matvec(self._basis, self._along(residual)))

    def unknowns(self, force: Vector, curvature: Vector) -> tuple[Vector, Vector]:
        """Return unknowns outside J^T's null space (see `FactoredConstraints.unknowns`)."""
        along = self._along(curvature) - np.vecmat(self._weighted_force(force, curvature), self._basis)
        found = self._weighted.scale * np.vecmat(along, self._inverse)
        acting = np.linalg.qr(np.matrix_transpose(self._inverse / self._weighted.scale[..., None, :]))[0]
        return self.accelerations(force, curvature), np.matvec(acting, np.vecmat(found, acting))

    def _weighted_force(self, force: Vector, curvature: Vector) -> Vector:
        """Return L^-1 h. If A is singular, h is changed together with A."""
        if self._weighted.stiffening is not None:
            force = force - np.matvec(self._weighted.stiffening, curvature)
        return np.matvec(self._weighted.inverse, force)

    def _unweighted(self, z: Vector) -> Vector:
        """Return L^-T z."""
        return np.vecmat(z, self._weighted.inverse)

    def _along(self, curvature: Vector) -> Vector:
        return -np.matvec(self._inverse, self._weighted.scale * curvature)


def factored_constraints(mass: Matrix, jacobian: Matrix, rank: int | None = None) -> FactoredConstraints:
    """Factor the equations of motion.

    Parameters
    ----------
    mass : ndarray, shape (n, n) or (k, n, n)
        A, symmetric. Positive definite together with the constraints.
    jacobian : ndarray, shape (g, n) or (k, g, n)
        J. Its rows may be dependent, and of any scale.
    rank : int or None
        How many of the constraints count as independent. None to count them, at one state.

    Returns
    -------
    FactoredConstraints

    Raises
    ------
    HolonomError
        As `weighted_constraints`, where the equations are found to be singular.
    """
    if rank is None:
        rank = rank_of(weighted_constraints(mass, jacobian).singular_values())
    if rank == jacobian.shape[-2]:
        return IndependentConstraints(mass, jacobian)
    return DependentConstraints(mass, jacobian, rank)
