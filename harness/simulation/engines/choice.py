"""Choice of the quickest engine for a motion.

The default engine is compiled quickly and takes a few steps. Their average length gives the number of the others. Each
engine that holds the tolerance states what it would cost, compilation included. All costs follow from numbers of steps
and of operations, with constants measured on one machine. So the choice depends neither on the machine nor on its load.

Measured on the five motions of `tests/benchmarks/simulation.py`, 18 to 431 operations, tolerances 1e-6 to 1e-12.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from ...structs import entry
from ..request import EngineName
from .registry import compared_engines

TRIAL = 64  # steps of the default engine


@dataclass(frozen=True)
class Choice:
    """The choice of an engine, and its reason."""

    engine: EngineName = entry("Engine that was chosen.")
    steps: int = entry("Estimated number of steps of the default engine.")
    operations: int = entry("Operations of the motion program.")
    seconds: Mapping[str, float] = entry("Expected seconds of each engine that was compared, by its name.")
    refused: str = entry("Why an engine could not be compiled where it would have been quicker; else empty.", "")


def quicker_engine(steps: int, operations: int, tol: float, dense: bool) -> Choice:
    """Return the engine with the shorter expected time.

    Parameters
    ----------
    steps : int
        Steps of the default engine, compiled already, to the end of the motion.
    operations : int
        Operations of one evaluation of the accelerations.
    tol : float
        Tolerance of a step.
    dense : bool
        Whether states between the steps are wanted.

    Returns
    -------
    Choice
    """
    kinds = [kind for kind in compared_engines() if kind.comparable(tol)]
    seconds = {kind.name: kind.expected_seconds(steps, operations, tol, dense) for kind in kinds}
    return Choice(min(seconds, key=seconds.get), steps, operations, seconds)
