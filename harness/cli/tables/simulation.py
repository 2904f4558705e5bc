"""A simulation on the console: the end of the motion, and how well it was followed to there."""

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

LISTED = 3  # instants that are told one by one

if TYPE_CHECKING:
    from rich.console import Console

    from ...simulation.piecewise import Switching
    from ...simulation.result import Report, Simulation
    from ...simulation.trust import Doubt


@contextmanager
def motion_progress(title: str) -> Iterator[Callable[[float], None] | None]:
    """Show a progress bar while the block runs, on standard error if that is a terminal.

    Yields
    ------
    callable or None
        Takes the fraction that is done; None in a pipe, where nothing is shown.
    """
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as shown:
        task = shown.add_task(title, total=1.0)
        yield lambda fraction: shown.update(task, completed=fraction)


def show_simulation(console: "Console", simulation: "Simulation") -> None:
    """Print the end of a motion, and the report."""
    show_report(console, simulation.scene, simulation.title, simulation.report)


def show_report(console: "Console", scene: str, title: str, report: "Report") -> None:
    """Print the end of a scene's motion, and the report."""
    from rich.table import Table

    from ...simulation.document import report_document

    document = report_document(report)
    console.print(f"{scene}: {title}, at t = {document['t']}", soft_wrap=True, markup=False)
    table = Table("", "", show_header=False)
    for group in ("coordinates", "velocities", "multipliers", "controls"):
        for name, value in document[group].items():
            table.add_row(name, str(value))
        table.add_section()
    console.print(table)
    for line in _quality(report):
        console.print(line, soft_wrap=True, markup=False)


def _quality(report: "Report") -> Iterator[str]:
    from ...simulation.diagnosis import engine_text, remarks

    if report.correction is not None:
        name, size = report.correction
        yield f"The initial state misses the constraints in its last digits and is corrected, {name} most, by {size}."
    left = ", ".join(f"{name} {value:.1e}" for name, value in report.residuals.items())
    yield f"residuals of the constraints: {left}; condition number of G: {report.condition:.3g}"
    yield f"energy error: {report.energy_error:.1e}"
    steps = f"{report.steps} steps by {engine_text(report.legs)}"
    yield f"{steps}, in {report.precision} precision at tolerance {report.tol:.1e}"
    code = f" {report.code} code" if report.code else ""
    yield f"{report.compile_seconds:.3f} s to compile{code}, {report.run_seconds:.3g} s to run"
    yield from remarks(report.legs, report.cases)
    yield from _switchings(report.switchings)
    if report.relative_degrees:
        degrees = ", ".join(map(str, report.relative_degrees))
        yield f"The outputs of the servo-constraints have the relative degrees {degrees}."
    if report.ending is not None:
        yield _ending(report)


def _ending(report: "Report") -> str:
    """Why the motion ends where it does."""
    if report.ending.crossed is not None:
        return f"The motion ends at t = {float(report.t):.10g}, where {report.ending.crossed} crosses zero."
    of = report.ending.of
    never = f"{of[0]} does not cross zero" if len(of) == 1 else f"none of {', '.join(of)} crosses zero"
    return f"The motion ends with the time span at t = {float(report.t):.10g}; {never} before."


def _switchings(switchings: "Sequence[Switching]") -> Iterator[str]:
    """What happened where the motion is not analytic."""
    for switching in switchings[:LISTED]:
        yield f"At t = {switching.t:.10g} the surface {switching.function} = 0 is {_passed(switching.passage)}."
    if len(switchings) > LISTED:
        yield f"The motion switches {len(switchings)} times in all, the last time at t = {switchings[-1].t:.10g}."


def _passed(passage: str) -> str:
    return {"held": "reached, and held on to", "released": "left again"}.get(passage, passage)


def distrust(doubt: "Doubt") -> str:
    """The sentence that says why a motion is no result."""
    whats = {
        "energy": "the energy",
        "acceleration": "a force that acts within a step",
    }
    what = whats.get(doubt.quantity, f"the {doubt.quantity} that the constraints allow")
    return (
        f"holonom: this is no result: {what} is missed by {doubt.missed:.1e} of its size, where the tolerance lets "
        f"expect {doubt.expected:.1e} at most; take a smaller --max-step, another --engine or more --precision."
    )
