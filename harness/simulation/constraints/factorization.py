"""Constraints in the mass metric, factored with pivots: solves that dependent rows and bad scales leave unharmed.

With A = L L^T and every row of J scaled to length one, W = L^-1 J^T D holds the constraints' directions as columns.
An orthonormal basis Q of what they span splits every acceleration L^T a in two: along Q it is what the constraints
ask, across Q what the forces give. W is never squared, so that near a singular configuration the accelerations keep
about half of the digits that G = J A^-1 J^T would lose (Golub & Van Loan, Matrix Computations, sections 5.3 and 6.1).

Where A is not positive definite, A + rho J^T J and h - rho J^T c take the place of A and h: they have the same
accelerations and the same multipliers, since J a = -c.

Each factorisation costs O(n^3) operations for n coordinates: g^2 n by Householder's method where the constraints are
independent, a singular value decomposition where they are not.
"""

from dataclasses import dataclass

import numpy as np

from ...failures import Failure, HolonomError
from ..matrices import Matrix, Vector
from ..parts_of_scipy import lapack

EPSILON = float(np.finfo(float).eps)
DEPENDENT = 1e-12  # singular values of the scaled constraints, relative to the largest, that count as rounding
INVOLVED = 1e-6  # share of a constraint in a vanishing combination that is more than rounding
NEGATIVE = 1e-12  # masses below zero, relative to the largest, that are more than rounding
SINGULAR_MASS = 64 * EPSILON  # what elimination may leave of a diagonal entry of A before A counts as singular


@dataclass(frozen=True)
class WeightedConstraints:
    """The constraints' directions in the mass metric."""

    factor: Matrix  # shape (n, n): L, the Cholesky factor of the metric
    scale: Vector  # shape (g,): D, the factors that bring the columns of W to length one
    directions: Matrix  # shape (n, g): W = L^-1 J^T D
    stiffening: Matrix | None  # shape (n, g): rho J^T where A is not positive definite

    def singular_values(self) -> Vector:
        """Singular values of W, the largest first."""
        return np.linalg.svd(self.directions, compute_uv=False) if self.directions.size else np.empty(0)

    def length(self, change: Vector) -> float:
        """Length of a change of coordinates or velocities in the mass metric."""
        return float(np.linalg.norm(self.factor.T @ change))

    def per_root_mass(self, force: Vector) -> Vector:
        """L^-1 h."""
        return lapack().dtrtrs(self.factor, force, lower=1)[0]

    def unweighted(self, z: Vector) -> Vector:
        """L^-T z."""
        return lapack().dtrtrs(self.factor, z, lower=1, trans=1)[0]


@dataclass(frozen=True)
class FactoredConstraints:
    """The constraints' directions in an orthonormal basis, W = Q C.

    Methods take and return forces and accelerations of shape (n,); residuals, curvatures c and multipliers are of
    shape (g,).
    """

    weighted: WeightedConstraints
    basis: Matrix  # shape (n, r): Q; r is the rank that counts
    complement: Matrix  # shape (n, n - r): an orthonormal basis of the directions that are free
    inverse: Matrix  # shape (r, g): transposed pseudo-inverse of C

    def correction(self, residual: Vector) -> Vector:
        """The change d, least in the mass metric, with J d = -residual."""
        return self.weighted.unweighted(self.basis @ self._along(residual))

    def accelerations(self, force: Vector, curvature: Vector) -> Vector:
        """Accelerations of A a - J^T lambda = h, J a = -c."""
        free = self.complement.T @ self._weighted_force(force, curvature)
        return self.weighted.unweighted(self.basis @ self._along(curvature) + self.complement @ free)

    def multipliers(self, force: Vector, curvature: Vector) -> Vector:
        """Multipliers of A a - J^T lambda = h, J a = -c: of all that give the constraint forces, the least."""
        return self._least(self._along(curvature) - self.basis.T @ self._weighted_force(force, curvature))

    def multipliers_of(self, reactions: Vector) -> Vector:
        """The least multipliers with J^T lambda = A a - h for accelerations that are known."""
        return self._least(self.basis.T @ self.weighted.per_root_mass(reactions))

    def _weighted_force(self, force: Vector, curvature: Vector) -> Vector:
        """L^-1 h, where A is singular after the change of h that goes with the change of A."""
        if self.weighted.stiffening is not None:
            force = force - self.weighted.stiffening @ curvature
        return self.weighted.per_root_mass(force)

    def _along(self, residual: Vector) -> Vector:
        return -(self.inverse @ (self.weighted.scale * residual))

    def _least(self, along: Vector) -> Vector:
        """Multipliers of constraint forces along Q, less what of them makes no force: the null space of J^T."""
        found = self.weighted.scale * (along @ self.inverse)
        if len(along) == len(found):
            return found
        acting = np.linalg.qr((self.inverse / self.weighted.scale).T)[0]
        return acting @ (acting.T @ found)


def weighted_constraints(mass: Matrix, jacobian: Matrix) -> WeightedConstraints:
    """Put the constraints into the mass metric.

    Parameters
    ----------
    mass : ndarray, shape (n, n)
        A, symmetric; positive definite together with the constraints.
    jacobian : ndarray, shape (g, n)
        J; its rows may be dependent, and of any scale.

    Raises
    ------
    HolonomError
        A is singular along a direction that the constraints leave free, or it is indefinite and the constraints do not
        make up for it.
    """
    peaks = _or_one(np.max(np.abs(jacobian), axis=1, initial=0.0))
    rows = jacobian / peaks[:, None]
    factor, stiffening = _cholesky(mass), None
    if factor is None:
        stiffening = np.abs(np.diag(mass)).sum() / max(1, len(rows)) * rows.T
        factor, stiffening = _cholesky(mass + stiffening @ rows), stiffening / peaks
    if factor is None:
        masses = np.linalg.eigvalsh(mass)
        indefinite = masses[0] < -NEGATIVE * np.max(np.abs(masses))
        raise HolonomError(Failure.MASS_INDEFINITE if indefinite else Failure.MASS_SINGULAR)
    directions = lapack().dtrtrs(factor, rows.T, lower=1)[0] if rows.size else rows.T
    lengths = _or_one(np.sqrt(np.einsum("sb,sb->b", directions, directions)))
    return WeightedConstraints(factor, 1 / (peaks * lengths), directions / lengths, stiffening)


def factored_constraints(weighted: WeightedConstraints, rank: int) -> FactoredConstraints:
    """Factor the constraints' directions, counting so many of them as independent.

    Where that is less than all of them, the smallest singular values are dropped.
    """
    if rank == weighted.directions.shape[1]:
        return _factored_by_reflections(weighted)
    u, s, v = np.linalg.svd(weighted.directions)
    return FactoredConstraints(weighted, u[:, :rank], u[:, rank:], v[:rank] / s[:rank, None])


def dependent_constraints(weighted: WeightedConstraints, rank: int) -> tuple[int, ...]:
    """Which of the constraints, of that rank, a vanishing combination of directions involves, in order."""
    combinations = np.linalg.svd(weighted.directions)[2][rank:]
    involved = np.max(np.abs(combinations), axis=0, initial=0.0) > INVOLVED
    return tuple(int(beta) for beta in np.flatnonzero(involved))


def rank_of(singular_values: Vector, negligible: float = DEPENDENT) -> int:
    """How many of the constraints are independent, rounding apart.

    Parameters
    ----------
    singular_values : ndarray
        Of W, the largest first.
    negligible : float
        Singular values that do not count, relative to the largest.
    """
    return int(np.count_nonzero(singular_values > negligible * singular_values.max(initial=0.0)))


def _factored_by_reflections(weighted: WeightedConstraints) -> FactoredConstraints:
    """W = Q C by Householder's reflections, the largest rows and columns of W first.

    In this order each row keeps its digits, however small it is beside the others: that of a heavy body among light
    ones (Cox & Higham, Stability of Householder QR factorization for weighted least squares problems, 1998).
    """
    n, g = weighted.directions.shape
    if g == 0:
        return FactoredConstraints(weighted, np.empty((n, 0)), np.eye(n), np.empty((0, 0)))
    rows = np.argsort(-np.max(np.abs(weighted.directions), axis=1), kind="stable")
    reflections, pivots, tau, *_ = lapack().dgeqp3(weighted.directions[rows])
    room = np.zeros((n, n), order="F")
    room[:, :g] = reflections
    q, inverse = np.empty((n, n)), np.empty((g, g))
    q[rows] = lapack().dorgqr(room, tau, overwrite_a=1)[0]
    inverse[:, pivots - 1] = lapack().dtrtri(np.triu(reflections[:g]))[0].T
    return FactoredConstraints(weighted, q[:, :g], q[:, g:], inverse)


def _cholesky(metric: Matrix) -> Matrix | None:
    """L, lower triangular; None where the metric is singular."""
    factor, failed = lapack().dpotrf(metric, lower=1, clean=1)
    regular = not failed and np.all(factor.diagonal() ** 2 > SINGULAR_MASS * metric.diagonal())
    return factor if regular else None


def _or_one(lengths: Vector) -> Vector:
    return np.where(lengths > 0, lengths, 1.0)
