"""Which engine is quicker for a motion: the Taylor engine, or the Runge-Kutta engine once the C compiler is done.

The Taylor engine is compiled in a moment and takes a few steps; their average length tells how many more there are.
What these cost, in whatever code pays for so many, is held against what the other engine costs, the C compiler
included. All of it follows from counts, of steps and of operations, with fixed costs: measured on one machine, the same
on all, so that the choice depends neither on the machine nor on what else it does.

Measured on the five motions of `tests/benchmarks/simulation.py`, 18 to 431 operations, tolerances 1e-6 to 1e-12.
"""

from dataclasses import dataclass
from shutil import which
from typing import NamedTuple

from ..request import EngineName
from .code import REFERENCE, Code, compilation, running

TRIAL = 64  # steps of the Taylor engine
# seconds a step of the other takes for an operation, in all its stages, and beside them
STAGES, STEP = 7.5e-9, 2e-7
STRIDE = 0.89  # steps of the other for one of the Taylor engine
ORDER = 8  # of the other: what its steps shrink with
COMPILER = 0.15, 5e-4  # seconds that the C compiler takes, and for an operation


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


def comparable(tol: float | None) -> bool:
    """Whether the Runge-Kutta engine holds the tolerance and can be compiled here."""
    from ...program.c_function import has_compiler
    from .runge_kutta import FINEST

    return tol is not None and FINEST <= tol < 1 and has_compiler() and which("gsl-config") is not None


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
    taylor = _taylor(steps, operations, tol)
    runge_kutta = _runge_kutta(steps, operations, tol, between)
    engine = EngineName.RUNGE_KUTTA if runge_kutta < taylor else EngineName.TAYLOR
    return Choice(engine, steps, operations, taylor, runge_kutta)


def _taylor(steps: int, operations: int, tol: float) -> float:
    run = {code: running(code, operations, steps, tol) for code in Code}
    compact, unrolled = (compilation(code, operations) for code in (Code.COMPACT, Code.UNROLLED))
    return min(run[Code.QUICK], compact + run[Code.COMPACT], compact + unrolled + run[Code.UNROLLED])


def _runge_kutta(steps: int, operations: int, tol: float, between: Between) -> float:
    taken = STRIDE * steps * (REFERENCE / tol) ** (1 / ORDER) * (1 + between.in_each) + between.altogether
    begun, each = COMPILER
    return begun + each * operations + taken * (STEP + STAGES * operations)
