"""The gallery: every example of the repository in motion."""

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path

from .. import table
from ..chapter import Page, Run
from ..motions import Motion, figures_of, motion

EXHIBITS = table("gallery")["exhibit"]


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
    return {
        each["name"]: motion(
            root / each["file"], each.get("scene"), Fraction(each["until"]) if "until" in each else None
        )
        for each in EXHIBITS
    }


def page(root: Path, results: Mapping[str, Motion]) -> Page:
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
    return Page(
        {"exhibits": [(exhibit, results[exhibit["name"]]) for exhibit in EXHIBITS]},
        figures=figures_of(results.items()),
        sources=tuple(dict.fromkeys(exhibit["file"] for exhibit in EXHIBITS)),
    )
