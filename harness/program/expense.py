"""Memory and time limits of expansions with many digits.

The memory is estimated before the expansion.
"""

import math

import numpy as np

from ..failures import ErrorKind, HolonomError
from ..language import translatable
from ..sandbox import MIB
from ..supervisor import limit_expected_time
from .heyoka_function import dynamics, import_heyoka, zero_multipliers
from .motion_problem import MotionProblem
from .precision import GUARD_DIGITS, Precision

HIGH_ORDER = 240  # of 200 digits: up to it an expansion lasts no longer than compiling does
LOW = 60  # order of the integrator whose quantities are counted
BYTES_BESIDE_DIGITS = 32  # of one of MPFR's numbers


def order_for(digits: float) -> int:
    """Return the order to which heyoka expands for a tolerance in digits.

    Parameters
    ----------
    digits : float
        Decimal digits of the tolerance.

    Returns
    -------
    int
        Order of the Taylor series.

    References
    ----------
    Jorba & Zou, Experimental Mathematics 14 (2005) 99.
    """
    return math.ceil(1 + digits * math.log(10) / 2)


def require_means(problem: MotionProblem, precision: Precision, order: int) -> None:
    """Raise if an expansion exceeds the free memory. Otherwise limit its time.

    Parameters
    ----------
    problem : MotionProblem
        With a value for each parameter.
    precision : Precision
        Numbers of the expansion.
    order : int
        Highest order of the expansion.

    Raises
    ------
    HolonomError
        They take more memory than is free.
    """
    if order <= HIGH_ORDER:
        return
    limit_expected_time()
    import psutil

    start = np.array([precision.number(problem.start[name]) for name in problem.state])
    counted = import_heyoka().taylor_adaptive(
        dynamics(problem.motion, zero_multipliers(problem.multipliers, precision.number("0")), precision.ratio),
        start,
        tol=precision.number(repr(math.exp(-2 * LOW))),
        compact_mode=True,
        opt_level=0,
        **precision.options,
    )
    bits = (precision.digits + GUARD_DIGITS) * math.log2(10)
    needed = len(counted.decomposition) * (order + 1) * (bits / 8 + BYTES_BESIDE_DIGITS) / MIB
    free = psutil.virtual_memory().available / MIB
    if needed > free:
        estimate = translatable(
            "an expansion in %(digits)s digits takes about %(size)s MiB of memory",
            digits=precision.digits,
            size=f"{needed:.0f}",
        )
        raise HolonomError(
            ErrorKind.MEMORY_TOO_SMALL,
            detail=translatable("%(estimate)s, and %(free)s are free", estimate=estimate, free=f"{free:.0f}"),
        )
