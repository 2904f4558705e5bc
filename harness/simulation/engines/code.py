"""Options of heyoka's compiler, and the choice between them.

Measured at tolerance 1e-15 on the pendulum of controlled length to t = 100, the chain with N = 8 and Andrews' squeezer
to the end of their time spans. 16, 212 and 438 operations:

               seconds to compile      milliseconds to run
    quick      0.011  0.031  0.14      0.60  1.57  7.4
    compact    0.047  0.18   0.5       0.24  0.61  2.4
    unrolled   0.080  2.4    11        0.17  0.46  1.9

Compact code is compiled at level 1, in 0.94, 0.71 and 0.72 of the time that level 3 takes. It runs alike and gives the
same digits.

In quadruple precision and beyond, functions do the arithmetic, and all three run alike. The time of a run is
predicted from these times, by steps and operations, never measured: the choice must not depend on the machine's load.
"""

from enum import StrEnum
from math import log

from ...program.precision import Precision


class Code(StrEnum):
    """A kind of compiled code, with heyoka's options."""

    QUICK = "quick"
    COMPACT = "compact"
    UNROLLED = "unrolled"

    @property
    def options(self) -> dict[str, object]:
        """The options of heyoka for this code."""
        return {"compact_mode": self is not Code.UNROLLED, "opt_level": LEVELS[self]}


LEVELS = {Code.QUICK: 0, Code.COMPACT: 1, Code.UNROLLED: 3}  # of optimisation
SHARE = {Code.QUICK: 1.0, Code.COMPACT: 0.4, Code.UNROLLED: 0.3}  # of the running time of quick code
REFERENCE, OPERATION = 1e-9, 7.5e-8  # tolerance of a step, and the seconds that it takes for an operation in quick code
ORDERS = 1.6  # power of the order that this grows with
HARDWARE = ("double", "extended")


def better_code(code: Code, precision: Precision) -> Code | None:
    """Return the next better code, if there is one in these numbers.

    Parameters
    ----------
    code : Code
        The present code.
    precision : Precision
        Numbers of the integrator.

    Returns
    -------
    Code or None
    """
    if code is Code.UNROLLED or precision.name not in HARDWARE:
        return None
    return Code.COMPACT if code is Code.QUICK else Code.UNROLLED


def is_worthwhile(code: Code, better: Code, operations: int, steps: float, tol: float) -> bool:
    """Return True if the remaining steps of a run justify compilation of better code.

    Parameters
    ----------
    code : Code
        The present code.
    better : Code
        The code to compile.
    operations : int
        Operations of one evaluation of the accelerations.
    steps : float
        Number of remaining steps.
    tol : float
        Tolerance of a step.

    Returns
    -------
    bool
    """
    gained = running(code, operations, steps, tol) - running(better, operations, steps, tol)
    return gained > compilation(better, operations)


def running(code: Code, operations: int, steps: float, tol: float) -> float:
    """Return the expected time of steps of a motion program.

    Parameters
    ----------
    code : Code
        How the program is compiled.
    operations : int
        Operations of one evaluation of the accelerations.
    steps : float
        Number of steps.
    tol : float
        Tolerance of a step.

    Returns
    -------
    float
        In seconds.
    """
    return SHARE[code] * steps * OPERATION * operations * (_order(tol) / _order(REFERENCE)) ** ORDERS


def compilation(code: Code, operations: int) -> float:
    """Return the expected time of compilation in a better code.

    Parameters
    ----------
    code : Code
        ``COMPACT`` or ``UNROLLED``.
    operations : int
        Operations of one evaluation of the accelerations.

    Returns
    -------
    float
        In seconds.
    """
    return 0.05 + (1.1e-3 * operations if code is Code.COMPACT else 5.5e-5 * operations**2)


def _order(tol: float) -> float:
    """Return the order that heyoka takes for a tolerance."""
    return 1 - log(tol) / 2
