"""The register of hard cases, and what is found of them."""

from collections.abc import Callable

from ...simulation.diagnosis import HardCase
from .case import Case, CaseReport, Extent, examined
from .dependent_constraints import parallel_constraints, sarrus_linkage
from .mass_ratio import mass_ratio
from .paper_motion import free_motion, overflowing_control
from .pendulums import constraint_given_twice, dead_centres, long_run
from .stiff_springs import car_axis, stiff_spring
from .vanishing_length import vanishing_length

REGISTER = (
    Case(
        "parallel constraints",
        HardCase.NEARLY_DEPENDENT,
        "a pendulum on the circle that the two rods leave free, in closed form",
        parallel_constraints,
    ),
    Case(
        "constraint given twice",
        HardCase.REDUNDANT,
        "the pendulum with one constraint, in elliptic functions; half of its multiplier for each",
        constraint_given_twice,
    ),
    Case(
        "redundant spatial mechanism",
        HardCase.REDUNDANT,
        "Sarrus' linkage reduced to the angle of its legs, a quadrature",
        sarrus_linkage,
    ),
    Case(
        "parallelogram through its dead centres",
        HardCase.SINGULAR_PASSAGE,
        "the rods' common angle, in elliptic functions",
        dead_centres,
    ),
    Case("spring 1e6 times stiffer", HardCase.STIFF, "two coupled oscillators, in closed form", stiff_spring),
    Case("car axis", HardCase.STIFF, "the published solution, right to about twelve decimals", car_axis),
    Case(
        "overflowing control",
        HardCase.OVERFLOW,
        "the paper's free motion, in closed form; its multiplier is zero",
        overflowing_control,
    ),
    Case(
        "mass ratio of 1e12",
        HardCase.MASS_RATIO,
        "two masses on two rods, by hand with 60 digits; the heavy one in free fall",
        mass_ratio,
    ),
    Case("pendulum for ten thousand periods", HardCase.LONG_RUN, "the pendulum in elliptic functions", long_run),
    Case(
        "cancellation along a free motion",
        HardCase.FREE_CANCELLATION,
        "the paper's free motion under u = u0 exp(t), where every multiplier is zero",
        free_motion,
    ),
    Case(
        "controlled length through zero",
        HardCase.VANISHING_LENGTH,
        "the length 1 - t is zero at t = 1",
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
