"""Choice of the quicker engine for a motion: the Taylor or the Runge-Kutta engine.

The Taylor engine is compiled quickly and takes a few steps. Their average length gives the number of the others. Their
cost, in the code that is worthwhile for that number, is compared with the cost of the other engine and of the C
compiler. All costs follow from numbers of steps and of operations, with constants measured on one machine. So the
choice depends neither on the machine nor on its load.

Measured on the five motions of `tests/benchmarks/simulation.py`, 18 to 431 operations, tolerances 1e-6 to 1e-12.
"""

from dataclasses import dataclass

from ...structs import entry
from ..request import EngineName
from .registry import compared_engines

TRIAL = 64  # steps of the Taylor engine


@dataclass(frozen=True)
class Choice:
    """The choice of an engine, and its reason."""

    engine: EngineName = entry("Engine that was chosen.")
    steps: int = entry("Estimated number of steps of the Taylor engine.")
    operations: int = entry("Operations of the motion program.")
    taylor: float = entry("Expected seconds of the Taylor engine.")
    runge_kutta: float = entry("Expected seconds of the Runge-Kutta method.")
    refused: str = entry(
        "Why the Runge-Kutta engine could not be compiled where it would have been quicker; else empty.", ""
    )


def quicker_engine(steps: int, operations: int, tol: float, dense: bool) -> Choice:
    """Return the engine with the shorter expected time.

    Parameters
    ----------
    steps : int
        Steps of the Taylor engine, compiled already, to the end of the motion.
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
    kinds = compared_engines()
    seconds = {kind.name: kind.expected_seconds(steps, operations, tol, dense) for kind in kinds}
    engine = min((kind.name for kind in kinds if kind.comparable(tol)), key=seconds.get)
    return Choice(engine, steps, operations, seconds[EngineName.TAYLOR], seconds[EngineName.RUNGE_KUTTA])
