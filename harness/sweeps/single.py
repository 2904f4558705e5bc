"""One motion of a sweep, followed as `holonom simulate` follows it: where a lane of many does not do.

Through singular configurations, switchings and redundant constraints, past narrow places, and to the sentence with
which a motion ends that cannot be followed to the end.
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import NDArray

from ..program.heyoka_function import import_heyoka
from ..program.motion_problem import MotionProblem
from ..program.motion_program import Expression
from ..simulation.engines.engine import Piece
from ..simulation.evaluation import in_full_vectors
from ..simulation.piecewise import PiecewiseMotion
from ..simulation.request import SimulationRequest
from ..simulation.result import Report
from ..simulation.simulate import TakePiece, follow
from .extremes import Steps
from .quantities import expressions_of, solved_names

PARTS, MOST_PARTS, FINER = 4, 4096, 4  # of a step, each with a polynomial of its own; that are tried next
NODES = -np.cos(np.pi * (np.arange(9) + 0.5) / 9)  # of Chebyshev
TO_POWERS = np.linalg.inv(polynomial.polyvander(NODES, len(NODES) - 1))

Floats = NDArray[np.float64]


class SingleMotions:
    """Follows motions of a problem one by one.

    Parameters
    ----------
    along, points : sequence of Expression
        Quantities to look at along the motion, and at the instants asked for.
    """

    def __init__(
        self,
        problem: MotionProblem,
        request: SimulationRequest,
        along: Sequence[Expression],
        points: Sequence[Expression],
    ) -> None:
        self._request, self._along = request, len(along)
        heyoka = import_heyoka()
        n, g = len(problem.coordinates), len(problem.multipliers)
        self._solved = len(solved_names(problem))
        fields = [f"h[{s}]" for s in range(1, n + 1)]
        fields += [f"J[{beta},{s}]" for beta in range(1, g + 1) for s in range(1, n + 1)]
        controls = problem.controls.outputs if problem.controls is not None else ()
        names = ["t", *problem.state, *solved_names(problem), "energy", *controls, *fields, *problem.parameters]
        known = {name: heyoka.expression(name) for name in names}
        quantities = expressions_of([*along, *points], known) if along or points else []
        self._quantities = (
            in_full_vectors(heyoka.cfunc(quantities, vars=list(known.values()), opt_level=0)) if quantities else None
        )

    def follow(self, problem: MotionProblem, stops: Sequence[float]) -> "SingleMotion":
        """Follow one motion.

        Raises
        ------
        HolonomError
            The motion cannot be followed to the end.
        """
        looks: list[_Look] = []

        def watch(motion: PiecewiseMotion) -> TakePiece:
            looks.append(_Look(motion, partial(self._values, motion, problem), self._along, stops))
            return looks[-1].take

        report = follow(problem, self._request, lambda samples: None, watch=watch)
        return looks[-1].motion(report)

    def _values(self, motion: PiecewiseMotion, problem: MotionProblem, instants: Floats, states: Floats) -> Floats:
        """All quantities at states of a motion, shape (quantities, k)."""
        if self._quantities is None:
            return np.empty((0, len(instants)))
        solved = np.concatenate(motion.solutions(instants, states))[: self._solved]
        others = np.array([motion.energy(instants, states), *motion.controls(instants, states).values()])
        matrices = motion.matrices_by_phase(instants, states)
        fields = np.concatenate([np.hstack([at.force, at.jacobian.reshape(len(at.force), -1)]) for at in matrices]).T
        parameters = np.repeat(np.array(problem.numbers)[:, None], len(instants), axis=1)
        inputs = [instants[None], states, solved, others, fields, parameters.reshape(-1, len(instants))]
        return self._quantities(np.concatenate(inputs))


class SingleMotion(NamedTuple):
    """What came of one motion."""

    report: Report
    state: Floats  # shape (2n,): the last one
    points: Floats  # shape (stops, quantities): at the instants asked for; after the end, as they are there
    steps: list[Steps]  # each quantity along the motion, with one lane


class _Look:
    """Looks at quantities along a motion, step by step, and keeps states at stops."""

    def __init__(
        self,
        motion: PiecewiseMotion,
        values: Callable[[Floats, Floats], Floats],
        along: int,
        stops: Sequence[float],
    ) -> None:
        self._motion, self._values, self._along, self._stops = motion, values, along, stops
        self._taken: list[tuple] = []
        self._states = {motion.time: motion.state.copy()}

    def take(self, piece: Piece) -> None:
        """Look at a step."""
        if self._along:
            self._taken += self._polynomials(piece)
        here = [stop for stop in self._stops if piece.start < stop <= piece.end]
        if here:
            self._states |= zip(here, piece.states(np.array(here)).T, strict=True)

    def motion(self, report: Report) -> SingleMotion:
        """What came of it."""
        end, state = float(report.t), self._motion.state.copy()
        states = [self._states[stop] if stop < end else state for stop in self._stops]
        points = self._values(np.minimum(self._stops, end), np.array(states).T)[self._along :].T
        return SingleMotion(report, state, points, _steps(self._taken))

    def _polynomials(self, piece: Piece) -> list[tuple]:
        """The quantities on parts of a step so short that coefficients fall off: middle, half length, coefficients."""
        count, found = PARTS, self._in_parts(piece, PARTS)
        while count < MOST_PARTS and not all(each.resolved().all() for each in _steps(found)):
            count *= FINER
            found = self._in_parts(piece, count)
        return found

    def _in_parts(self, piece: Piece, count: int) -> list[tuple]:
        edges = np.linspace(float(piece.start), float(piece.end), count + 1)
        middles, half = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
        instants = (middles[:, None] + half[:, None] * NODES).ravel()
        values = self._values(instants, piece.states(instants))[: self._along]
        parts = values.reshape(self._along, count, len(NODES)) @ TO_POWERS.T
        return list(zip(middles, half, np.moveaxis(parts, 1, 0), strict=True))


def _steps(taken: list[tuple]) -> list[Steps]:
    if not taken:
        return []
    middle, half = (np.array([part[k] for part in taken])[:, None] for k in (0, 1))
    coefficients = np.moveaxis(np.array([part[2] for part in taken]), 0, 2)  # quantities, powers, steps
    return [Steps(each[:, :, None], middle, half, -1.0) for each in coefficients]
