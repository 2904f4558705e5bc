"""The reference motion: a run with many more digits, confirmed by a second one.

The two runs differ in the digits that they compute with and in the order of their expansions, which follows from the
tolerance. Neither projects.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from ...program.expense import order_for
from ...program.precision import read_precision
from ...simulation.engines.engine import Task, advance
from ...simulation.engines.taylor import TaylorEngine
from ...simulation.request import Stabilization
from ...structs import entry
from .engines import state_of
from .measurement import State, relative_error

if TYPE_CHECKING:
    from ...program.motion_problem import MotionProblem

MORE_DIGITS = 30  # than the most precise run that is measured
CONFIRMING_DIGITS = 18  # more than it, in the second run
SURER = 10  # times an error must exceed what the two runs differ by


@dataclass(frozen=True)
class Reference:
    """States of the motion, known to many digits."""

    states: Mapping[Fraction, State]  # coordinates and velocities at each time asked for
    digits: int = entry("Digits of the reference run.")
    order: int = entry("Order of its Taylor expansion.")
    confirming_digits: int = entry("Digits of the run that confirms it.")
    confirming_order: int = entry("Order of the run that confirms it.")
    difference: float = entry("Largest relative difference of the two runs.", minimum=0)

    def can_tell(self, error: float) -> bool:
        """Return True if an error is larger than the uncertainty of the reference.

        Parameters
        ----------
        error : float
            Relative error of a method.

        Returns
        -------
        bool
            True if it exceeds `SURER` times the difference of the two runs.
        """
        return error > SURER * self.difference


def find_reference(problem: "MotionProblem", times: Sequence[Fraction], digits: int) -> Reference:
    """Integrate a motion twice, with more digits than any measured method.

    Parameters
    ----------
    problem : MotionProblem
        Its start has `MORE_DIGITS` more than `digits`, at least.
    times : sequence of Fraction
        In their order.
    digits : int
        Of the most precise method.

    Returns
    -------
    Reference
        States by the more precise run, and the difference of both.

    Raises
    ------
    HolonomError
        As `holonom.simulation.engines.taylor.TaylorEngine`.
    """
    fine, coarse = digits + MORE_DIGITS, digits + CONFIRMING_DIGITS
    states, confirming = (_states(problem, times, d) for d in (fine, coarse))
    return Reference(
        states=states,
        digits=fine,
        confirming_digits=coarse,
        order=order_for(fine),
        confirming_order=order_for(coarse),
        difference=max(relative_error(confirming[time], states[time]) for time in times),
    )


def _states(problem: "MotionProblem", times: Sequence[Fraction], digits: int) -> dict[Fraction, State]:
    numbers, states = read_precision(str(digits)), {}
    asked = {"precision": digits, "tol": 10.0**-digits, "stabilization": Stabilization.NONE}
    motion = TaylorEngine(Task.of(problem, **asked))
    for time in times:
        advance(motion, numbers.ratio(time))
        states[time] = state_of(numbers, motion.state)
    return states
