"""Chapter on hard cases: motions on which a simple method loses digits."""

from collections.abc import Mapping

from ...benchmark.hard_cases.case import CaseReport, Extent, examined
from ...benchmark.hard_cases.register import REGISTER
from ...figures.benchmark import draw_stability
from ..chapter import Page, Run
from ..runs import drawn


def page(results: Mapping[str, CaseReport]) -> Page:
    """Return the page that results make.

    Parameters
    ----------
    results : mapping
        Results of the runs by their names.

    Returns
    -------
    Page
        Content and files of the page.
    """
    reports = list(results.values())
    return Page(
        {
            "reports": reports,
            "sweeps": [each for each in reports if each.sweep],
        },
        figures={"hard-cases": drawn(lambda file: draw_stability(reports, file))},
    )


def _examined(name: str) -> CaseReport:
    """Return the short report on the case of that name."""
    return examined(next(case for case in REGISTER if case.name == name), Extent.SHORT)


RUNS = {case.name: Run(_examined, (case.name,)) for case in REGISTER}
