"""The register of hard cases, and what is found of them."""

from collections.abc import Callable

from ...language import translatable
from ...simulation.hard_cases import HardCase
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
        HardCase.NEARLY_DEPENDENT,
        translatable("a pendulum on the circle that the two rods leave free, in closed form"),
        parallel_constraints,
    ),
    Case(
        translatable("constraint given twice"),
        HardCase.REDUNDANT,
        translatable("the pendulum with one constraint, in elliptic functions"),
        constraint_given_twice,
    ),
    Case(
        translatable("redundant spatial mechanism"),
        HardCase.REDUNDANT,
        translatable("Sarrus' linkage reduced to the angle of its legs, a quadrature"),
        sarrus_linkage,
    ),
    Case(
        translatable("parallelogram through its dead centres"),
        HardCase.SINGULAR_PASSAGE,
        translatable("the rods' common angle, in elliptic functions"),
        dead_centres,
    ),
    Case(
        translatable("spring 1e6 times stiffer"),
        HardCase.STIFF,
        translatable("two coupled oscillators, in closed form"),
        stiff_spring,
    ),
    Case(
        translatable("car axis"),
        HardCase.STIFF,
        translatable("the published solution, right to about twelve decimals"),
        car_axis,
    ),
    Case(
        translatable("overflowing control"),
        HardCase.OVERFLOW,
        translatable("the paper's free motion, in closed form; its multiplier is zero"),
        overflowing_control,
    ),
    Case(
        translatable("mass ratio of 1e12"),
        HardCase.MASS_RATIO,
        translatable("two masses on two rods, by hand with 60 digits; the heavy one in free fall"),
        mass_ratio,
    ),
    Case(
        translatable("pendulum for ten thousand periods"),
        HardCase.LONG_RUN,
        translatable("the pendulum in elliptic functions"),
        long_run,
    ),
    Case(
        translatable("cancellation along a free motion"),
        HardCase.FREE_CANCELLATION,
        translatable("the paper's free motion under u = u0 exp(t), where every multiplier is zero"),
        free_motion,
    ),
    Case(
        translatable("controlled length through zero"),
        HardCase.VANISHING_LENGTH,
        translatable("the length 1 - t is zero at t = 1"),
        vanishing_length,
    ),
)


def examine_all(extent: Extent, done: Callable[[], None]) -> list[CaseReport]:
    """Examine every case of the register; `done` is called after each."""
    reports = []
    for case in REGISTER:
        reports.append(examined(case, extent))
        done()
    return reports
