"""Print power series, simulations with their reports, and sweeps on the console."""

from collections.abc import Iterator, Mapping, Sequence
from math import isnan
from typing import TYPE_CHECKING

from ..hidden import visible_line
from .heading import heading
from .text import counted

if TYPE_CHECKING:
    import mpmath
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
    """Print the power series of a motion, their radii, and requested values.

    Parameters
    ----------
    console : Console
        Console to print on.
    motion : MotionSeries
        The power series.
    values : Values or None
        Sums at one time.
    """
    from ..series.radius import described

    columns = {**motion.coordinates, **motion.multipliers, **motion.constraint_forces, **motion.controls}
    title = f"{heading(motion.scene, motion.title)}, about t = {motion.t0}"
    _show_coefficients(console, title, columns)
    directions = dict.fromkeys(_direction(name) for name in motion.sensitivities)
    for direction in directions:
        derivatives = {name: row for name, row in motion.sensitivities.items() if _direction(name) == direction}
        _show_coefficients(console, f"Derivatives by {visible_line(direction)}", derivatives)
    radius = motion.radius
    size = "" if radius.estimate is None else f"{radius.shown}, "
    if radius.estimate is not None and not radius.located:  # the note of one that is located is its evidence
        size += f"{described(radius)}; "
    console.print(f"{motion.arithmetic} arithmetic; radius of convergence: {size}{radius.note}", soft_wrap=True)
    if motion.switch is not None:
        until = f"as long as {motion.switch} keeps its sign"
        console.print(f"From t = {motion.t0} on this is the motion, {until}.", soft_wrap=True)
    for z in radius.singularities:
        console.print(f"    singularity at t - t0 = {z.real:.8g} {z.imag:+.8g} i")
    if values is not None:
        console.print(f"at t = {values.time}, leaving out terms of the size {values.truncation_error:.1g}:")
        for name, value in values.values.items():
            console.print(f"    {name} = {_rounded(value)}")
    if motion.continuation is not None:
        _show_continuation(console, motion.continuation)


def _direction(name: str) -> str:
    """Return m of ``d(x, m)``."""
    return name[:-1].rpartition(", ")[2]


def _show_coefficients(console: "Console", title: str, columns: Mapping[str, Sequence[str]]) -> None:
    from rich.table import Table

    table = Table("order", *columns, title=title, title_justify="left")
    for n, row in enumerate(zip(*columns.values(), strict=True)):
        table.add_row(str(n), *map(short_number, row))
    console.print(table)


def _show_continuation(console: "Console", continuation: "Continuation") -> None:
    import mpmath
    from rich.table import Table

    names = [*continuation.coordinates, *continuation.velocities]
    table = Table("t", *names, title="Continued by further expansions", title_justify="left")
    rows = [continuation.times, *continuation.coordinates.values(), *continuation.velocities.values()]
    for row in zip(*rows, strict=True):
        table.add_row(*(_rounded(mpmath.mpf(text)) for text in row))
    console.print(table)


def short_number(text: str) -> str:
    """Return a number in ``p/q`` or decimal notation.

    A short exact number keeps its form. Others are rounded to `SHOWN_DIGITS` digits.

    Parameters
    ----------
    text : str
        Number as p/q or as decimal digits.

    Returns
    -------
    str
    """
    from ..number_texts import number

    return text if len(text) <= SHOWN_TEXT and "." not in text else _rounded(number(text))


def _rounded(value: "mpmath.mpf") -> str:
    import mpmath

    return mpmath.nstr(value, SHOWN_DIGITS)


LISTED = 3  # times that are listed one by one


def show_simulation(console: "Console", simulation: "Simulation") -> None:
    """Print the end of a motion, and the report.

    Parameters
    ----------
    console : Console
        Console to print on.
    simulation : Simulation
        The motion.
    """
    show_report(console, simulation.scene, simulation.title, simulation.report)


def show_report(console: "Console", scene: str, title: str, report: "Report") -> None:
    """Print the end of a scene's motion, and the report.

    Parameters
    ----------
    console : Console
        Console to print on.
    scene : str
        Name of the scene.
    title : str
        Title of the scene.
    report : Report
        Final state and quality of the motion.
    """
    from rich.table import Table

    from ..simulation.output import report_document

    document = report_document(report)
    console.print(f"{heading(scene, title)}, at t = {document['t']}", soft_wrap=True)
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
    from ..explanations import engine_text, notes

    if report.correction is not None:
        name, size = report.correction
        yield f"The last digits of the initial state are corrected to satisfy the constraints, {name} most, by {size}."
    if report.moved is not None:
        name, size = report.moved
        differs = f"The initial state differs from initial_guess most in {name}, by {size}."
        yield differs if float(size) else "initial_guess satisfies the constraints."
    left = ", ".join(f"{name} {value:.1e}" for name, value in report.residuals.items())
    yield f"residuals of the constraints: {left}; condition number of G: {report.condition:.3g}"
    yield f"energy error: {report.energy_error:.1e}"
    steps = f"{counted(report.steps, 'step')} by {engine_text(report.segments)}"
    yield f"{steps}, in {report.precision} precision at tolerance {report.tol:.1e}"
    if report.choice is not None:
        yield _choice(report.choice)
    code = f" {report.code} code" if report.code else ""
    yield f"{report.compile_seconds:.3f} s to compile{code}, {report.run_seconds:.3g} s to run"
    yield from notes(report)
    yield from _switchings(report.switchings)
    for condition in report.unreleased:
        yield f"{condition} does not cross zero after the initial time: the joint is not released."
    if report.relative_degrees:
        degrees = ", ".join(map(str, report.relative_degrees))
        yield f"The outputs of the servo-constraints have the relative degrees {degrees}."
    if report.ending is not None:
        yield _ending(report)


def _choice(choice: "Choice") -> str:
    """Return the reason for the choice of an engine."""
    seconds = ", ".join(f"{expected:.2g} s by {engine}" for engine, expected in choice.seconds.items())
    work = f"{choice.steps} steps of {choice.operations} operations"
    if choice.refused:
        return f"{choice.engine} is slower for {work}: {seconds}; but {choice.refused}"
    return f"{choice.engine} is quicker for {work}: {seconds}"


def _ending(report: "Report") -> str:
    """Return the reason why the motion ends."""
    if report.ending.crossed is not None:
        return f"The motion ends at t = {float(report.t):.10g}, where {report.ending.crossed} crosses zero."
    of = report.ending.of
    never = f"{of[0]} does not cross zero" if len(of) == 1 else f"none of {', '.join(of)} crosses zero"
    return f"The motion ends with the time span at t = {float(report.t):.10g}; {never} before."


def _switchings(switchings: "Sequence[Switching]") -> Iterator[str]:
    """Yield the events at which the motion is not analytic."""
    for switching in switchings[:LISTED]:
        if switching.outcome == "joint released":
            yield f"At t = {switching.t:.10g}, where {switching.function} crosses zero, a joint is released."
            continue
        what = _passed(switching.outcome)
        yield f"At t = {switching.t:.10g} the switching surface {switching.function} = 0 is {what}."
    if len(switchings) > LISTED:
        yield f"The motion switches {len(switchings)} times in all, the last time at t = {switchings[-1].t:.10g}."


def _passed(outcome: str) -> str:
    return {"sliding": "reached, and the motion stays on it", "released": "left again"}.get(outcome, outcome)


def rejection(violation: "AccuracyViolation") -> str:
    """Return the message for a simulation that failed the accuracy check.

    Parameters
    ----------
    violation : AccuracyViolation
        Accuracy criterion that the motion violates.

    Returns
    -------
    str
        One line that begins with ``holonom: error:``.
    """
    if isnan(violation.error):
        return f"holonom: error: simulation rejected: {violation.reason}. End the run before that."
    return (
        f"holonom: error: simulation rejected: {violation.reason}. "
        "Reduce --max-step, change --engine or increase --precision."
    )


def show_sweep(console: "Console", sweep: "Sweep", statuses: Mapping[str, int]) -> None:
    """Print the folder of the rows and the number of rows by status.

    Parameters
    ----------
    console : Console
        Console to print on.
    sweep : Sweep
        A finished sweep.
    statuses : mapping of str to int
        Number of rows by status.
    """
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
    console.print(f"columns in {sweep.path}: {', '.join(document['columns'])}", soft_wrap=True)
