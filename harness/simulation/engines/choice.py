"""Which engine is quicker for a motion: the Taylor engine, or the Runge-Kutta engine once the C compiler is done.

The Taylor engine is compiled in a moment and takes a few steps; their average length tells how many more there are.
What these cost, in whatever code pays for so many, is held against what the other engine costs, the C compiler
included. All of it follows from counts, of steps and of operations, with fixed costs: measured on one machine, the same
on all, so that the choice depends neither on the machine nor on what else it does.

Measured on the five motions of `tests/benchmarks/simulation.py`, 18 to 431 operations, tolerances 1e-6 to 1e-12.
"""

from dataclasses import dataclass
from typing import NamedTuple

from ..request import EngineName
from .registry import compared_engines

TRIAL = 64  # steps of the Taylor engine


@dataclass(frozen=True)
class Choice:
    """Why one engine was taken and not the other."""

    engine: EngineName
    steps: int  # that the Taylor engine has ahead, estimated from its first ones
    operations: int  # of the accelerations
    # taylor, runge_kutta: seconds that each is expected to take for the motion, with what has yet to be compiled
    taylor: float
    runge_kutta: float
    refused: str = ""  # why the other could not be compiled, where it would have been quicker


class Between(NamedTuple):
    """How many states are wanted between steps: each takes the Runge-Kutta engine one more step."""

    altogether: int
    in_each: int  # in each step


def quicker_engine(steps: int, operations: int, tol: float, between: Between) -> Choice:
    """Choose by what both engines are expected to take.

    Parameters
    ----------
    steps : int
        Of the Taylor engine, compiled already, to the end of the motion.
    operations : int
        Of the accelerations.
    tol : float
        Of a step.
    between : Between
    """
    kinds = compared_engines()
    seconds = {kind.name: kind.expected_seconds(steps, operations, tol, between) for kind in kinds}
    engine = min((kind.name for kind in kinds if kind.comparable(tol)), key=seconds.get)
    return Choice(engine, steps, operations, seconds[EngineName.TAYLOR], seconds[EngineName.RUNGE_KUTTA])
