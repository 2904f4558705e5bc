"""A simulation as the document of `holonom simulate --json`: doubles as numbers, longer ones as decimal text."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..documents import Publication, published
from .diagnosis import engine_text, remarks
from .result import Report, Simulation


def simulation_document(simulation: Simulation) -> dict[str, Any]:
    """The report and the samples.

    Returns
    -------
    dict
        As `report_document`, with the samples by name under ``samples``.
    """
    digits = simulation.report.digits
    columns = {name: published_list(samples, digits) for name, samples in simulation.columns()}
    named = {"scene": simulation.scene, "title": simulation.title}
    return report_document(simulation.report) | named | {"samples": columns}


def report_document(report: Report) -> dict[str, Any]:
    """The report alone.

    Returns
    -------
    dict
        Its attributes; ``trusted``; and beside the legs and the cases the sentences that people
        read, ``engine`` and ``remarks``.
    """
    said = {"engine": engine_text(report.legs), "remarks": tuple(remarks(report.legs, report.cases))}
    lists = {name: tuple(each._asdict() for each in getattr(report, name)) for name in ("legs", "switchings", "doubts")}
    correction = report.correction and dict(zip(("name", "size"), report.correction, strict=True))
    ending = None if report.ending is None else report.ending._asdict()
    attributes = vars(report) | lists | said
    attributes |= {"trusted": report.trusted, "correction": correction, "ending": ending}
    return published(Publication.SIMULATION, {k: _published(value, report.digits) for k, value in attributes.items()})


def published_list(samples: np.ndarray, digits: int) -> list[float | str]:
    """Samples for another program to read.

    Parameters
    ----------
    digits : int
        Of those that no double can hold.
    """
    return samples.tolist() if samples.dtype == float else [_published(sample, digits) for sample in samples]


def _published(value: Any, digits: int) -> Any:
    match value:
        case str() | int() | None:
            return value
        case Mapping():
            return {name: _published(each, digits) for name, each in value.items()}
        case tuple():
            return [_published(each, digits) for each in value]
        case float():
            return float(value)
        case _:
            return _text(value, digits)


def _text(number: Any, digits: int) -> str:
    """Decimal digits of a number that no double can hold."""
    import mpmath

    with mpmath.workdps(digits + 5):
        return mpmath.nstr(mpmath.mpf(str(number)), digits, strip_zeros=False)
