"""The paper's misprints: every printed equation compared with the derived one."""

from collections.abc import Mapping

from ...errata import PrintedEquation
from ..chapter import Page
from ..runs import printed

RUNS = {"printed": printed()}


def page(results: Mapping[str, tuple[PrintedEquation, ...]]) -> Page:
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
    return Page({"misprints": [each for each in results["printed"] if not each.agrees]})
