"""The gallery: every example of the repository in motion."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from .. import table
from ..chapter import FILES
from ..motions import Motion, figures_of, motion
from ..runs import Run
from . import EXAMPLES

EXHIBITS = table("gallery")["exhibit"]


def _run(file: str, scene: str | None = None, until: str | None = None, **shown: str) -> Run:
    return Run(motion, (EXAMPLES.parent / file, scene, until and Fraction(until)))


RUNS = {each["name"]: _run(**each) for each in EXHIBITS}


def page(results: Mapping[str, Motion]) -> dict[str, Any]:
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
    exhibits = [(exhibit, results[exhibit["name"]]) for exhibit in EXHIBITS]
    return {"exhibits": exhibits, FILES: figures_of(results.items())}
