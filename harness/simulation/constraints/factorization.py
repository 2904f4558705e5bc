"""The equations of motion at a state, A a - J^T lambda = h and J a = -c, factored with pivots.

Bad scales of masses and constraints, and constraints that follow from others, do them no harm. G = J A^-1 J^T is never
formed: near a singular configuration the accelerations keep about half of the digits that it would lose.

Where all constraints count as independent, the equations are one sparse system. With S the inverse roots of the masses
on A's diagonal, D what brings the rows of J S to length one, and a small alpha,

    | alpha S A S  (D J S)^T |   |     S^-1 a         |     | alpha S h |
    | D J S            0     |   | -alpha D^-1 lambda |  =  |   - D c   |

is symmetric, and its condition number grows no faster than that of D J S while alpha is small beside the latter's
singular values (Arioli, Duff & de Rijk, On the augmented system approach to sparse least-squares problems, 1989).
SuperLU factors it with partial pivoting: what that costs grows like the fill, linearly along a chain of bodies. A step
or two of refinement make the error that of a rounding in each entry that is not zero (Skeel, Iterative refinement
implies numerical stability for Gaussian elimination, 1980).

Where some follow from others, a singular value decomposition of the constraints' directions W drops what vanishes
(Golub & Van Loan, Matrix Computations, sections 5.3 and 6.1): an orthonormal basis Q of what they span splits every
acceleration L^T a in two, along Q what the constraints ask, across Q what the forces give. It costs O(n^3) operations
for n coordinates.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from math import prod
from typing import Any

import numpy as np

from ..matrices import Matrix, Vector
from .directions import EPSILON, or_one, rank_of, weighted_constraints

ALPHA = 2.0**-10
REFINEMENTS = 5
CONTRACTION = 0.5  # a change at least that large beside the last one leads nowhere
ROUNDING = 4 * EPSILON  # relative change of the accelerations that is none


class FactoredConstraints(ABC):
    """The equations of motion at a state, factored, or at several states: then all arrays have an axis before.

    Methods take and return forces and accelerations of shape (n,); residuals, curvatures c and multipliers are of
    shape (g,).
    """

    @abstractmethod
    def length(self, change: Vector) -> Vector:
        """Length of a change of coordinates or velocities, each weighted with its mass."""

    @abstractmethod
    def distances(self, residual: Vector) -> Vector:
        """Return how far away each constraint is in the mass metric, to first order."""

    @abstractmethod
    def accelerations(self, force: Vector, curvature: Vector) -> Vector:
        """Accelerations of A a - J^T lambda = h, J a = -c."""

    @abstractmethod
    def correction(self, residual: Vector) -> Vector:
        """Return the change d, least in the mass metric, with J d = -residual, as far as one solve gives it."""

    @abstractmethod
    def multipliers(self, force: Vector, curvature: Vector) -> Vector:
        """Multipliers of A a - J^T lambda = h, J a = -c: of all that give the constraint forces, the least."""


class IndependentConstraints(FactoredConstraints):
    """By the sparse system; that of several states is one, without coupling. Arguments as `factored_constraints`."""

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
        """By the masses on A's diagonal."""
        return np.linalg.norm(self._roots * change, axis=-1)

    def distances(self, residual: Vector) -> Vector:
        """By the same masses."""
        return np.abs(self._scale * residual)

    def accelerations(self, force: Vector, curvature: Vector) -> Vector:
        """Refined until what changes is rounding."""
        return self._refined(force, curvature)[0]

    def correction(self, residual: Vector) -> Vector:
        """Without refinement."""
        return self._solved(np.zeros_like(self._roots), residual)[0]

    def multipliers(self, force: Vector, curvature: Vector) -> Vector:
        """They are unique."""
        return self._refined(force, curvature)[1]

    def _factored(self, mass: Matrix, roots: Matrix, directions: Matrix) -> Any:
        """Return what SuperLU makes of the system of k states; None where it is singular."""
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
                weighted_constraints(*each)  # refuses masses that make it so
            return None

    def _refined(self, force: Vector, curvature: Vector) -> tuple[Vector, Vector]:
        """Accelerations and multipliers, with what the equations miss solved for until that is rounding."""
        accelerations, multipliers = self._solved(force, curvature)
        last = np.inf
        for _ in range(REFINEMENTS):
            missed = force - np.matvec(self._mass, accelerations) + np.vecmat(multipliers, self._jacobian)
            change, further = self._solved(missed, curvature + np.matvec(self._jacobian, accelerations))
            size = np.max(self.length(change) / or_one(self.length(accelerations)))
            if not size <= CONTRACTION * last:
                break
            accelerations, multipliers, last = accelerations + change, multipliers + further, size
            if size <= ROUNDING:
                break
        return accelerations, multipliers

    def _solved(self, force: Vector, curvature: Vector) -> tuple[Vector, Vector]:
        """Accelerations and multipliers; no numbers where the system is singular."""
        if self._factors is None:
            return np.full_like(force, np.nan), np.full_like(curvature, np.nan)
        sides = np.concatenate([ALPHA * force / self._roots, -self._scale * curvature], axis=-1)
        found, n = self._factors.solve(sides.ravel()).reshape(sides.shape), force.shape[-1]
        return found[..., :n] / self._roots, -self._scale * found[..., n:] / ALPHA


class DependentConstraints(FactoredConstraints):
    """By singular values, of which so many count; arguments as for `factored_constraints`, but for one state."""

    def __init__(self, mass: Matrix, jacobian: Matrix, rank: int) -> None:
        self._weighted = weighted_constraints(mass, jacobian)
        u, values, v = np.linalg.svd(self._weighted.directions)
        self._basis, self._complement = u[:, :rank], u[:, rank:]
        self._inverse = v[:rank] / values[:rank, None]  # shape (r, g): transposed pseudo-inverse of C, W = Q C

    def length(self, change: Vector) -> Vector:
        """In the mass metric."""
        return np.linalg.norm(self._weighted.factor.T @ change)

    def distances(self, residual: Vector) -> Vector:
        """In the mass metric."""
        return np.abs(self._weighted.scale * residual)

    def accelerations(self, force: Vector, curvature: Vector) -> Vector:
        """Return those across Q by the forces, those along Q by the constraints."""
        free = self._complement.T @ self._weighted_force(force, curvature)
        return self._weighted.unweighted(self._basis @ self._along(curvature) + self._complement @ free)

    def correction(self, residual: Vector) -> Vector:
        """Along Q alone."""
        return self._weighted.unweighted(self._basis @ self._along(residual))

    def multipliers(self, force: Vector, curvature: Vector) -> Vector:
        """Less what of them makes no force: the null space of J^T."""
        along = self._along(curvature) - self._basis.T @ self._weighted_force(force, curvature)
        found = self._weighted.scale * (along @ self._inverse)
        acting = np.linalg.qr((self._inverse / self._weighted.scale).T)[0]
        return acting @ (acting.T @ found)

    def _weighted_force(self, force: Vector, curvature: Vector) -> Vector:
        """L^-1 h, where A is singular after the change of h that goes with the change of A."""
        if self._weighted.stiffening is not None:
            force = force - self._weighted.stiffening @ curvature
        return self._weighted.per_root_mass(force)

    def _along(self, curvature: Vector) -> Vector:
        return -(self._inverse @ (self._weighted.scale * curvature))


class DependentConstraintsAtEach:
    """The same at several states; arguments as for `factored_constraints`."""

    def __init__(self, mass: Matrix, jacobian: Matrix, rank: int) -> None:
        self._each = [DependentConstraints(*at, rank) for at in zip(mass, jacobian, strict=True)]

    def __getattr__(self, method: str) -> Callable[..., Vector]:
        """Return a method of `FactoredConstraints`, applied at each state."""

        def at_each(*sides: Vector) -> Vector:
            return np.array([getattr(each, method)(*parts) for each, *parts in zip(self._each, *sides, strict=True)])

        return at_each


def factored_constraints(mass: Matrix, jacobian: Matrix, rank: int | None = None) -> FactoredConstraints:
    """Factor the equations of motion.

    Parameters
    ----------
    mass : ndarray, shape (n, n) or (k, n, n)
        A, symmetric; positive definite together with the constraints.
    jacobian : ndarray, shape (g, n) or (k, g, n)
        J; its rows may be dependent, and of any scale.
    rank : int or None
        How many of the constraints count as independent; None to count them, at one state.

    Raises
    ------
    HolonomError
        As `weighted_constraints`, where the equations are found to be singular.
    """
    if rank is None:
        rank = rank_of(weighted_constraints(mass, jacobian).singular_values())
    if rank == jacobian.shape[-2]:
        return IndependentConstraints(mass, jacobian)
    return (DependentConstraints if mass.ndim == 2 else DependentConstraintsAtEach)(mass, jacobian, rank)
