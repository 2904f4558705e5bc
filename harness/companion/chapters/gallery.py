"""The gallery: every example of the repository in motion."""

from collections.abc import Mapping
from fractions import Fraction

from .. import table
from ..chapter import Page
from ..motions import Motion, figures_of, motion
from . import EXAMPLES

EXHIBITS = table("gallery")["exhibit"]


RUNS = {
    each["name"]: motion(
        EXAMPLES.parent / each["file"], each.get("scene"), Fraction(each["until"]) if "until" in each else None
    )
    for each in EXHIBITS
}


def page(results: Mapping[str, Motion]) -> Page:
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
    return Page(
        {"exhibits": [(exhibit, results[exhibit["name"]]) for exhibit in EXHIBITS]},
        figures=figures_of(results.items()),
    )
