"""Options of heyoka's compiler, and the choice between them.

Measured on a pendulum, the crane, and chains with N = 4, 8 and 16: 12, 38, 100, 208 and 424 operations. The first line
of each code is for a tolerance of 1e-9, the second for 1e-15:

               milliseconds to compile      microseconds a step
    quick      10   15   19   30   45       0.97  2.1   6.7   15    31
               11   17   19   29   44       2.1   6.6   16    35    73
    plain       6   12   23   54  133       0.28  0.53  1.8   4.4   12
                9   19   53  123  306       0.45  1.2   4.1   9.8   34
    compact    68  143  340  416  725       0.36  0.69  2.2   5.4   13
               67  145  346  419  730       0.64  1.3   4.6   11    26
    unrolled   39   88  322                 0.25  0.33  1.1
               87  184  888                 0.40  0.69  2.4

So plain code is compiled first where it is compiled as quickly, and compact code in large programs, whose unrolled code
takes long to compile. In extended precision plain code takes 39 to 770 ms to compile, up to 208 operations, and runs
slower than compact code.

In quadruple precision and beyond, functions do the arithmetic, and all run alike. The time of a run is predicted from
these times, by steps and operations, never measured: the choice must not depend on the machine's load.
"""

from enum import StrEnum
from itertools import accumulate, pairwise
from math import log

from ...program.precision import Precision, read_precision


class Code(StrEnum):
    """A kind of compiled code, with heyoka's options."""

    QUICK = "quick"
    PLAIN = "plain"
    COMPACT = "compact"
    UNROLLED = "unrolled"

    @property
    def options(self) -> dict[str, object]:
        """The options of heyoka for this code."""
        return {"compact_mode": self in (Code.QUICK, Code.COMPACT), "opt_level": LEVELS[self]}


LEVELS = {Code.QUICK: 0, Code.PLAIN: 0, Code.COMPACT: 1, Code.UNROLLED: 3}  # of optimisation
SHARE = {Code.QUICK: 1.0, Code.PLAIN: 0.26, Code.COMPACT: 0.4, Code.UNROLLED: 0.2}  # of the running time of quick code
SMALL, LARGE = 40, 250  # operations up to which plain code is compiled at once, and from which compact code is
REFERENCE, OPERATION = 1e-9, 7.5e-8  # tolerance of a step, and the seconds that it takes for an operation in quick code
STEP = 2e-7  # seconds that a step takes for everything else
ORDERS = 1.6  # power of the order that this grows with
HARDWARE = ("double", "extended")


def codes_for(operations: int, precision: Precision) -> tuple[Code, ...]:
    """Return the codes of a program, each better than the one before.

    Parameters
    ----------
    operations : int
        Operations of one evaluation of the accelerations.
    precision : Precision
        Numbers of the integrator.

    Returns
    -------
    tuple of Code
        The first is compiled at once.
    """
    if precision.name not in HARDWARE:
        return (Code.QUICK,)
    if operations > LARGE:
        return Code.QUICK, Code.COMPACT
    if precision.name != "double":
        return Code.QUICK, Code.COMPACT, Code.UNROLLED
    return (Code.PLAIN, Code.UNROLLED) if operations <= SMALL else (Code.QUICK, Code.PLAIN, Code.UNROLLED)


def worthwhile_code(code: Code, operations: int, precision: Precision, steps: float, tol: float) -> Code | None:
    """Return the next better code if the remaining steps of a run justify compilation.

    Parameters
    ----------
    code : Code
        The present code.
    operations : int
        Operations of one evaluation of the accelerations.
    precision : Precision
        Numbers of the integrator.
    steps : float
        Number of remaining steps.
    tol : float
        Tolerance of a step.

    Returns
    -------
    Code or None
    """
    better = dict(pairwise(codes_for(operations, precision))).get(code)
    return better if better and _is_worthwhile(code, better, operations, steps, tol) else None


def _is_worthwhile(code: Code, better: Code, operations: int, steps: float, tol: float) -> bool:
    gained = _running(code, operations, steps, tol) - _running(better, operations, steps, tol)
    return gained > _compilation(better, operations)


def _running(code: Code, operations: int, steps: float, tol: float) -> float:
    """Return the expected seconds of steps of a motion program."""
    quick = OPERATION * operations * (_order(tol) / _order(REFERENCE)) ** ORDERS
    return steps * (STEP + SHARE[code] * quick)


def expected_seconds(operations: int, steps: float, tol: float) -> float:
    """Return the expected time of a run in double precision with worthwhile code.

    Parameters
    ----------
    operations : int
        Operations of one evaluation of the accelerations.
    steps : float
        Number of steps.
    tol : float
        Tolerance of a step.

    Returns
    -------
    float
        In seconds, without the first compilation.
    """
    first, *better = codes_for(operations, read_precision("double"))
    compiled = accumulate(better, lambda spent, code: spent + _compilation(code, operations), initial=0.0)
    return min(
        spent + _running(code, operations, steps, tol) for spent, code in zip(compiled, (first, *better), strict=True)
    )


def _compilation(code: Code, operations: int) -> float:
    """Return the expected seconds of compilation in a better code than ``QUICK``."""
    match code:
        case Code.PLAIN:
            return 7e-4 * operations
        case Code.COMPACT:
            return 0.05 + 1.1e-3 * operations
        case _:
            return 0.05 + 5.5e-5 * operations**2


def _order(tol: float) -> float:
    """Return the order that heyoka takes for a tolerance."""
    return 1 - log(tol) / 2
