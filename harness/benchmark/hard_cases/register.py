"""The register of hard cases, and what is found of them."""

from collections.abc import Callable

from . import (
    car_axis,
    dead_centres,
    free_motion,
    long_run,
    mass_ratio,
    overflow,
    parallel_constraints,
    repeated_constraint,
    spatial_mechanism,
    stiff_spring,
    vanishing_length,
)
from .case import Case, CaseReport, Extent

REGISTER = (
    parallel_constraints.CASE,
    repeated_constraint.CASE,
    spatial_mechanism.CASE,
    dead_centres.CASE,
    stiff_spring.CASE,
    car_axis.CASE,
    overflow.CASE,
    mass_ratio.CASE,
    long_run.CASE,
    free_motion.CASE,
    vanishing_length.CASE,
)


def examine(case: Case, extent: Extent) -> CaseReport:
    """Examine one case of the register."""
    return CaseReport(case, case.examine(extent))


def examine_all(extent: Extent, done: Callable[[], None]) -> list[CaseReport]:
    """Examine every case of the register.

    Parameters
    ----------
    done : callable
        Called after each case.
    """
    reports = []
    for case in REGISTER:
        reports.append(examine(case, extent))
        done()
    return reports
