"""A series expansion at the initial time, summed at one time, order by order.

Maxima times its own expansions, exact and to a number of digits, without the derivation of the program. The double
precision ones are heyoka's.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import mpmath

from ...documents import ask
from ...formats import Document, read
from ...language import translatable
from ...number_texts import number, numbers
from ...program.motion_problem import MotionProblem
from ...program.precision import read_precision
from ...program.request import Request
from ...program.rewriting import computing
from ...schema import NumberText
from ...series.heyoka_series import expand, expanding_integrator
from ...series.request import EXACT
from ...source import Source
from ...structs import entry
from .measurement import WORKING_DIGITS, BenchmarkCase, Group, Measurement, Prepared, State, relative_error
from .operations import expansion_operations

if TYPE_CHECKING:
    from ...sandbox import Limits
    from .reference import Reference

ORDER_OF_RADIUS = 40  # of the expansion that the radius is estimated from
INSIDE = 0.5  # share of the radius at which the series are added up
ENTIRE = 1  # unit of time: where they are added up if no radius is known


@dataclass(frozen=True)
class SeriesCost:
    """An expansion in Maxima, with its time."""

    order: int = entry("Order of the expansion.")
    seconds: NumberText = entry("Of one expansion, without the derivation of the program.")
    coordinates: Mapping[str, tuple[NumberText, ...]] = entry("Coefficients of each coordinate, by its name.")


@dataclass(frozen=True)
class SeriesCosts:
    """Times of expansions of an initial motion in Maxima."""

    scene: str = entry("Name of the scene.")
    expansions: tuple[SeriesCost, ...] = entry("Time of each expansion.")


@dataclass(frozen=True)
class Expansion:
    """An expansion and the time at which it is summed."""

    problem: MotionProblem  # its motion program computes the accelerations alone
    time: Fraction


def expansion_of(problem: MotionProblem, until: Fraction) -> Expansion:
    """Choose the time of the sum: half the radius of convergence, or an earlier end.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    until : Fraction
        End of the motion, in the scene's unit.

    Returns
    -------
    Expansion

    Raises
    ------
    HolonomError
        The motion cannot be expanded.
    """
    alone = replace(problem, motion=computing(problem.motion, problem.accelerations))
    radius = expand(alone, ORDER_OF_RADIUS, read_precision("double")).radius
    step = ENTIRE if radius.estimate is None else INSIDE * radius.estimate
    begin = Fraction(problem.start["t"])
    return Expansion(alone, begin + min(Fraction(f"{step:.2g}"), until - begin))


def double_series(expansion: Expansion, orders: Sequence[int]) -> Iterator[BenchmarkCase]:
    """Yield expansions in double precision.

    Parameters
    ----------
    expansion : Expansion
        Motion and time of the sum.
    orders : sequence of int
        Orders of the expansions.

    Yields
    ------
    BenchmarkCase
        One for each order.
    """
    for order in orders:
        prepare = partial(_prepare_double, expansion, order)
        yield BenchmarkCase(
            Group.SERIES,
            translatable("series, double"),
            translatable("order %(order)s", order=order),
            expansion.time,
            prepare,
        )


def maxima_series(
    file: Source | Path,
    request: Request,
    limits: "Limits",
    expansion: Expansion,
    orders: Sequence[int],
    digits: int | str,
    reference: "Reference",
) -> Iterator[Measurement]:
    """Yield Maxima's expansions, timed by Maxima.

    Operations are those of one expansion. Rounded coefficients take at least two.

    Parameters
    ----------
    file : Source or Path
        Scene file.
    request : Request
        Scene, solve and settings.
    limits : Limits
        Limits of the run of Maxima.
    expansion : Expansion
        Motion and time of the sum.
    orders : sequence of int
        Orders of the expansions, ascending.
    digits : int or str
        Significant digits of the coefficients, or ``exact``.
    reference : Reference
        States to which errors refer.

    Yields
    ------
    Measurement
        One for each order.

    Raises
    ------
    HolonomError
        As `holonom.documents.ask`, or there are no exact coefficients.
    """
    asked = (request.scene, orders, digits)
    text = ask(Document.SERIES_COSTS, file, *asked, settings=request.settings, limits=limits)
    for each in read(Document.SERIES_COSTS, text, SeriesCosts).expansions:
        with mpmath.workdps(WORKING_DIGITS):
            rows = [numbers(texts) for texts in each.coordinates.values()]
            found = _added_up(rows, _step(expansion))
        yield Measurement(
            group=Group.SERIES,
            method=series_name(digits),
            setting=translatable("order %(order)s", order=each.order),
            time=expansion.time,
            error=relative_error(found, reference.states[expansion.time]),
            seconds=float(each.seconds),
            preparation_seconds=None,
            operations=expansion_operations(expansion.problem.motion, each.order),
        )


def series_name(digits: int | str) -> str:
    """Return the name of Maxima's series with given digits.

    Parameters
    ----------
    digits : int or str
        Significant digits of the coefficients, or ``exact``.

    Returns
    -------
    str
    """
    if digits == EXACT:
        return translatable("series, exact")
    return translatable("series, %(digits)s digits", digits=digits)


def _prepare_double(expansion: Expansion, order: int) -> Prepared:
    problem = expansion.problem
    integrator = expanding_integrator(problem, order, read_precision("double"))
    begin, start, n = integrator.time, integrator.state.copy(), len(problem.coordinates)

    def run() -> Any:
        integrator.time = begin
        integrator.state[:] = start
        integrator.step(write_tc=True)
        return integrator.tc[:n, : order + 1]

    def state(coefficients: Any) -> State:
        with mpmath.workdps(WORKING_DIGITS):
            return _added_up([list(map(mpmath.mpf, map(float, row))) for row in coefficients], _step(expansion))

    return Prepared(run, state, lambda: expansion_operations(problem.motion, order))


def _step(expansion: Expansion) -> mpmath.mpf:
    return number(str(expansion.time)) - number(expansion.problem.start["t"])


def _added_up(rows: Sequence[Sequence[mpmath.mpf]], step: mpmath.mpf) -> State:
    """Coordinates and velocities from the coefficients of the coordinates."""
    rates = [[n * c for n, c in enumerate(row)][1:] for row in rows]
    return [mpmath.polyval(row[::-1], step) for row in (*rows, *rates)]
