"""Chapter on hard cases: motions on which a simple method loses digits."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from ...benchmark.hard_cases.case import CaseReport, Extent, examined
from ...benchmark.hard_cases.register import REGISTER
from ...figures.benchmark import draw_stability
from ..chapter import Page, Run
from ..runs import drawn


def runs(root: Path) -> dict[str, Run]:
    """Return the runs of the chapter.

    Parameters
    ----------
    root : Path
        Root of the repository.

    Returns
    -------
    dict of str to Run
        Runs by name.
    """
    return {case.name: Run(examined, (case, Extent.SHORT)) for case in REGISTER}


def page(root: Path, results: Mapping[str, CaseReport]) -> Page:
    """Return the page that results make.

    Parameters
    ----------
    root : Path
        Root of the repository.
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
            "best": _best_gain(reports),
            "sweeps": [each for each in reports if each.sweep],
        },
        figures={"hard-cases": drawn(lambda file: draw_stability(reports, file))},
    )


def _best_gain(reports: Sequence[CaseReport]) -> CaseReport:
    """Return the case in which the best method keeps most digits more than the worst."""
    return max(reports, key=lambda report: _spread([r.digits for r in report.results if r.digits is not None]))


def _spread(digits: Sequence[float]) -> float:
    return max(digits, default=0.0) - min(digits, default=0.0)
