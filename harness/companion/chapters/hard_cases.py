"""Chapter on hard cases: motions on which a simple method loses digits."""

from collections.abc import Mapping
from functools import partial
from typing import Any

from ...benchmark.hard_cases.case import CaseReport, Extent, examined
from ...benchmark.hard_cases.register import REGISTER
from ...figures.benchmark import draw_stability
from ..chapter import FILES
from ..runs import Run, drawn


def page(results: Mapping[str, CaseReport]) -> dict[str, Any]:
    """Return values of the page.

    Parameters
    ----------
    results : mapping
        Results of the runs by their names.

    Returns
    -------
    dict
        Values by name.
    """
    reports = list(results.values())
    figures = {"hard-cases.svg": drawn(partial(draw_stability, reports))}
    return {"reports": reports, "sweeps": [each for each in reports if each.sweep], FILES: figures}


def _examined(name: str) -> CaseReport:
    """Return the short report on the case of that name."""
    return examined(next(case for case in REGISTER if case.name == name), Extent.SHORT)


RUNS = {case.name: Run(_examined, (case.name,)) for case in REGISTER}
