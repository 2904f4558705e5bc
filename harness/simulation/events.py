"""The end of a motion at an event: the first instant at which one of the scene's expressions crosses zero.

They are looked at step by step, as switching functions are (`surfaces.py`), through the engine's dense output. The
motion is followed to its end once before it is recorded, so that the recording ends with a step of the engine.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..failures import Failure, HolonomError
from ..program.motion_problem import MotionProblem
from ..program.motion_program import names_in
from ..program.precision import Precision
from .engines.engine import Piece, Solutions
from .evaluation import Numbers, as_floats, evaluation_once
from .open_values import BesideState
from .piecewise import PiecewiseMotion
from .surfaces import NODES, Crossing, SignedFunctions

ZERO = 1e-12  # of an expression at the start, beside what it is in the first step: no sign


class Ending(NamedTuple):
    """What the scene lets a motion end at."""

    of: tuple[str, ...]  # the expressions whose first zero crossing ends the motion, as Maxima prints them
    # the one that crossed zero at the last instant; None where none did before the time span was over
    crossed: str | None


def first_event(motion: PiecewiseMotion, precision: Precision, end: Any) -> Crossing | None:
    """Follow a motion, from its start, to the first zero crossing of one of its events; None where there is none.

    Raises
    ------
    HolonomError
        An expression has no real, finite value; the motion cannot be followed so far.
    """
    sides: dict[str, int] = {}
    parts: dict[int, Events] = {}
    for piece in motion.pieces(end):
        part = motion.part
        if id(part) not in parts:
            parts[id(part)] = Events(part.problem, precision, part.engine.solutions)
        found = parts[id(part)].first_event(piece, sides)
        if found is not None:
            return found
    return None


class Events(SignedFunctions):
    """The expressions of one analytic part of a motion.

    Parameters
    ----------
    problem : MotionProblem
        Without signs.
    solutions : callable
        As an engine's.
    """

    def __init__(
        self, problem: MotionProblem, precision: Precision, solutions: Callable[[Numbers, Numbers], Solutions]
    ) -> None:
        super().__init__(precision)
        self._names, self._others = problem.until, BesideState(problem, precision)
        program = problem.events
        used = set().union(*(names_in(value) for _, value in program.assignments))
        used |= set().union(*map(names_in, program.outputs.values()))
        self._solutions = solutions if used & set(problem.multipliers) else None
        self._evaluate = evaluation_once(problem, program, precision)

    def first_event(self, piece: Piece, sides: dict[str, int]) -> Crossing | None:
        """The first crossing within a step.

        `sides` are the signs that expressions have had since they left zero; what this step shows is added.
        """
        begun = self._see_sides(piece, sides) if len(sides) < len(self._names) else ()
        self._rows = [(name, -sides[name], sides[name]) for name in self._names if name in sides]
        return self.first_crossing(piece, begun)

    def _see_sides(self, piece: Piece, sides: dict[str, int]) -> list[str]:
        """Add the sides that are seen for the first time; those of expressions that are zero at the beginning."""
        self._rows = [(name, -1, 1) for name in self._names]
        _, values = self._samples(piece, NODES)
        begun = []
        for name, row in zip(self._names, values, strict=True):
            seen = np.flatnonzero(np.abs(row) > ZERO * np.max(np.abs(row)))
            if name in sides or not seen.size:
                continue
            sides[name] = 1 if row[seen[0]] > 0 else -1
            if seen[0] > 0:
                begun.append(name)
        return begun

    def values(self, instants: Numbers, states: Numbers) -> Numbers:
        """As `SignedFunctions.values`; expressions whose side is not known are left out.

        Raises
        ------
        HolonomError
            One has no real, finite value.
        """
        others = self._others(instants)
        if self._solutions is not None:
            multipliers = self._solutions(instants, states).multipliers
            others[: len(multipliers)] = multipliers
        inputs = np.ascontiguousarray(np.concatenate([np.reshape(instants, (1, -1)), states, others]))
        found = np.array([as_floats(row) for row in self._evaluate(inputs)])
        if not np.isfinite(found).all():
            row, place = np.argwhere(~np.isfinite(found))[0]
            raise HolonomError(
                Failure.NO_EVENT_VALUE, detail=f"{self._names[row]} at t = {float(instants[place]):.10g}"
            )
        places = [self._names.index(name) for name, *_ in self._rows]
        return np.array([side for *_, side in self._rows], dtype=float)[:, None] * found[places]
