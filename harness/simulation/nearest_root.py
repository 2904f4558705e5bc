"""Roots of constraints nearest to guesses, for many motions, in double precision.

Newton's method is damped: a step is halved until the next correction with the same matrix is shorter. All corrections
are the least ones in the mass metric (Deuflhard, Newton Methods for Nonlinear Problems, section 3.3). Unless it
contracts at once, it begins again from points around the guess, and the nearest root is taken.
`maxima/algebra/sample_point.lisp` does the same for one motion to many digits.
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .evaluation import Numbers
from .nominal import share_of

ITERATIONS = 60  # Newton's method halves the way to a double root
ROUNDING = 8 * np.finfo(float).eps  # relative size of a correction that is none
SETTLED = 1e-12  # relative size of a last correction that rounding may have made
HALVINGS = 30
CONTRACTION = 1 / 16  # of a correction: nonlinearity of the constraints allowed along it
ALONG = (1 / 3, 5 / 7, 1.0)  # shares of it at which that is asked
ON_A_LINE = np.arange(1, 17) / 16  # shares of the distance of a root at which the search begins, with one unknown
AROUND = np.arange(1, 5) / 4  # the same along each of several unknowns
MOST_SEARCHED = 12  # unknowns up to which nearer roots are looked for
NEARER, SAME = 0.9, 1 - 1e-6  # of a distance: another point of a manifold, or another root, that is nearer
FARTHER = (0.25, 1.0, 4.0, 16.0)  # sizes of the guess at which the search begins where Newton's method finds nothing
ROUNDS = 8


class Linearized(NamedTuple):
    """Constraints at k points of u unknowns."""

    residual: Numbers  # shape (b, k)
    jacobian: Numbers  # shape (b, u, k)
    mass: Numbers  # shape (u, u, k)


# Takes points, shape (u, k), and the numbers of their elements.
Linearize = Callable[[Numbers, NDArray[np.int64]], Linearized]
Correct = Callable[[Linearized], Numbers]  # the least corrections in the mass metric, shape (u, k)


class NearestRoots:
    """The search for roots near guesses.

    It takes guesses, shape (u, k), and their elements to roots and whether there are any.

    Parameters
    ----------
    linearize, correct : callable
        What comes out for one point does not depend on the others.
    sizes : ndarray, shape (u,)
        Nominal ones of the unknowns.
    """

    def __init__(self, linearize: Linearize, correct: Correct, sizes: Numbers) -> None:
        self._linearize, self._correct, self._sizes = linearize, correct, sizes

    def __call__(
        self, guess: Numbers, elements: NDArray[np.int64], nearest: bool = True
    ) -> tuple[Numbers, NDArray[np.bool_]]:
        """Return the nearest roots, or those that Newton's method finds by full steps."""
        roots, found = self._newton(guess, elements, damped=nearest)
        if nearest and len(guess) <= MOST_SEARCHED:
            searched = np.flatnonzero(~(found & self._contracts(guess, elements)))
            roots[:, searched], found[searched] = self._search(guess, roots, found, searched)
        return roots, found

    def _newton(self, start: Numbers, elements: NDArray[np.int64], damped: bool) -> tuple[Numbers, NDArray[np.bool_]]:
        points, found, active = start.copy(), np.zeros(len(elements), dtype=bool), np.arange(len(elements))
        for _ in range(ITERATIONS):
            if not len(active):
                break
            here = points[:, active]
            at = self._linearize(here, elements[active])
            change = self._correct(at)
            share = share_of(change, here, self._sizes)
            settled = share <= SETTLED
            full = settled if damped else np.ones_like(settled)
            points[:, active] = self._stepped(here, change, at, elements[active], full)
            found[active] = settled
            active = active[np.isfinite(share) & (share > ROUNDING)]
        return points, found & np.isfinite(points).all(axis=0)

    def _stepped(
        self, here: Numbers, change: Numbers, at: Linearized, elements: NDArray[np.int64], full: NDArray[np.bool_]
    ) -> Numbers:
        """Return points along the corrections with shorter next corrections.

        If there is none, or `full` is true, it is the full step.
        """
        result, size, share = here + change, self._largest(change), 1.0
        open_ = np.flatnonzero(~full)
        for _ in range(HALVINGS):
            if not len(open_):
                break
            trial = here[:, open_] + share * change[:, open_]
            following = self._next_roots(trial, at, elements, open_)
            good = self._largest(following) <= (1 - share / 4) * size[open_]
            result[:, open_[good]] = trial[:, good]
            open_, share = open_[~good], share / 2
        return result

    def _next_roots(
        self, trial: Numbers, at: Linearized, elements: NDArray[np.int64], some: NDArray[np.int64]
    ) -> Numbers:
        """Return the corrections at other points with unchanged matrices."""
        residual = self._linearize(trial, elements[some]).residual
        return self._correct(Linearized(residual, at.jacobian[..., some], at.mass[..., some]))

    def _contracts(self, guess: Numbers, elements: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Return True if a guess is next to its root.

        Then the constraints are nearly linear along the first correction.
        """
        at = self._linearize(guess, elements)
        change = self._correct(at)
        size, contracts = self._largest(change), np.ones(len(elements), dtype=bool)
        for share in ALONG:
            left = self._next_roots(guess + share * change, at, elements, elements) - (1 - share) * change
            contracts &= self._largest(left) <= CONTRACTION * size
        return contracts

    def _largest(self, change: Numbers) -> Numbers:
        """Return the largest parts of changes, shape (k,), in terms of nominal sizes."""
        return np.max(np.abs(change.T) / self._sizes, axis=1)

    def _search(
        self, guess: Numbers, roots: Numbers, found: NDArray[np.bool_], elements: NDArray[np.int64]
    ) -> tuple[Numbers, NDArray[np.bool_]]:
        """Return the nearest roots from starts around the guesses of some elements."""
        near, here = guess[:, elements], self._linearize(guess[:, elements], elements)
        best, known = roots[:, elements].copy(), found[elements].copy()
        share = NEARER if len(here.residual) < len(guess) else SAME
        distance = np.where(known, _distance(best - near, here.mass), np.inf)
        size = _distance(np.maximum(np.abs(near.T), self._sizes).T, np.abs(here.mass))
        for reach in (None, *FARTHER):
            if reach is not None and known.all():
                break
            active = np.flatnonzero(known if reach is None else ~known)
            for _ in range(ROUNDS):
                if not len(active):
                    break
                far = distance[active] if reach is None else reach * size[active]
                improved = np.zeros(len(active), dtype=bool)
                for step in _starts(here.mass[..., active], far):
                    points, arrived = self._newton(near[:, active] + step, elements[active], damped=True)
                    way = np.where(arrived, _distance(points - near[:, active], here.mass[..., active]), np.inf)
                    better = way < share * distance[active]
                    improved |= better
                    best[:, active[better]], distance[active[better]] = points[:, better], way[better]
                known[active[improved]] = True
                active = active[improved] if reach is None else active[:0]
        return best, known


def _starts(mass: Numbers, far: Numbers) -> Iterator[Numbers]:
    """Yield steps from the guesses along each unknown, shape (u, k).

    They are ordered by distance in the mass metric.
    """
    u = len(mass)
    for unknown in range(u):
        own = mass[unknown, unknown]
        length = np.where(own > 0, far / np.sqrt(np.where(own > 0, own, 1.0)), 0.0)
        for share in ON_A_LINE if u == 1 else AROUND:
            for side in (1, -1):
                step = np.zeros((u, len(far)))
                step[unknown] = side * share * length
                yield step


def _distance(way: Numbers, mass: Numbers) -> Numbers:
    """Lengths in the mass metric, shape (k,)."""
    return np.sqrt(np.maximum(0.0, np.einsum("ik,ijk,jk->k", way, mass, way)))
