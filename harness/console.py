"""What the commands show: tables and equations, in colour on a terminal and plain elsewhere."""

import io
import re
from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import TYPE_CHECKING

import mpmath
from rich.console import Console
from rich.table import Table
from rich.terminal_theme import DIMMED_MONOKAI
from rich.text import Text

if TYPE_CHECKING:
    from harness.crosscheck import CheckReport
    from harness.errata import PrintedEquation
    from harness.free_motion import FreeMotion, Law
    from harness.motion.effects import MeasuredCosts
    from harness.motion.series import Continuation, MotionSeries, Values
    from harness.record import Equation, Record

PIPE_WIDTH = 160  # columns where there is no terminal to ask
PICTURE_WIDTH = 62  # columns of the table of misprints
FONT_FROM_NETWORK = re.compile(r"@font-face \{.*?\}", re.DOTALL)
SHOWN_DIGITS = 12  # of numbers that would be longer than the next
SHOWN_TEXT = 24  # characters of an exact number
NANOSECONDS = 1e9  # in a second
STYLES = {
    "proved": "green",
    "agrees": "green",
    "disagrees": "bold red",
    "differs": "bold red",
    "present": "green",
    "absent by choice": "yellow",
    "absent by structure": "dim",
}


def make_console() -> Console:
    """Console on standard output."""
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = PIPE_WIDTH
    return console


def show_record(console: Console, record: "Record") -> None:
    """Print a derivation, equation by equation, under the paper's numbers."""
    console.print(record.system.title, style="bold")
    if record.system.source:
        console.print(record.system.source, style="dim")
    for derivation in record.derivations:
        console.print(f"\nDerivation with {_listed(derivation.effects)}", style="bold")
        _show_equations(console, derivation.equations)
    for scene in record.scenes:
        console.print(f"\n{scene.name}: {scene.title}", style="bold")
        _show_equations(console, scene.equations)


def show_report(console: Console, scene: str, report: "CheckReport") -> None:
    """Print the verdict on each equation of one scene file, and the disagreements in full."""
    table = Table("no.", "equation", "verdict", "digits", "points", title=scene, title_justify="left")
    for name, verdicts in groupby(report.verdicts, key=lambda verdict: verdict.scene):
        table.add_section()
        if name:
            table.add_row("", Text(name, style="bold"))
        for found in verdicts:
            table.add_row(
                found.number, found.name, _styled(found.verdict), _number(found.digits), _number(found.points)
            )
    console.print(table)
    for found in report.verdicts:
        if found.verdict == "disagrees":
            console.print(f"({found.number}) {found.name}: {found.detail}", soft_wrap=True, markup=False)
    console.print(f"{len(report.verdicts)} equations, {_counted(report.disagreements, 'disagreement')}")


def show_errata(console: Console, equations: Sequence["PrintedEquation"]) -> None:
    """Print each equation of the paper, whether it is right, and what is wrong with it where it is not."""
    console.print(_errata_table(equations))
    for equation in equations:
        _show_misprint(console, equation)
    misprints = sum(not equation.agrees for equation in equations)
    console.print(f"{len(equations)} equations, {_counted(misprints, 'misprint')}")


def draw_errata(equations: Sequence["PrintedEquation"]) -> str:
    """Return the table of the comparison with print as an SVG picture that needs no network."""
    console = Console(record=True, width=PICTURE_WIDTH, file=io.StringIO(), force_terminal=True)
    console.print(_errata_table(equations))
    picture = console.export_svg(title="holonom errata", theme=DIMMED_MONOKAI, unique_id="errata")
    return FONT_FROM_NETWORK.sub("", picture)


def _errata_table(equations: Sequence["PrintedEquation"]) -> Table:
    table = Table("no.", "equation", "as printed", title="The paper as printed", title_justify="left")
    for equation in equations:
        table.add_row(equation.number, equation.name, _styled("agrees" if equation.agrees else "differs"))
    return table


def show_free_motion(console: Console, found: "FreeMotion") -> None:
    """Print the condition of free motion and the controls that satisfy it."""
    _show_list(console, "condition of free motion (10)", [f"{formula(e)} = 0" for e in found.condition])
    if found.verdict is not None:
        satisfied = {"no": "not free"}.get(found.verdict.satisfies, f"free for {found.verdict.satisfies}")
        left = [f"leaves {formula(e)}" for e in found.verdict.residual]
        _show_list(console, f"{found.scene}: motion is {satisfied}", [found.verdict.reason, *left])
    universal = found.universal
    ending = " (there are no others)" if universal.unique else ""
    separated = [f"needs {formula(e)} = 0" for e in universal.conditions]
    laws = [_law(law) for law in universal.laws] or ["none"]
    _show_list(console, f"controls that make every motion free{ending}", [*laws, universal.reason, *separated])
    trajectory = found.trajectory
    _show_list(console, f"control for one trajectory: {trajectory.kind}", [_law(trajectory.law), trajectory.reason])


def _show_list(console: Console, title: str, lines: Iterable[str]) -> None:
    console.print(Text(title, style="cyan"))
    for line in lines:
        if line:
            console.print(f"    {line}", soft_wrap=True, markup=False)


def _law(law: "Law") -> str:
    return ", ".join(f"{control} = {formula(value)}" for control, value in law.items())


def show_series(console: Console, motion: "MotionSeries", values: "Values | None") -> None:
    """Print the power series of a motion, how far they hold, and values asked for."""
    from harness.motion.series import number

    table = Table("order", title=f"{motion.scene}: {motion.title}, about t = {motion.t0}", title_justify="left")
    columns = dict(motion.all_series())
    for name in columns:
        table.add_column(name)
    for n, row in enumerate(zip(*columns.values(), strict=True)):
        table.add_row(str(n), *(text if len(text) <= SHOWN_TEXT else _rounded(number(text)) for text in row))
    console.print(table)
    radius = motion.radius
    size = "" if radius.estimate is None else f"{radius.estimate:.8g}, known to {radius.uncertainty:.1g}; "
    console.print(f"{motion.arithmetic} arithmetic; radius of convergence: {size}{radius.remark}", soft_wrap=True)
    for z in radius.singularities:
        console.print(f"    singularity at t - t0 = {z.real:.8g} {z.imag:+.8g} i")
    if values is not None:
        console.print(f"at t = {values.time}, leaving out terms of the size {values.truncation_error:.1g}:")
        for name, value in values.values.items():
            console.print(f"    {name} = {_rounded(value)}")
    if motion.continuation is not None:
        _show_continuation(console, motion.continuation)


def _show_continuation(console: Console, continuation: "Continuation") -> None:
    names = [*continuation.coordinates, *continuation.velocities]
    table = Table("t", *names, title="Continued by further expansions", title_justify="left")
    rows = [continuation.instants, *continuation.coordinates.values(), *continuation.velocities.values()]
    for row in zip(*rows, strict=True):
        table.add_row(*(_rounded(mpmath.mpf(text)) for text in row))
    console.print(table)


def _rounded(value: mpmath.mpf) -> str:
    return mpmath.nstr(value, SHOWN_DIGITS)


def show_costs(console: Console, scene_file: str, costs: "MeasuredCosts") -> None:
    """Print the terms of (3) and (7) and the effects of a scene, with what each costs."""
    title = f"{scene_file}: {costs.scene}" if costs.scene else scene_file
    unit = f"ns in {costs.measured_in}"
    terms = Table("eq.", "term", "status", "operations", unit, title=title, title_justify="left")
    for term in costs.terms:
        cost = (str(term.operations), _nanoseconds(term.seconds)) if term.status == "present" else ("", "")
        terms.add_row(term.equation, Text(term.term), _styled(term.status), *cost)
    effects = Table("effect", "status", "operations", unit)
    for effect in costs.effects:
        operations = _indispensable(effect.status) if effect.operations is None else f"{effect.operations:+d}"
        effects.add_row(effect.name, _styled(effect.status), operations, _added_nanoseconds(effect.seconds))
    for table in (terms, effects):
        table.columns[-1].justify = table.columns[-2].justify = "right"
        console.print(table)
    console.print(
        "(10) is made of the terms of (3) and (7), the reactions apart: what is absent there is absent in it."
    )
    console.print(f"The whole program: {costs.operations} operations, {_nanoseconds(costs.seconds_per_evaluation)} ns.")
    console.print(
        "A time is that of one call among many, the call itself included; what an effect adds is a difference."
    )


def _nanoseconds(seconds: float) -> str:
    return f"{seconds * NANOSECONDS:.1f}"


def _added_nanoseconds(seconds: float | None) -> str:
    return "" if seconds is None else f"{round(seconds * NANOSECONDS, 1) + 0.0:+.1f}"  # no minus sign before a zero


def _indispensable(status: str) -> str:
    return "indispensable" if status == "present" else "unsolvable"


def _show_equations(console: Console, equations: Iterable["Equation"]) -> None:
    for equation in equations:
        console.print(Text(f"({equation.number}) {equation.name}", style="cyan"))
        for relation in equation.relations:
            console.print(f"    {formula(relation.left)} = {formula(relation.right)}", soft_wrap=True, markup=False)
        if not equation.relations:
            console.print("    none", style="dim")


def _show_misprint(console: Console, equation: "PrintedEquation") -> None:
    said = {"difference": equation.difference, "corrected": equation.corrected, "remark": equation.remark}
    if equation.agrees and not equation.remark:
        return
    number = f"({equation.number}) " if equation.number else ""
    console.print(Text(f"{number}{equation.name}", style="cyan"))
    for what, text in said.items():
        if text:
            console.print(f"    {what}: {text}", soft_wrap=True, markup=False)


def formula(expression: object) -> str:
    """One line in the notation of the scene files."""
    return str(expression).replace("**", "^")


def _styled(verdict: str) -> Text:
    return Text(verdict, style=STYLES[verdict])


def _number(count: int | None) -> str:
    return "" if count is None else str(count)


def _listed(effects: Sequence[str]) -> str:
    return ", ".join(effects)


def _counted(count: int, what: str) -> str:
    return f"{count or 'no'} {what}{'' if count == 1 else 's'}"
