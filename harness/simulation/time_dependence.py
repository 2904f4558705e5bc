"""Time dependence of a motion: its speed, and the time span in which it is smooth.

An integrator chooses its steps by values at their beginnings and stages. It misses a pulse that is over before the next
step begins. So the expressions of t alone in the equations of motion are examined beforehand. The time span is halved
until a polynomial of degree 32 represents each of them on every part, to `RESOLVED` of its largest value, and none is
constant in the first half of a part and changes in the second. If parts are much shorter than the time span, or differ
from their neighbours, steps are to end at their boundaries: an expression that changes as fast everywhere may be too
faint for the steps, and a pulse cannot be distinguished from it. An expression that needs more than 32768 parts is not
resolved, which is reported: a jump in it is not found.

A feature of such an expression is not missed if it lasts longer than 1/32768 of the time span and is larger than
`RESOLVED` of the expression's largest value. Shorter ones are found if they are near one of the samples.
"""

from collections.abc import Callable, Iterator, Sequence, Set
from dataclasses import replace
from itertools import chain, pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ..language import translatable
from ..program.motion_problem import MotionProblem
from ..program.motion_program import Call, Expression, Name, Program, names_in
from ..program.table import Table
from ..program.table_numbers import TimeFunction
from .matrices import Vector

DEGREE = 32
SAMPLES = 2**15  # of the time span, at least
HIDDEN = 1e-3  # of what an expression does in the second half of a part: too little in the first to announce it
FAINT = 1e-14  # of the largest value: what need not be announced
FRESH = 64  # samples of a part, at least
RESOLVED = 1e-11
FINEST = 40  # halvings; a function that is not resolved then is not smooth
MOST = SAMPLES  # parts of the same length that are looked at
BLOCK = 2**13  # parts that are looked at together
MUCH = 8  # times shorter than the time span: a part that no step is to pass
EPSILON = 1e-14  # relative rounding of a time, with a margin
NEARLY_ALL = 0.99  # of the samples that estimate the rounding of an expression
SOME, SHORT_TIME = 8, 2.0**-40  # of the samples these are; of the time span, over which they are compared
ROUNDED, BESIDE_ROUNDING = 32.0, 1e5  # times this rounding: an error that is none; the least size of an expression
JUMP = 1e-3  # of the largest value: an error larger than rounding
NOT_SMOOTH = translatable("an expression of the time in the equations of motion is not smooth")
UNBOUNDED = translatable("an expression of the time in the equations of motion grows beyond all bounds")
BESIDE, NEARER = 1e-9, 1e-3  # of the lengths of two parts: how near to their boundary they are compared; and of that
SHOWN = 1e-6  # relative error of a polynomial that shows how large an expression is
BEYOND = 1e6  # times what an expression usually is: it has no bound

NODES = chebyshev.chebpts1(DEGREE + 1)
TO_COEFFICIENTS = np.linalg.inv(chebyshev.chebvander(NODES, DEGREE))


class TimeDependence(NamedTuple):
    """The dependence of a motion on the time alone."""

    stops: tuple[float, ...] = ()  # times at which steps are to end, in order
    # the first time at which an expression of the time has no value, no bound, or jumps; None where there is none
    end: float | None = None
    reason: str = ""  # a clause about that time
    unresolved: float | None = None  # the first time from which an expression changes too fast to be looked at

    def ended_by(self, other: "TimeDependence") -> "TimeDependence":
        """Return this dependence, with the first end of both.

        Parameters
        ----------
        other : TimeDependence

        Returns
        -------
        TimeDependence
        """
        if other.end is None or (self.end is not None and self.end <= other.end):
            return self
        return self._replace(end=other.end, reason=other.reason)


def time_dependence(program: Program, start: float, end: float, tables: Sequence[Table] = ()) -> TimeDependence:
    """Examine the expressions of time alone, ``t``, and of tables in a program.

    Parameters
    ----------
    program : Program
        Program with the equations of motion.
    start : float
        First time.
    end : float
        Last time.
    tables : sequence of Table
        Tables whose polynomials the program takes.

    Returns
    -------
    TimeDependence
    """
    expressions = time_expressions(program, tables)
    if not start < end or not expressions.outputs:
        return TimeDependence()
    knots = sorted({t for table in tables for t in map(float, table.knots) if start < t < end})
    return _Scan(TimeFunction(expressions, tables), start, end, np.array(knots)).result()


def time_dependence_of_motion(
    problem: MotionProblem, with_values: Callable[[Program], Program], start: float, end: float
) -> TimeDependence:
    """Examine the equations of motion, events, outputs and recorded quantities.

    Parameters
    ----------
    problem : MotionProblem
    with_values : callable
        Puts the values of open parameters into a program.
    start : float
        First time.
    end : float
        Last time.

    Returns
    -------
    TimeDependence
        Only the equations of motion end it.
    """
    found, *others = (
        time_dependence(with_values(program), start, end, problem.tables) for program in time_programs(problem)
    )
    return found._replace(stops=tuple(sorted({*found.stops, *chain.from_iterable(each.stops for each in others)})))


def time_programs(problem: MotionProblem) -> list[Program]:
    """Return the programs whose expressions of time are examined.

    Parameters
    ----------
    problem : MotionProblem

    Returns
    -------
    list of Program
        That of the equations of motion first.
    """
    others = problem.ends.events, problem.outputs, problem.recorded
    return [problem.matrices, *(each for each in others if each is not None)]


def time_expressions(program: Program, tables: Sequence[Table] = ()) -> Program:
    """Return the expressions of time alone that other expressions of a program use.

    Parameters
    ----------
    program : Program
    tables : sequence of Table
        Tables whose polynomials the program takes.

    Returns
    -------
    Program
        Its inputs are ``t`` and those of the tables.
    """
    inputs = ("t", *(name for table in tables for name in table.inputs))
    known, remaining, used = set(inputs), [], {}
    for name, expression in program.assignments:
        if (names := names_in(expression)) and names <= known:
            known.add(name)
            remaining.append((name, expression))
        else:
            used |= dict.fromkeys(largest_parts(expression, known))
    outputs = {name: value for name, value in program.outputs.items() if names_in(value) & known}
    used |= dict.fromkeys(outputs.values())
    for name in inputs:
        used.pop(Name(name), None)
    named = [(f"of_time[{index}]", expression) for index, expression in enumerate(used)]
    return replace(
        program,
        inputs=inputs,
        assignments=(*remaining, *named),
        outputs={name: Name(name) for name, _ in named},
    )


def largest_parts(expression: Expression, known: Set[str]) -> Iterator[Expression]:
    """Yield the largest parts of an expression that are of the time alone.

    Parameters
    ----------
    expression : Expression
        Expression to search.
    known : set of str
        Names that depend on the time alone.

    Yields
    ------
    Expression
    """
    names = names_in(expression)
    if names and names <= known:
        yield expression
    elif isinstance(expression, Call) and not names.isdisjoint(known):
        for argument in expression.arguments:
            yield from largest_parts(argument, known)


class _Scan:
    """A scan that halves the time span until every part is resolved.

    It is first cut at knots, at which steps end anyway.
    """

    def __init__(self, function: TimeFunction, start: float, end: float, knots: Vector) -> None:
        self._function, self._start, self._last, self._knots = function, start, end, knots
        self._ending: tuple[float, str] | None = None
        self._unresolved: float | None = None
        cells = (np.arange(SAMPLES) + 0.5) / SAMPLES
        values = function(start + (end - start) * cells)
        finite = np.isfinite(values).all(axis=0)
        if not finite.all():
            first = int(np.argmin(finite))
            self._last = self._last_value(start + (end - start) * max(0.0, cells[first] - 1 / SAMPLES), cells[first])
            self._ending = self._last, "an expression of the time in the equations of motion has no real, finite value"
            values = function(start + (self._last - start) * cells)
        self._grid = values
        self._rounding = self._rounding_of(start + (self._last - start) * cells[::SOME])
        self._scale = np.maximum(np.max(np.abs(values), axis=1), BESIDE_ROUNDING * self._rounding)
        self._usual = np.partition(np.abs(values), SAMPLES // 2, axis=1)[:, SAMPLES // 2]
        self._bases, self._spans = self._cut()

    def result(self) -> TimeDependence:
        parts = sorted(self._parts())
        self._look_between(parts)
        knots, short = set(self._knots.tolist()), (self._last - self._start) / MUCH
        halved = float(np.max(self._spans))
        stops = [
            start
            for (_, before), (start, length) in pairwise(parts)
            if (before != length or (length <= short and length < halved)) and start not in knots
        ]
        end, reason = self._ending or (None, "")
        stops = tuple(float(t) for t in stops if end is None or t < end)
        return TimeDependence(stops, end and float(end), reason, self._unresolved)

    def _rounding_of(self, times: Vector) -> Vector:
        """Return the rounding errors of each expression, shape (expressions,).

        They are its third differences over very short times, which smooth functions do not have. The times have all
        digits: between those of few digits rounding may be the same.
        """
        at = times + (times[1] - times[0]) / np.pi
        step = np.pi * max(SHORT_TIME * (self._last - self._start), 16 * np.spacing(np.max(np.abs(at))))
        with np.errstate(all="ignore"):
            first, second, third, fourth = (self._function(at + place * step) for place in range(4))
            errors = np.abs(fourth - first + 3 * (second - third)) / 8
        errors[~np.isfinite(errors)] = 0.0
        usual = np.quantile(errors, NEARLY_ALL, axis=1)
        return np.where(usual > 0, usual, np.max(errors, axis=1))

    def _cut(self) -> tuple[Vector, Vector]:
        """Return beginnings and lengths of the parts to be halved.

        Between knots, they are as long as this many new samples allow.
        """
        inner = self._knots[self._knots < self._last]
        edges = np.array([self._start, *inner, self._last])
        lengths = np.diff(edges)
        if not inner.size:
            return edges[:1], lengths
        counts = np.ceil(lengths * (SAMPLES / FRESH) / (self._last - self._start)).astype(int)
        lengths = np.repeat(lengths / counts, counts)
        within = np.arange(len(lengths)) - np.repeat(np.cumsum(counts) - counts, counts)
        return np.repeat(edges[:-1], counts) + within * lengths, lengths

    def _parts(self) -> Iterator[tuple[float, float]]:
        """Start and length of each part."""
        owners = np.arange(len(self._bases))
        places, most = np.zeros_like(owners), MOST + 2 * len(self._bases)
        for level in range(FINEST + 1):
            starts, lengths = self._starts(owners, places, level)
            error, open_ = self._errors(owners, places, level)
            if level == FINEST:
                self._look_at(starts[open_], error[:, open_])
            elif 2 * open_.sum() > most:
                self._unresolved = float(starts[open_].min())
            if level == FINEST or self._unresolved is not None:
                open_[:] = False
            yield from zip(starts[~open_], lengths[~open_], strict=True)
            owners = np.tile(owners[open_], 2)
            places = np.concatenate([2 * places[open_], 2 * places[open_] + 1])
            if not places.size:
                return

    def _starts(self, owners: np.ndarray, places: np.ndarray, level: int) -> tuple[Vector, Vector]:
        """Return starts and lengths of parts."""
        lengths = self._spans[owners] / 2**level
        return self._bases[owners] + places * lengths, lengths

    def _errors(self, owners: np.ndarray, places: np.ndarray, level: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the errors of polynomials on parts, and the parts to be halved.

        The errors have shape (expressions, parts).
        """
        blocks = range(0, len(places), BLOCK)
        found = [self._errors_in(owners[at : at + BLOCK], places[at : at + BLOCK], level) for at in blocks]
        errors, open_ = zip(*found, strict=True)
        return np.concatenate(errors, axis=1), np.concatenate(open_)

    def _errors_in(self, owners: np.ndarray, places: np.ndarray, level: int) -> tuple[np.ndarray, np.ndarray]:
        starts, lengths = self._starts(owners, places, level)
        values = self._values(starts, lengths, (NODES + 1) / 2)
        count = SAMPLES >> level
        if count >= FRESH and len(self._bases) == 1:
            cells = (np.arange(count) + 0.5) / count
            expected = self._grid.reshape(len(self._grid), 2**level, count)[:, places]
        else:
            cells = (np.arange(FRESH) + 0.5) / FRESH
            expected = self._values(starts, lengths, cells)
        with np.errstate(all="ignore"):
            found = (values @ TO_COEFFICIENTS.T) @ chebyshev.chebvander(2 * cells - 1, DEGREE).T
            error = np.max(np.abs(found - expected), axis=2)
            largest = np.max(np.abs(values), axis=2)
            counts = np.isfinite(largest) & (error <= SHOWN * largest)  # a pole's values never do
            self._scale = np.fmax(self._scale, np.max(np.where(counts, largest, 0.0), axis=1))
            scale = np.fmax(largest, self._scale[:, None])
            rounding = EPSILON * max(abs(self._start), abs(self._last)) * np.ptp(values, axis=2)
            noise = ROUNDED * self._rounding[:, None]
            allowed = RESOLVED * scale + rounding / lengths + noise
            early, late = (np.ptp(half, axis=2) for half in (values[..., : DEGREE // 2], values[..., DEGREE // 2 :]))
            hidden = (early < HIDDEN * late) & (late > FAINT * scale + noise)
        error = np.where(np.isfinite(error), error, np.inf)
        return error, ((error > np.where(np.isfinite(allowed), allowed, 0.0)) | hidden).any(axis=0)

    def _values(self, starts: Vector, lengths: Vector, cells: Vector) -> np.ndarray:
        """Return values at equal places of each part, shape (expressions, parts, cells)."""
        return self._function(starts[:, None] + lengths[:, None] * cells)

    def _look_at(self, starts: Vector, error: np.ndarray) -> None:
        """Distinguish poles and jumps from rounding in parts without a close polynomial."""
        for place in np.argsort(starts, kind="stable"):
            t, missed = starts[place], error[:, place]
            if (missed > BEYOND * self._usual).any():
                reason = UNBOUNDED
            elif (missed > JUMP * self._scale).any():
                reason = NOT_SMOOTH
            else:
                continue
            if self._ending is None or t < self._ending[0]:
                self._ending = float(t), reason
            return

    def _look_between(self, parts: list[tuple[float, float]]) -> None:
        """Find jumps at the boundary of two parts.

        A steep function changes less nearby.
        """
        starts, lengths = np.array(parts).T
        beside = BESIDE * np.minimum(lengths[:-1], lengths[1:])
        seen = NEARER * beside > EPSILON * np.abs(starts[1:])
        edges, beside = starts[1:][seen], beside[seen]
        if not edges.size:
            return
        change, nearer = (self._change_across(edges, width) for width in (beside, NEARER * beside))
        jumps = ((change > JUMP * self._scale[:, None]) & (nearer > change / 2)).any(axis=0)
        if jumps.any():
            t = edges[jumps][0]
            if self._ending is None or t < self._ending[0]:
                self._ending = float(t), NOT_SMOOTH

    def _change_across(self, edges: Vector, beside: Vector) -> np.ndarray:
        with np.errstate(all="ignore"):
            return np.abs(self._function(edges + beside) - self._function(edges - beside))

    def _last_value(self, before: float, cell: float) -> float:
        """Return the last time with finite values, between a finite and a non-finite one."""
        after = self._start + (self._last - self._start) * cell
        while before < (middle := (before + after) / 2) < after:
            if np.isfinite(self._function(np.array([middle]))).all():
                before = middle
            else:
                after = middle
        return before
