"""Rows of a sweep: the outputs of a motion, its status and constraint residual.

A row that cannot be computed gives the reason. All rows are written.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from fractions import Fraction
from functools import cached_property, reduce
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..explanations import unresolved
from ..failures import HolonomError
from ..language import translatable
from ..program.differentiation import derivative_name
from ..program.heyoka_function import import_heyoka
from ..program.motion_problem import MotionProblem, require_analytic
from ..program.motion_program import Expression, Name, Operation, Program, calls_of, names_in
from ..program.precision import read_precision
from ..program.rewriting import computing
from ..simulation.accuracy_check import MARGIN, expected, may_hide, relative_energy_error, trusted
from ..simulation.constraints.directions import is_indefinite, or_one
from ..simulation.control_matrix import controls_may_fail
from ..simulation.evaluation import Evaluation, in_full_vectors
from ..simulation.initial_state import InitialStates, started
from ..simulation.matrices import BatchMatrices
from ..simulation.nominal import (
    COARSE,
    Nominal,
    first_order_changes,
    nominal_at_each,
    nominal_of,
    with_nominal,
)
from ..simulation.request import SimulationRequest, Stabilization
from ..simulation.residuals import constraint_residuals
from ..simulation.simulate import last_time
from ..simulation.zeros import ZERO
from .axes import Axes
from .batch_engine import BatchEngine, Look
from .extremes import Steps, first_zero, largest, largest_size, zeros_with_end
from .outputs import ALONG, EXTREMES, Kind, OutputQuantity, not_an_output, words_in
from .quantities import (
    along_motion,
    expressions_of,
    forces_of,
    program_of,
    radicands_beyond_energy,
    require_known,
)
from .request import TOLERANCE
from .series import batch_radii
from .single import SingleMotions
from .time_watch import TimeWatch

if TYPE_CHECKING:
    import pyarrow

CORNERED = frozenset({Operation.ABS, Operation.SIGN, Operation.ARCTAN2})  # with corners, or jumps
TOUCHED = 1e-9  # of the largest argument of a root: the motion is integrated by itself, to see whether it is zero
GROUP = 10_000  # rows in memory at a time, whatever the chunk

OWN = ("row", str(Kind.RESIDUAL), "status", "note")  # columns of every sweep

Floats = NDArray[np.float64]


class Status(StrEnum):
    """The status of a row."""

    OK = "ok"
    UNDEFINED = "undefined"  # an output has no finite value
    INACCURATE = "inaccurate"  # the errors are too large for the tolerance
    NO_START = "no start"
    BROKEN_OFF = "broken off"


@dataclass(frozen=True)
class Plan:
    """A sweep as its workers get it."""

    problem: MotionProblem  # its open parameters are those that vary
    axes: Axes
    outputs: tuple[OutputQuantity, ...]
    tol: float = TOLERANCE  # tolerance of a step
    until: Fraction | None = None  # the last time; None for the end of the scene's time span
    stabilization: Stabilization = Stabilization.PROJECTION  # ``PROJECTION`` or ``NONE``


class RowMaker:
    """A maker of the rows of a plan. It compiles the plan's programs once.

    Raises
    ------
    HolonomError
        The initial state cannot be adapted to the parameters, the motion has no end, or an output is unknown.
    """

    def __init__(self, plan: Plan) -> None:
        quantities = [output.quantity for output in plan.outputs if output.quantity is not None]
        along = [output.quantity for output in plan.outputs if output.kind in ALONG]
        problem = self._problem = replace(plan.problem, recorded=program_of(along) if along else None)
        self.plan = plan
        require_known(problem, quantities)
        _require_smooth(problem, plan.outputs)
        self._starts, self._start = InitialStates(problem), float(problem.start["t"])
        self._derivatives = [output for output in plan.outputs if output.kind is Kind.DERIVATIVE]
        _require_directions(problem, self._derivatives)
        if problem.ends.released or any(output.kind is Kind.RADIUS for output in plan.outputs):
            require_analytic(problem)
        self._moves = any(output.kind is not Kind.RADIUS for output in plan.outputs)
        self._end = float(last_time(problem, plan.until, read_precision("double"))) if self._moves else self._start
        self._asked = sorted({self._end, *(self._time(output) for output in plan.outputs if output.kind is Kind.AT)})
        self._points = [output.quantity for output in plan.outputs if output.kind is Kind.AT]
        self._extremes = [output for output in plan.outputs if output.kind in EXTREMES]
        self._zeros = [output for output in plan.outputs if output.kind is Kind.ZERO]
        free = any(output.kind is Kind.FREE for output in plan.outputs)
        self._free = forces_of(problem) if free else ([], [])
        self._along = [*(output.quantity for output in self._extremes), *self._free[0], *self._free[1]]
        self._crossing = [output.quantity for output in self._zeros]
        roots = radicands_beyond_energy(problem)
        self._radicands = [] if roots is None else [Name(name) for name in roots.outputs]
        self._seen_outputs = [*self._extremes, *(each for each in plan.outputs if each.kind is Kind.FREE), *self._zeros]
        self._hides = may_hide(problem.matrices, ("t", *problem.parameters))
        if taken := [name for name in (*plan.axes.names, *self.columns) if name in OWN]:
            raise not_an_output(
                translatable("%(name)s is a column of every sweep; give another name to it", name=taken[0])
            )
        outputs = () if problem.outputs is None else problem.outputs.outputs
        for word in {*problem.state, *problem.parameters, *plan.axes.names, *outputs} & words_in(plan.outputs):
            raise not_an_output(
                translatable("%(name)s is a name of the scene, and a quantity of every sweep; rename it", name=word)
            )

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the output columns, in order."""
        names = [self._problem.state if output.kind is Kind.FINAL else (output.text,) for output in self.plan.outputs]
        return tuple(dict.fromkeys(name for group in names for name in group if name != Kind.RESIDUAL))

    def table(self, first: int, last: int) -> "pyarrow.Table":
        """Return the rows first, ..., last - 1.

        Parameters
        ----------
        first, last : int
            Row numbers, from zero.

        Returns
        -------
        Table
            Columns of outputs, residual, status and note.
        """
        import pyarrow as pa

        groups = [self._group(begin, min(begin + GROUP, last)) for begin in range(first, last, GROUP)]
        return pa.concat_tables(groups)

    def _group(self, first: int, last: int) -> "pyarrow.Table":
        import pyarrow as pa

        rows = _Rows(self.plan.axes.numbers(first, last), self.columns)
        with np.errstate(all="ignore"):
            self._fill(rows)
        arrays = {"row": pa.array(np.arange(first, last))}
        arrays |= {name: pa.array(x) for name, x in zip(self.plan.axes.names, rows.values, strict=True)}
        columns = {**rows.columns, "residual": rows.residual}
        for name, column in columns.items():
            missing = np.isnan(column)
            is_truth = any(output.text == name and output.kind is Kind.FREE for output in self.plan.outputs)
            arrays[name] = pa.array(column == 1 if is_truth else column, mask=missing)
        arrays["status"] = pa.array(list(map(str, Status))).take(pa.array(rows.statuses))
        arrays["note"] = pa.array(rows.notes, pa.string())
        return pa.table(arrays)

    # ---- rows ----

    def _fill(self, rows: "_Rows") -> None:
        starts = self._starts(rows.values)
        rows.mark(~starts.found, Status.NO_START, "no state was found that satisfies the initial constraints")
        there = np.flatnonzero(starts.found)
        if len(there) and any(output.kind is Kind.RADIUS for output in self.plan.outputs):
            name = next(output.text for output in self.plan.outputs if output.kind is Kind.RADIUS)
            rows.columns[name][there] = batch_radii(self._problem, starts.states[:, there], rows.values[:, there])
        if not self._moves:
            states = starts.states[:, there]
            at = self._batch_matrices(self._start, states, rows.values[:, there])
            nominal = nominal_at_each(self._problem, at.mass, at.jacobian, states, rows.values[:, there], 0.0)
            left = constraint_residuals(at, states, nominal)
            rows.residual[there] = np.maximum(left["position"], left["velocity"])
            return
        for row in self._left_alone(rows, there, starts.states):
            self._by_itself(rows, row, starts.states[:, row])

    def _left_alone(self, rows: "_Rows", there: NDArray, states: Floats) -> NDArray:
        """Integrate rows in batches if possible, and return the other rows."""
        if not self._batched or not len(there):
            return there
        alone, stops = self._watch.look(rows.values[:, there])
        together = there[~alone]
        if not len(together):
            return there
        left = self._together(rows, together, states[:, together], stops)
        return np.concatenate([there[alone], left])

    @property
    def _batched(self) -> bool:
        """True if the batch engine can integrate motions of the problem."""
        problem = self._problem
        ends_smoothly = problem.ends.events is None or not _has_corners(problem.ends.events)
        alone = problem.switching or problem.tables or problem.obstruction is not None or controls_may_fail(problem)
        return ends_smoothly and not alone and not self._hides and not self._derivatives

    def _together(self, rows: "_Rows", there: NDArray, states: Floats, stops: Sequence[float]) -> NDArray:
        """Integrate motions in batches, and return the rows that need another method."""
        values = rows.values[:, there]
        start = self._batch_matrices(self._start, states, values), states
        initial = start[0].mass, start[0].jacobian
        nominal = nominal_at_each(self._problem, *initial, states, values, self._end - self._start)
        apart = (nominal.state * COARSE < nominal_of(self._common).state[:, None]).any(axis=0)
        apart |= is_indefinite(start[0].mass)
        if apart.any():
            rest = there[~apart]
            left = self._together(rows, rest, states[:, ~apart], stops) if len(rest) else rest
            return np.concatenate([there[apart], left])
        stops = [t for t in stops if t < self._end]
        ends, ended = self._ends(states, values, nominal, stops)
        times = sorted({*self._asked, *stops})
        stops = [np.minimum(time, ends) for time in times] if self._problem.ends.until else times
        found = self._engine.integrate(states, values, stops)
        end = self._batch_matrices(ends, found.states[-1], values), found.states[-1]
        stopped = expected(self.plan.tol, found.steps) * nominal.velocities
        left = constraint_residuals(*end, nominal)
        energy = relative_energy_error(start, end, found.energy_error, found.exchanged, stopped)
        residual = np.maximum(left["position"], left["velocity"])
        well = ended & found.arrived & trusted({**left, "energy": energy}, self.plan.tol, found.steps)
        done = there[well]
        at = dict(zip(times, found.states, strict=True))
        points = {
            stop: self._values(self._points, np.minimum(stop, ends), at[stop], values)[:, well] for stop in self._asked
        }
        rows.residual[done] = residual[well]
        self._keep(rows, done, ends[well], at[self._end][:, well], points)
        seen = found.seen[len(self._radicands) :]
        if self._crossing:
            last = self._values(self._crossing, ends, at[self._end], values)
            zeros, sizes = np.split(seen[-2 * len(last) :], 2)
            zeros[...] = zeros_with_end(zeros, np.where(ends < self._end, ends, np.nan), last, sizes)
            seen = self._without_rounding(seen, self._crossing, states, values, nominal)
        self._keep_along(rows, done, seen[:, well])
        return there[~well]

    def _ends(
        self, states: Floats, values: Floats, nominal: Nominal, stops: Sequence[float]
    ) -> tuple[Floats, NDArray[np.bool_]]:
        """Return the end times of motions, and True for each that is known."""
        k = states.shape[1]
        if not self._problem.ends.until:
            return np.full(k, self._end), np.ones(k, dtype=bool)
        found = self._ending_engine.integrate(states, values, [*stops, self._end])
        zeros = self._without_rounding(found.seen, self._events, states, values, nominal)
        return np.fmin(self._end, np.fmin.reduce(zeros)), found.arrived

    def _without_rounding(
        self, seen: Floats, quantities: Sequence[Expression], states: Floats, values: Floats, nominal: Nominal
    ) -> Floats:
        """Return recorded numbers, zeros among rounding errors left out.

        The last numbers, one for each quantity, are its largest sizes. Before them come its zeros.
        """

        def at(times: Floats, states: Floats) -> Floats:
            return self._values(quantities, times, states, np.tile(values, states.shape[1] // values.shape[1]))

        changes = first_order_changes(at, np.full(states.shape[1], self._start), states, nominal)
        count = len(changes)
        seen, largest = seen[: len(seen) - count].copy(), seen[len(seen) - count :]
        seen[len(seen) - count :][largest <= ZERO * changes] = np.nan
        return seen

    def _by_itself(self, rows: "_Rows", row: int, state: Floats) -> None:
        problem = self._started(rows.values[:, row], state)
        if self._derivatives:
            problem = replace(problem, observe=(*problem.observe, "trajectory", "multipliers"))
        try:
            found = self._singles.integrate(problem, self._asked)
        except HolonomError as error:
            rows.mark(np.array([row]), Status.BROKEN_OFF, error.reason)
            return
        here, report = np.array([row]), found.report
        rows.residual[row] = max(report.residuals["position"], report.residuals["velocity"])
        if report.unresolved is not None:
            rows.mark(here, Status.OK, unresolved(report.unresolved))
        if report.violations:
            rows.mark(here, Status.INACCURATE, "; ".join(violation.reason for violation in report.violations))
        points = {stop: found.points[place][:, None] for place, stop in enumerate(self._asked)}
        self._keep(rows, here, np.array([report.t]), found.state[:, None], points)
        made = list(self._numbers(found.steps))
        for output, (number, resolved) in zip(self._seen_outputs, made, strict=False):
            if np.isfinite(number) and not resolved:
                rows.mark(here, Status.INACCURATE, f"{output.text} changes too fast along the motion")
        self._keep_along(rows, here, [*(number for number, _ in made), *found.zeros[:, None]])
        for output in self._derivatives:
            number = report.sensitivities[derivative_name(output.quantity.text, output.direction)]
            rows.record(output.text, here, np.array([number]), there_is=True)

    # ---- recorded outputs ----

    def _keep(
        self, rows: "_Rows", there: NDArray, ends: Floats, states: Floats, points: Mapping[float, Floats]
    ) -> None:
        """Record numbers at the ends, shape (k,), and at times that are not after them."""
        place = 0
        for output in self.plan.outputs:
            if output.kind is Kind.FINAL:
                for name, numbers in zip(self._problem.state, states, strict=True):
                    rows.columns[name][there] = numbers
            elif output.kind is Kind.AT:
                reached = output.time is None or float(output.time) <= ends
                rows.record(output.text, there, points[self._time(output)][place], there_is=reached)
                place += 1

    def _keep_along(self, rows: "_Rows", there: NDArray, seen: Sequence[Floats]) -> None:
        """Record numbers of quantities along the motion, each of shape (k,)."""
        for output, numbers in zip(self._seen_outputs, seen, strict=True):
            rows.record(output.text, there, numbers, there_is=(output.kind is not Kind.ZERO) | ~np.isnan(numbers))

    def _look(self, steps: list[Steps]) -> Floats:
        """Return the numbers made of quantities, infinite if polynomials do not decide.

        Before them come the least arguments of roots, infinite if they touch zero.
        """
        roots, along = steps[: len(self._radicands)], steps[len(self._radicands) :]
        made = [np.where(resolved, number, np.inf) for number, resolved in self._numbers(along[: len(self._along)])]
        return np.array([*map(_least_or_zero, roots), *made, *_zeros(along[len(self._along) :])])

    def _numbers(self, steps: list[Steps]) -> Iterator[tuple[Floats, NDArray[np.bool_]]]:
        """Yield the largest, least and mean values, each with True where it is resolved.

        Both have the shape (elements,). Last comes 1 for free motions.
        """
        looks, fields = steps[: len(self._extremes)], steps[len(self._extremes) :]
        for output, along in zip(self._extremes, looks, strict=True):
            yield _made(output.kind, along), along.resolved()
        if fields:
            sizes = [largest_size(along) for along in fields]
            reactions, others = sizes[: len(self._free[0])], sizes[len(self._free[0]) :]
            forces = or_one(np.max(others, axis=0, initial=0.0))
            free = np.max(reactions, axis=0, initial=0.0) <= MARGIN * self.plan.tol * forces
            yield free.astype(float), np.all([along.resolved(forces) for along in fields], axis=0)

    def _time(self, output: OutputQuantity) -> float:
        """Return the time at which to evaluate a quantity.

        Raises
        ------
        HolonomError
            The motion does not reach there.
        """
        time = self._end if output.time is None else float(output.time)
        if not self._start <= time <= self._end:
            span = f"{self._start:.10g} to {self._end:.10g}"
            raise not_an_output(
                translatable("%(text)s asks for a time outside of the motion, %(span)s", text=output.text, span=span)
            )
        return time

    # ---- compiled when first needed ----

    @cached_property
    def _batch_matrices(self) -> BatchMatrices:
        return BatchMatrices(self._problem)

    @cached_property
    def _common(self) -> MotionProblem:
        """The problem with the nominal sizes of the sweep's middle row."""
        middle = self.plan.axes.rows // 2
        values = self.plan.axes.numbers(middle, middle + 1)
        starts = self._starts(values)
        if not starts.found[0]:
            return self._problem
        motion = self._started(values[:, 0], starts.states[:, 0])
        return replace(self._problem, nominal=with_nominal(motion, self._end - self._start).nominal)

    def _started(self, values: Floats, state: Floats) -> MotionProblem:
        """Return the motion of one row."""
        numbers = {name: Fraction(float(x)) for name, x in zip(self._problem.parameters, values, strict=True)}
        return started(self._problem, numbers, state)

    @cached_property
    def _engine(self) -> BatchEngine:
        return self._looking_at([*self._radicands, *self._along, *self._crossing], self._look)

    @cached_property
    def _ending_engine(self) -> BatchEngine:
        return self._looking_at(self._events, lambda steps: np.array(_zeros(steps)))

    @property
    def _events(self) -> list[Expression]:
        return [Name(f"event[{place}]") for place, _ in enumerate(self._problem.ends.until, start=1)]

    def _looking_at(self, along: Sequence[Expression], look: Look) -> BatchEngine:
        projects = self.plan.stabilization is Stabilization.PROJECTION
        return BatchEngine(self._common, self.plan.tol, projects, along, look)

    def _values(self, quantities: Sequence[Expression], times: Floats, states: Floats, values: Floats) -> Floats:
        """Return quantities of motions, shape (quantities, k)."""
        if not quantities:
            return np.empty((0, len(times)))
        evaluate = self._problem.once(
            ("quantities", *quantities), self._problem.motion, lambda: self._compiled(quantities)
        )
        return evaluate(np.concatenate([times[None], states, values]))

    def _compiled(self, quantities: Sequence[Expression]) -> Evaluation:
        heyoka = import_heyoka()
        known = {name: heyoka.expression(name) for name in ("t", *self._problem.state, *self._problem.parameters)}
        found = expressions_of(quantities, along_motion(self._problem, known))
        return in_full_vectors(heyoka.cfunc(found, vars=list(known.values())))

    @cached_property
    def _singles(self) -> SingleMotions:
        directions = tuple(dict.fromkeys(output.direction for output in self._derivatives))
        request = SimulationRequest(
            tol=self.plan.tol, stabilization=self.plan.stabilization, until=self.plan.until, sensitivities=directions
        )
        return SingleMotions(self._problem, request, self._along, self._crossing, self._points)

    @cached_property
    def _watch(self) -> TimeWatch:
        return TimeWatch(self._problem, self._end)


def _require_smooth(problem: MotionProblem, recorded: Sequence[OutputQuantity]) -> None:
    """Reject outputs along the motion that polynomials of steps do not represent."""
    for each in recorded:
        if each.kind not in ALONG or problem.outputs is None:
            continue
        for name in sorted(names_in(each.quantity) & set(problem.outputs.outputs)):
            if _has_corners(computing(problem.outputs, {name})):
                raise not_an_output(
                    translatable(
                        "%(text)s contains %(name)s, which has a corner and can be recorded at times only",
                        text=each.text,
                        name=name,
                    )
                )


def _require_directions(problem: MotionProblem, derivatives: Sequence[OutputQuantity]) -> None:
    """Reject derivatives of unknown quantities, and by unknown directions.

    State, multipliers and outputs have derivatives. Parameters and state are directions.
    """
    outputs = () if problem.outputs is None else problem.outputs.outputs
    for output in derivatives:
        for name, known in (
            (output.quantity.text, (*problem.state, *problem.reactions, *outputs)),
            (output.direction, (*problem.parameters, *problem.state)),
        ):
            if name not in known:
                raise not_an_output(
                    translatable(
                        "%(text)s contains %(name)s: expected one of %(names)s",
                        text=output.text,
                        name=name,
                        names=", ".join(known),
                    )
                )


def _has_corners(program: Program) -> bool:
    """Return True if a program is not analytic at a sign or at a branch cut.

    Polynomials of steps represent one side of it.
    """
    return any(call.operation in CORNERED for call in calls_of(program))


class _Rows:
    """Rows with their outputs, statuses and notes.

    Parameters
    ----------
    values : ndarray, shape (p, k)
    """

    def __init__(self, values: Floats, columns: tuple[str, ...]) -> None:
        self.values, k = values, values.shape[1]
        self.columns = {name: np.full(k, np.nan) for name in columns}
        self.residual = np.full(k, np.nan)
        self.statuses, self.notes = np.zeros(k, dtype=np.int8), np.full(k, None, dtype=object)

    def record(self, name: str, rows: NDArray, numbers: Floats, there_is: bool | NDArray[np.bool_]) -> None:
        """Record finite values of an output, and mark rows that lack one."""
        finite = np.isfinite(numbers)
        self.columns[name][rows] = np.where(finite & there_is, numbers, np.nan)
        self.mark(rows[~finite & there_is], Status.UNDEFINED, f"{name} has no finite value")

    def mark(self, rows: NDArray, status: Status, note: str) -> None:
        """Set the status and the note of rows."""
        self.statuses[rows], self.notes[rows] = list(Status).index(status), note


def _made(kind: Kind, along: Steps) -> Floats:
    """Return the largest, least or mean value of a quantity for each element."""
    match kind:
        case Kind.MAX:
            return largest(along)
        case Kind.MIN:
            return -largest(along.negative())
        case Kind.LARGEST:
            return largest_size(along)
        case _:
            return _mean(along)


def _least_or_zero(along: Steps) -> Floats:
    """Return the least value of a positive quantity, infinite if it may touch zero."""
    least = -largest(along.negative())
    return np.where(along.resolved() & (least > TOUCHED * largest_size(along)), least, np.inf)


def _zeros(steps: Sequence[Steps]) -> list[Floats]:
    """Return the first zeros of quantities, then their largest sizes."""
    return [*map(_zero, steps), *map(largest_size, steps)]


def _zero(along: Steps) -> Floats:
    """Return the first zero of a quantity, infinite if polynomials do not decide."""
    finite = np.isfinite(along.coefficients).all(axis=(0, 1))
    found = np.where(finite, first_zero(along), np.inf)
    return np.where(along.resolved_until(found), found, np.inf)


def _mean(along: Steps) -> Floats:
    """Return the integral of the polynomials, by the time that they take."""
    powers = range(1, len(along.coefficients) + 1)
    integral = sum((c * ((1.0 - along.least**k) / k) for k, c in zip(powers, along.coefficients, strict=True)))
    return reduce(np.add, integral * along.length) / reduce(np.add, along.length * (1.0 - along.least))
