"""Verdicts on JSON documents of stability and series.

A power series must start at the initial state and satisfy the equations of motion. Its derivatives by p are checked
without differentiation: the series q + e dq/dp must satisfy the equations for p + e to first order, which a central
difference shows.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from itertools import zip_longest
from pathlib import Path
from typing import Any

from mpmath import mp

from ..description import Description
from ..failures import ErrorKind, HolonomError
from ..formats import Publication, require
from ..number_texts import number, numbers
from ..program.differentiation import derivative_name
from ..series.power_series import SeriesDocument
from ..series.request import EXACT
from ..stability.along import LinearizedMotion
from ..stability.equilibria import Equilibria
from ..stability.linearization import Linearization
from ..structs import structured
from .compared_values import differing
from .described_motion import DescribedMotion
from .irregular_point import IrregularPoint
from .law import Law
from .linearized import DescribedEquations, conditions_on_equilibria, conditions_on_linearization, verify
from .linearized_along import conditions_on_linearized_motion
from .motion_series import compared_series, digits_of, values_of_series
from .motion_states import ComparedValue
from .report import CheckResult, EquationVerdict, Item, Place, Verdict, verdict_on
from .taylor import Polynomial, Taylor

LOST = 10  # digits that a derivative in rounded numbers may lose
SUMMED = 100  # rounding errors of a sum, in terms of that of its terms
FEWEST = 5  # digits that show a wrong coefficient
CORRECTED = mp.mpf("1e-7")  # of the largest initial value, by which given ones may be corrected
Content = Mapping[str, Any]


def read_result(file: Path) -> Content:
    """Read a JSON document that `check --result` takes.

    Parameters
    ----------
    file : Path

    Returns
    -------
    dict

    Raises
    ------
    HolonomError
        It is not such a document.
    """
    try:
        content = json.loads(file.read_text("utf-8"))
        kind = next(each for each in VERIFIERS if content["format"] == f"holonom-{each}")
    except (ValueError, KeyError, TypeError, RecursionError, StopIteration):
        names = ", ".join(f"holonom-{each}" for each in VERIFIERS)
        raise HolonomError(ErrorKind.NOT_A_DOCUMENT, file, names) from None
    require(kind, content, VERIFIERS[kind][0])
    return content


def verify_result(description: Description, content: Content) -> EquationVerdict:
    """Return the verdict on a result.

    Parameters
    ----------
    description : Description
        The reference.
    content : mapping
        Document as of `read_result`.

    Returns
    -------
    EquationVerdict
    """
    kind, name = Publication(content["format"].removeprefix("holonom-")), content["scene"]
    if name not in {scene.name for scene in description.scenes}:
        found = CheckResult(Verdict.DISAGREES, None, None, "the description has no such scene")
    else:
        found = VERIFIERS[kind][1](description, content)
        if found.verdict is Verdict.AGREES:
            found = found._replace(detail=_unchecked(kind, content))
    return verdict_on(Place(0, name), Item("result", "", f"result: {kind}"), found)


def _unchecked(kind: Publication, content: Content) -> str:
    """Return the fields of a document that are not checked."""
    match kind:
        case Publication.LINEARIZED_ALONG:
            return "not checked: error" + (", stability of free deviations" if content["free"] else "")
        case Publication.EQUILIBRIA:
            return "not checked: starts, more, singular, regular"
        case Publication.SERIES:
            return "not checked: radius, switch, truncation error, continuation"
    return ""


def _verify_linearization(description: Description, content: Content) -> CheckResult:
    return verify(conditions_on_linearization(DescribedEquations(description, content["scene"]), content))


def _verify_linearized_motion(description: Description, content: Content) -> CheckResult:
    return verify(conditions_on_linearized_motion(DescribedEquations(description, content["scene"]), content))


def _verify_equilibria(description: Description, content: Content) -> CheckResult:
    return verify(conditions_on_equilibria(DescribedEquations(description, content["scene"]), content))


def _verify_series(description: Description, content: Content) -> CheckResult:
    groups = ("coordinates", "multipliers", "constraint_forces", "controls", "sensitivities")
    texts = {group: {name: tuple(map(str, row)) for name, row in content[group].items()} for group in groups}
    content = {**content, **texts, "t0": str(content["t0"])}
    scene = next(each for each in description.scenes if each.name == content["scene"])
    if scene.servo_trees:
        return CheckResult(Verdict.NOTHING, None, None, "the forces that servo-constraints find are not in the series")
    digits = digits_of(content["arithmetic"], LOST)
    if digits < FEWEST:
        return CheckResult(Verdict.UNDECIDED, None, None, "the coefficients have too few digits")
    try:
        wrong = differing(partial(_values, DescribedMotion(description, scene), content), digits)
    except IrregularPoint:
        return CheckResult(Verdict.UNDECIDED, None, None, "an expression has no initial value")
    return CheckResult(Verdict.DISAGREES if wrong else Verdict.AGREES, digits, 1, wrong)


VERIFIERS: Mapping[Publication, tuple[type, Callable[[Description, Content], CheckResult]]] = {
    Publication.LINEARIZED: (Linearization, _verify_linearization),
    Publication.LINEARIZED_ALONG: (LinearizedMotion, _verify_linearized_motion),
    Publication.EQUILIBRIA: (Equilibria, _verify_equilibria),
    Publication.SERIES: (SeriesDocument, _verify_series),
}


def _values(motion: DescribedMotion, content: Content) -> Iterator[ComparedValue]:
    """Yield values of the series and, if there are some, of its derivatives."""
    series, order = structured(SeriesDocument, content), content["order"]
    rows = (series.coordinates, series.multipliers, series.constraint_forces, series.controls, series.sensitivities)
    for row in (row for each in rows for row in each.values()):
        yield ComparedValue("order", mp.mpf(len(row) - 1), mp.mpf(order), mp.zero)
    yield from compared_series(motion, series, _largest_correction(series), order)
    if series.at is not None:
        yield from _sums(series, {name: numbers(row) for each in rows for name, row in each.items()})
    if content["sensitivities"]:
        yield from _derivatives(motion, content)


def _sums(series: SeriesDocument, coefficients: Mapping[str, list[mp.mpf]]) -> Iterator[ComparedValue]:
    """Yield the sums of the series at a given time."""
    step, given = number(series.at.t) - number(series.t0), series.at.values
    missing = coefficients.keys() ^ given.keys()
    yield ComparedValue("quantities without a sum, or without a series", mp.mpf(len(missing)), mp.zero, mp.zero)
    for name, row in coefficients.items():
        terms = [c * step**k for k, c in enumerate(row)]
        size = SUMMED * mp.fsum(map(abs, terms))
        yield ComparedValue(f"{name} at t", number(given[name]), mp.fsum(terms), size)


def _largest_correction(series: SeriesDocument) -> tuple[str, str] | None:
    """Return the largest correction of a given value in rounded numbers."""
    if series.arithmetic == EXACT or not series.multipliers:
        return None
    largest = max(abs(x) for row in series.coordinates.values() for x in numbers(row[:2]))
    return "", str(largest * CORRECTED)


def _derivatives(motion: DescribedMotion, content: Content) -> Iterator[ComparedValue]:
    names = (*content["coordinates"], *content["multipliers"], *content["controls"])
    moving = content["sensitivities"]
    directions = {name.partition(", ")[2].rstrip(")") for name in moving}
    for direction in sorted(directions):
        missing = [name for name in names if derivative_name(name, direction) not in moving]
        yield ComparedValue(f"derivatives by {direction}", mp.mpf(len(missing)), mp.zero, mp.zero)
        yield from _initial_derivatives(motion, content, direction)
        yield from _derivatives_by(motion, content, direction)


def _initial_derivatives(motion: DescribedMotion, content: Content, direction: str) -> Iterator[ComparedValue]:
    """Check the derivatives of given initial values."""
    small, parameters = _small(), motion.parameters()
    for name, tree in motion.scene.initial_state.trees.items():
        rate = name.startswith("dot(")
        row = content["sensitivities"][derivative_name(name[4:-1] if rate else name, direction)]
        given = number(row[rate])
        if name == direction:
            yield ComparedValue(f"initial {derivative_name(name, direction)}", given, mp.one, mp.one)
        elif direction in parameters:
            law = Law({"": tree}, ())
            moved = (parameters | {direction: (parameters[direction][0] + step,)} for step in (-small, small))
            before, after = (law.at(Taylor(0), mp.zero, known)[""][0] for known in moved)
            change = (after - before) / (2 * small)
            yield ComparedValue(f"initial {derivative_name(name, direction)}", given, change, mp.one)


def _derivatives_by(motion: DescribedMotion, content: Content, direction: str) -> Iterator[ComparedValue]:
    small = _small()
    before, after = (list(_residuals(motion, content, direction, step)) for step in (-small, small))
    for old, new in zip(before, after, strict=True):
        size = old.size + abs(new.size - old.size) / (2 * small)
        what = f"{old.quantity}, differentiated by {direction}"
        yield ComparedValue(what, (new.given - old.given) / (2 * small), mp.zero, size)


def _residuals(motion: DescribedMotion, content: Content, direction: str, step: mp.mpf) -> Iterator[ComparedValue]:
    order, time = content["order"], number(content["t0"])
    parameters = motion.parameters()
    if direction in parameters:
        parameters = parameters | {direction: (parameters[direction][0] + step,)}

    def moved(name: str, row: list[str]) -> Polynomial:
        change = content["sensitivities"][derivative_name(name, direction)]
        return tuple(x + step * dx for x, dx in zip(numbers(row), numbers(change), strict=True))

    curve = parameters | motion.law.at(Taylor(order + 3), time, parameters) | {"t": (time, mp.one)}
    for name, row in content["controls"].items():
        changes = _changes(moved(name, row), curve[name][: order + 1])
        size = mp.fsum(map(abs, curve[name]))
        yield from (ComparedValue(f"power {k} of {name}", x, mp.zero, size) for k, x in enumerate(changes))
    for name, prescribed in motion.reactions.at(Taylor(order), time, parameters).items():
        changes = _changes(moved(name, content["multipliers"][name]), prescribed)
        size = mp.fsum(map(abs, prescribed))
        yield from (ComparedValue(f"power {k} of {name}", x, mp.zero, size) for k, x in enumerate(changes))
    curve |= {name: moved(name, row) for name, row in content["coordinates"].items()}
    multipliers = [moved(name, content["multipliers"][name]) for name in motion.system.multipliers]
    yield from values_of_series(motion, curve, tuple(content["coordinates"]), multipliers, order)


def _changes(given: Polynomial, true: Polynomial) -> list[mp.mpf]:
    return [x - y for x, y in zip_longest(given, true, fillvalue=mp.zero)]


def _small() -> mp.mpf:
    return mp.mpf(10) ** (-mp.dps // 3)
