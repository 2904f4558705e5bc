"""The test set of hard cases and its results."""

from collections.abc import Callable

from ...language import translatable
from ...simulation.hard_cases import Difficulty
from .case import Case, CaseReport, Extent, examined
from .dependent_constraints import parallel_constraints, sarrus_linkage
from .mass_ratio import mass_ratio
from .paper_motion import free_motion, overflowing_control
from .pendulums import constraint_given_twice, dead_centres, long_run
from .stiff_springs import car_axis, stiff_spring
from .vanishing_length import vanishing_length

REGISTER = (
    Case(
        translatable("parallel constraints"),
        Difficulty.NEARLY_DEPENDENT,
        translatable("a pendulum on the circle that the two rods leave free, in closed form"),
        parallel_constraints,
    ),
    Case(
        translatable("constraint given twice"),
        Difficulty.REDUNDANT,
        translatable("the pendulum with one constraint, in elliptic functions"),
        constraint_given_twice,
    ),
    Case(
        translatable("redundant spatial mechanism"),
        Difficulty.REDUNDANT,
        translatable("Sarrus' linkage reduced to the angle of its legs, a quadrature"),
        sarrus_linkage,
    ),
    Case(
        translatable("parallelogram through its dead centres"),
        Difficulty.SINGULAR_CONFIGURATION,
        translatable("the rods' common angle, in elliptic functions"),
        dead_centres,
    ),
    Case(
        translatable("spring 1e6 times stiffer"),
        Difficulty.STIFF,
        translatable("two coupled oscillators, in closed form"),
        stiff_spring,
    ),
    Case(
        translatable("car axis"),
        Difficulty.STIFF,
        translatable("the published solution, right to about twelve decimals"),
        car_axis,
    ),
    Case(
        translatable("overflowing control"),
        Difficulty.OVERFLOW,
        translatable("the paper's free motion, in closed form; its multiplier is zero"),
        overflowing_control,
    ),
    Case(
        translatable("mass ratio of 1e12"),
        Difficulty.MASS_RATIO,
        translatable("two masses on two rods, by hand with 60 digits; the heavy one in free fall"),
        mass_ratio,
    ),
    Case(
        translatable("pendulum for ten thousand periods"),
        Difficulty.LONG_RUN,
        translatable("the pendulum in elliptic functions"),
        long_run,
    ),
    Case(
        translatable("cancellation along a free motion"),
        Difficulty.FREE_CANCELLATION,
        translatable("the paper's free motion under u = u0 exp(t), where every multiplier is zero"),
        free_motion,
    ),
    Case(
        translatable("controlled length through zero"),
        Difficulty.VANISHING_LENGTH,
        translatable("the length 1 - t is zero at t = 1"),
        vanishing_length,
    ),
)


def examine_all(extent: Extent, done: Callable[[], None]) -> list[CaseReport]:
    """Examine every case of the register.

    Parameters
    ----------
    extent : Extent
        Time span of the motions.
    done : callable
        Called without arguments after each case.

    Returns
    -------
    list of CaseReport
        One for each case, in the order of the register.
    """
    reports = []
    for case in REGISTER:
        reports.append(examined(case, extent))
        done()
    return reports
