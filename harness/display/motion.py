"""A motion on the console: its power series, where a simulation ends and how well it was followed, a sweep of many."""

from collections.abc import Iterator, Mapping, Sequence
from math import isnan
from typing import TYPE_CHECKING

import mpmath

from ..hidden import visible_line

if TYPE_CHECKING:
    from rich.console import Console

    from ..series.power_series import Continuation, MotionSeries, Values
    from ..simulation.accuracy_check import AccuracyViolation
    from ..simulation.engines.choice import Choice
    from ..simulation.hybrid_motion import Switching
    from ..simulation.result import Report, Simulation
    from ..sweeps.run import Sweep


SHOWN_DIGITS = 12  # of numbers that would be longer than the next
SHOWN_TEXT = 24  # characters of an exact number


def show_series(console: "Console", motion: "MotionSeries", values: "Values | None" = None) -> None:
    """Print the power series of a motion, how far they hold, and values asked for."""
    from rich.table import Table

    from ..series.radius import described

    table = Table(
        "order", title=f"{visible_line(f'{motion.scene}: {motion.title}')}, about t = {motion.t0}", title_justify="left"
    )
    columns = dict(motion.all_series())
    for name in columns:
        table.add_column(name)
    for n, row in enumerate(zip(*columns.values(), strict=True)):
        table.add_row(str(n), *map(short_number, row))
    console.print(table)
    radius = motion.radius
    size = "" if radius.estimate is None else f"{radius.estimate:.8g}, {described(radius)}; "
    console.print(f"{motion.arithmetic} arithmetic; radius of convergence: {size}{radius.remark}", soft_wrap=True)
    if motion.switch is not None:
        console.print(f"This is the motion as long as {motion.switch} keeps its sign.", soft_wrap=True)
    for z in radius.singularities:
        console.print(f"    singularity at t - t0 = {z.real:.8g} {z.imag:+.8g} i")
    if values is not None:
        console.print(f"at t = {values.time}, leaving out terms of the size {values.truncation_error:.1g}:")
        for name, value in values.values.items():
            console.print(f"    {name} = {_rounded(value)}")
    if motion.continuation is not None:
        _show_continuation(console, motion.continuation)


def _show_continuation(console: "Console", continuation: "Continuation") -> None:
    from rich.table import Table

    names = [*continuation.coordinates, *continuation.velocities]
    table = Table("t", *names, title="Continued by further expansions", title_justify="left")
    rows = [continuation.instants, *continuation.coordinates.values(), *continuation.velocities.values()]
    for row in zip(*rows, strict=True):
        table.add_row(*(_rounded(mpmath.mpf(text)) for text in row))
    console.print(table)


def short_number(text: str) -> str:
    """Return a number in ``p/q`` or decimal notation: as it is where it is exact and short, else rounded."""
    from ..number_texts import number

    return text if len(text) <= SHOWN_TEXT and "." not in text else _rounded(number(text))


def _rounded(value: mpmath.mpf) -> str:
    return mpmath.nstr(value, SHOWN_DIGITS)


LISTED = 3  # instants that are told one by one


def show_simulation(console: "Console", simulation: "Simulation") -> None:
    """Print the end of a motion, and the report."""
    show_report(console, simulation.scene, simulation.title, simulation.report)


def show_report(console: "Console", scene: str, title: str, report: "Report") -> None:
    """Print the end of a scene's motion, and the report."""
    from rich.table import Table

    from ..simulation.output import report_document

    document = report_document(report)
    console.print(f"{visible_line(f'{scene}: {title}')}, at t = {document['t']}", soft_wrap=True)
    table = Table("", "", show_header=False)
    for group in ("coordinates", "velocities", "multipliers", "controls", "outputs", "sensitivities"):
        for name, value in document[group].items():
            joint = report.joints.get(name)
            table.add_row(visible_line(f"{name} ({joint})") if joint else name, str(value))
        table.add_section()
    console.print(table)
    for line in _quality(report):
        console.print(line, soft_wrap=True)


def _quality(report: "Report") -> Iterator[str]:
    from ..explanations import engine_text, remarks

    if report.correction is not None:
        name, size = report.correction
        yield f"The initial state misses the constraints in its last digits and is corrected, {name} most, by {size}."
    if report.moved is not None:
        name, size = report.moved
        yield f"The start differs from initial_guess most in {name}, by {size}."
    left = ", ".join(f"{name} {value:.1e}" for name, value in report.residuals.items())
    yield f"residuals of the constraints: {left}; condition number of G: {report.condition:.3g}"
    yield f"energy error: {report.energy_error:.1e}"
    steps = f"{report.steps} steps by {engine_text(report.legs)}"
    yield f"{steps}, in {report.precision} precision at tolerance {report.tol:.1e}"
    if report.choice is not None:
        yield _choice(report.choice)
    code = f" {report.code} code" if report.code else ""
    yield f"{report.compile_seconds:.3f} s to compile{code}, {report.run_seconds:.3g} s to run"
    yield from remarks(report)
    yield from _switchings(report.switchings)
    if report.relative_degrees:
        degrees = ", ".join(map(str, report.relative_degrees))
        yield f"The outputs of the servo-constraints have the relative degrees {degrees}."
    if report.ending is not None:
        yield _ending(report)


def _choice(choice: "Choice") -> str:
    """Why an engine was taken."""
    seconds = f"{choice.taylor:.2g} s by taylor, {choice.runge_kutta:.2g} s by runge-kutta with the C compiler"
    work = f"{choice.steps} steps of {choice.operations} operations"
    if choice.refused:
        return f"{choice.engine} is slower for {work}: {seconds}; but {choice.refused}"
    return f"{choice.engine} is quicker for {work}: {seconds}"


def _ending(report: "Report") -> str:
    """Why the motion ends where it does."""
    if report.ending.crossed is not None:
        return f"The motion ends at t = {float(report.t):.10g}, where {report.ending.crossed} crosses zero."
    of = report.ending.of
    never = f"{of[0]} does not cross zero" if len(of) == 1 else f"none of {', '.join(of)} crosses zero"
    return f"The motion ends with the time span at t = {float(report.t):.10g}; {never} before."


def _switchings(switchings: "Sequence[Switching]") -> Iterator[str]:
    """Yield what happened where the motion is not analytic."""
    for switching in switchings[:LISTED]:
        if switching.passage == "joint released":
            yield f"At t = {switching.t:.10g}, where {switching.function} crosses zero, a joint is released."
            continue
        yield f"At t = {switching.t:.10g} the surface {switching.function} = 0 is {_passed(switching.passage)}."
    if len(switchings) > LISTED:
        yield f"The motion switches {len(switchings)} times in all, the last time at t = {switchings[-1].t:.10g}."


def _passed(passage: str) -> str:
    return {"held": "reached, and held on to", "released": "left again"}.get(passage, passage)


def distrust(doubt: "AccuracyViolation") -> str:
    """Return the sentence that says why a motion is no result."""
    if isnan(doubt.missed):
        return f"holonom: this is no result: {doubt.reason}; end the run before that."
    return (
        f"holonom: this is no result: {doubt.reason}; take a smaller --max-step, another --engine or more --precision."
    )


def show_sweep(console: "Console", sweep: "Sweep", statuses: Mapping[str, int]) -> None:
    """Print where the rows are, and how many came about how."""
    from rich.table import Table

    document = sweep.document
    names = ", ".join(axis["asked"] for axis in document["parameters"])
    console.print(f"{document['scene']['name']}: {document['rows']} motions, {names}", soft_wrap=True)
    table = Table()
    table.add_column("status")
    table.add_column("rows", justify="right")
    for status, rows in statuses.items():
        table.add_row(status, str(rows))
    console.print(table)
    console.print(f"kept in {sweep.path}: {', '.join(document['columns'])}", soft_wrap=True)
