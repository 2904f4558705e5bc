"""The paper's misprints: every printed equation compared with the derived one."""

from collections.abc import Iterable, Iterator, Mapping
from itertools import takewhile
from pathlib import Path

from ...errata import PrintedEquation
from ..cards import anchor, anchors
from ..chapter import Page, Run
from ..runs import printed

PAGES = {
    "the-system": ("1",),
    "equations-of-motion": ("2", "3", "4", "5", "6", "7", "8", "9"),
    "free-motion": ("10",),
    "initial-motion": ("11", "12", "13"),
}
TRANSCRIPTION = "examples/paper/printed.mac"
EXAMPLE, FIRST_OF_EXAMPLE = "worked-example", "14"


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
    return {"printed": printed()}


def page(root: Path, results: Mapping[str, tuple[PrintedEquation, ...]]) -> Page:
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
    equations = results["printed"]
    return Page(
        {
            "rows": rows(equations),
            "misprints": [each for each in equations if not each.agrees],
            "transcription": TRANSCRIPTION,
        },
        sources=(TRANSCRIPTION,),
    )


def rows(equations: tuple[PrintedEquation, ...]) -> list[tuple[PrintedEquation, str]]:
    """Return each printed equation with the link to its card.

    Parameters
    ----------
    equations : tuple of PrintedEquation
        Equations of the paper.

    Returns
    -------
    list of tuple
        Equation and link.
    """
    general = list(takewhile(_before_the_example, equations))
    example = equations[len(general) :]
    return [
        *(
            (each, f"../book/{page}.html#{anchor('', each)}")
            for page, each in zip(_pages(general), general, strict=True)
        ),
        *((each, f"../book/{EXAMPLE}.html#{place}") for each, place in zip(example, anchors(example), strict=True)),
    ]


def _before_the_example(each: PrintedEquation) -> bool:
    return each.number != FIRST_OF_EXAMPLE


def _pages(general: Iterable[PrintedEquation]) -> Iterator[str]:
    """Yield the page of each general equation."""
    page_of = {number: page for page, numbers in PAGES.items() for number in numbers}
    page = ""
    for each in general:
        page = page_of.get(each.number, page)
        yield page
