"""Print derivations, verdicts on them, and the errata of the paper."""

import io
import re
from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table
from rich.terminal_theme import DIMMED_MONOKAI
from rich.text import Text

from ..expression.notation import scene_text
from ..expression.trees import with_decimals
from ..hidden import visible_line
from ..language import gettext, ngettext, translatable, translated
from ..record import LARGEST_SIZE
from .condition import condition_lines
from .heading import heading
from .text import PlainConsole, counted, styled

if TYPE_CHECKING:
    from ..crosscheck.report import CheckReport
    from ..errata import PrintedEquation
    from ..record import Equation, LeftOut, Record, Relation

LARGEST_IN_MEMORY = 10**12  # terms of closed forms: some bytes each, more than any machine has


def show_record(console: Console, record: "Record") -> None:
    """Print a derivation, equation by equation, under the equation numbers.

    Parameters
    ----------
    console : Console
        Console to print on.
    record : Record
        Derivations and scenes of one file.
    """
    console.print(visible_line(record.system.title), style="bold")
    if record.system.source:
        console.print(visible_line(record.system.source), style="dim")
    for derivation in record.derivations:
        console.print(f"\nDerivation with {_listed(derivation.effects)}", style="bold")
        _show_equations(console, derivation.equations)
        _show_left_out(console, derivation.left_out)
    for scene in record.scenes:
        console.print(f"\n{heading(scene.name, scene.title)}", style="bold")
        _show_equations(console, scene.equations)
        _show_left_out(console, scene.left_out)
        for equation in scene.equations:
            if functions := scene.jumping(equation):
                where = ", ".join(f"{visible_line(str(function))} = 0" for function in functions)
                line = f"({equation.number}) does not hold at this start, where a sign jumps: {where}."
                console.print(line, style="yellow", soft_wrap=True)


def show_reports(console: Console, reports: Iterable[tuple[str, "CheckReport"]]) -> None:
    """Print the verdicts on each scene file.

    Parameters
    ----------
    console : Console
        Console to print on.
    reports : iterable of (str, CheckReport)
        Name of the scene file and the verdicts on it.
    """
    for scene, report in reports:
        console.print(scene, style="italic", soft_wrap=True)
        show_verdicts(console, report)


def show_verdicts(console: Console, report: "CheckReport") -> None:
    """Print the verdict on each equation, and the disagreements in full.

    Parameters
    ----------
    console : Console
        Console to print on.
    report : CheckReport
        Verdicts on one scene file.
    """
    table = Table("no.", "equation", "verdict", "digits", "points")
    for name, verdicts in groupby(report.verdicts, key=lambda verdict: verdict.scene):
        table.add_section()
        if name:
            table.add_row("", Text(name, style="bold"))
        for found in verdicts:
            table.add_row(found.number, found.name, styled(found.verdict), _number(found.digits), _number(found.points))
    console.print(table)
    for found in report.verdicts:
        if found.detail:
            console.print(f"{_title(found.number, found.name)}: {found.detail}", soft_wrap=True)
    for left_out in dict.fromkeys(found.left_out for found in report.verdicts if found.left_out):
        numbers = dict.fromkeys(f"({found.number})" for found in report.verdicts if found.left_out == left_out)
        line = f"{', '.join(numbers)} left out: {why_left_out(left_out)}."
        console.print(line, soft_wrap=True)
    console.print(f"{_sum(report)}; random points drawn by --seed {report.seed}", soft_wrap=True)


def _sum(report: "CheckReport") -> str:
    from ..crosscheck.report import Verdict

    expected = len(report.verdicts) - report.count(Verdict.LEFT_OUT)
    counts = {
        "agree": Verdict.AGREES,
        "agree at points": Verdict.SAMPLED,
        "undecided": Verdict.UNDECIDED,
        "with nothing to check": Verdict.NOTHING,
        "left out": Verdict.LEFT_OUT,
    }
    parts = [f"{count} {what}" for what, verdict in counts.items() if (count := report.count(verdict))]
    proved = f"{report.count(Verdict.PROVED)} of {expected} expected equations proved"
    return ", ".join([proved, *parts, counted(report.disagreements, "disagreement")])


def _show_equations(console: Console, equations: Iterable["Equation"]) -> None:
    for equation in equations:
        console.print(Text(_title(equation.number, equation.name), style="cyan"))
        if equation.id == "free_motion_condition":
            lines = [line for relation in equation.relations for line in condition_lines(relation.left_tree)]
            console.print("\n".join(f"    {line}" for line in lines), soft_wrap=True)
        elif equation.relations:
            console.print("\n".join(map(_line, equation.relations)), soft_wrap=True)
        else:
            console.print("    none", style="dim")


def _title(number: str, name: str) -> str:
    return f"({number}) {name}" if number else name


def _line(relation: "Relation") -> str:
    return f"    {scene_text(relation.left_tree)} = {scene_text(with_decimals(relation.right_tree))}"


def _show_left_out(console: Console, left_out: "LeftOut | None") -> None:
    if left_out is not None:
        numbers = ", ".join(f"({number})" for number in left_out.numbers)
        console.print(f"{numbers} not made: {why_left_out(left_out)}.", style="yellow", soft_wrap=True)


def why_left_out(left_out: "LeftOut") -> str:
    """Return the reason why equations were left out, and how to get them.

    Parameters
    ----------
    left_out : LeftOut
        Numbers and expected size of the equations.

    Returns
    -------
    str
        A clause without a period.
    """
    if left_out.size is None:
        return "forces contain multipliers, and the equations are linear in them for each pattern of signs alone"
    size, limit = left_out.size, f"more than closed_form_size = {left_out.limit}"
    if size > LARGEST_IN_MEMORY:
        terms = f"{size:.0e} terms{' or more' if size == LARGEST_SIZE else ''}"
        return f"closed forms of {terms} are expected, {limit} and than memory holds"
    return (
        f"closed forms of {size} terms are expected, {limit}; "
        f"--closed-form-size {size} makes them, if time and memory suffice"
    )


def _number(count: int | None) -> str:
    return "" if count is None else str(count)


def _listed(effects: Sequence[str]) -> str:
    return ", ".join(effects)


PICTURE_WIDTH = 62  # columns of the table of misprints
FONT_FROM_NETWORK = re.compile(r"@font-face \{.*?\}", re.DOTALL)


def show_errata(console: Console, equations: Sequence["PrintedEquation"]) -> None:
    """Print each equation of the paper, the verdict on it, and its correction.

    Parameters
    ----------
    console : Console
        Console to print on.
    equations : sequence of PrintedEquation
        Equations of the paper, in their order.
    """
    console.print(_errata_table(equations))
    for equation in equations:
        _show_misprint(console, equation)
    misprints = sum(not equation.agrees for equation in equations)
    console.print(_summary(len(equations), misprints))


def _summary(equations: int, misprints: int) -> str:
    if not misprints:
        return gettext("%(equations)s equations, no misprints in our copy of the paper", equations=equations)
    return ngettext(
        "%(equations)s equations, %(misprints)s misprint in our copy of the paper",
        "%(equations)s equations, %(misprints)s misprints in our copy of the paper",
        misprints,
        equations=equations,
        misprints=misprints,
    )


def draw_errata(equations: Sequence["PrintedEquation"]) -> str:
    """Return the table of the errata as an SVG picture that needs no network.

    Parameters
    ----------
    equations : sequence of PrintedEquation
        Equations of the paper, in their order.

    Returns
    -------
    str
        SVG document.
    """
    console = PlainConsole(record=True, width=PICTURE_WIDTH, file=io.StringIO(), force_terminal=True)
    console.print(_errata_table(equations))
    picture = console.export_svg(title="holonom errata", theme=DIMMED_MONOKAI, unique_id="errata")
    return FONT_FROM_NETWORK.sub("", picture)


def _errata_table(equations: Sequence["PrintedEquation"]) -> Table:
    heads = gettext("no."), gettext("equation"), gettext("as printed")
    table = Table(*heads, title=gettext("The paper as our copy prints it"), title_justify="left")
    for equation in equations:
        verdict = translatable("agrees") if equation.agrees else translatable("differs")
        table.add_row(equation.number, translated(equation.name), styled(verdict))
    return table


def _show_misprint(console: Console, equation: "PrintedEquation") -> None:
    texts = {
        gettext("difference"): equation.difference,
        gettext("corrected"): equation.corrected,
        gettext("note"): equation.note and translated(equation.note),
    }
    if equation.agrees and not equation.note:
        return
    console.print(Text(_title(equation.number, translated(equation.name)), style="cyan"))
    for what, text in texts.items():
        if text:
            console.print(f"    {what}: {text}", soft_wrap=True)
