"""What a motion takes in numbers of many digits, found out before it is followed.

An expansion takes operations in proportion to the square of its order, which grows with the digits. A few steps in the
same numbers, but to a low order, are quickly taken. They tell how long an expansion lasts and, since the length of a
step is set by the radius of convergence and hardly by the order, how many there will be.
"""

import math
import time
from typing import Any

import numpy as np

from ..failures import Failure, HolonomError
from ..sandbox import MIB
from ..supervisor import time_left
from .heyoka_function import dynamics, import_heyoka, zero_multipliers
from .motion_problem import MotionProblem
from .precision import GUARD_DIGITS, Precision

HIGH_ORDER = 240  # of 200 digits: up to it an expansion lasts no longer than compiling does
LOW = 60  # order of the expansions that are tried
TRIAL = 8  # of them, or so many as are done within
BRIEFLY = 1.0  # second
SURELY = 2  # times the time at hand: an estimate that is beyond it
BYTES_BESIDE_DIGITS = 32  # of one of MPFR's numbers


def order_for(digits: float) -> int:
    """Order to which heyoka expands for a tolerance of so many digits.

    References
    ----------
    Jorba & Zou, Experimental Mathematics 14 (2005) 99.
    """
    return math.ceil(1 + digits * math.log(10) / 2)


def require_means(problem: MotionProblem, precision: Precision, order: int, until: Any = None) -> None:
    """Refuse expansions that the time which the command has left, or the memory of the machine, surely does not hold.

    Parameters
    ----------
    problem : MotionProblem
        With a value for each parameter.
    until : number or None
        The instant to which the motion is followed; None where it is expanded once.
    """
    if order <= HIGH_ORDER:
        return
    start = np.array([precision.number(problem.start[name]) for name in problem.state])
    trial = import_heyoka().taylor_adaptive(
        dynamics(problem.motion, zero_multipliers(problem.multipliers, precision.number("0")), precision.ratio),
        start,
        time=precision.number(problem.start["t"]),
        tol=precision.number(repr(math.exp(-2 * LOW))),
        compact_mode=True,
        opt_level=0,
        **precision.options,
    )
    _require_memory(len(trial.decomposition) * (order + 1), precision)
    _require_time(*_tried(trial, until), order, precision)


def _require_time(steps: int, seconds: float, order: int, precision: Precision) -> None:
    needed, left = steps * seconds * (order / LOW) ** 2, time_left()
    if needed > SURELY * left:
        said = f"{steps} expansion{'s' * (steps > 1)} to order {order} in {precision.digits} digits"
        takes = f"at {seconds * (order / LOW) ** 2:.3g} s each take much longer than {left:.0f} s"
        raise HolonomError(Failure.TIME_TOO_SHORT, detail=f"{said} {takes}")


def _require_memory(numbers: int, precision: Precision) -> None:
    import psutil

    bits = (precision.digits + GUARD_DIGITS) * math.log2(10)
    needed, free = numbers * (bits / 8 + BYTES_BESIDE_DIGITS) / MIB, psutil.virtual_memory().available / MIB
    if needed > free:
        said = f"an expansion in {precision.digits} digits takes about {needed:.0f} MiB of memory"
        raise HolonomError(Failure.MEMORY_TOO_SMALL, detail=f"{said}, and {free:.0f} are free")


def _tried(trial: Any, until: Any) -> tuple[int, float]:
    """How many steps there are to an instant, and the seconds that one takes."""
    begun, first, taken = time.process_time(), trial.time, 0
    most = 1 if until is None else TRIAL
    while taken < most and trial.time != until and time.process_time() < begun + BRIEFLY:
        trial.step() if until is None else trial.step(until - trial.time)
        taken += 1
    seconds = (time.process_time() - begun) / taken
    if until is None or not trial.time > first:
        return 1, seconds
    return math.ceil(taken * float((until - first) / (trial.time - first))), seconds
