"""The paper as printed, compared with the derivation: a table on the console, and as a picture."""

import io
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table
from rich.terminal_theme import DIMMED_MONOKAI
from rich.text import Text

from .text import counted, styled

if TYPE_CHECKING:
    from ...errata import PrintedEquation

PICTURE_WIDTH = 62  # columns of the table of misprints
FONT_FROM_NETWORK = re.compile(r"@font-face \{.*?\}", re.DOTALL)


def show_errata(console: Console, equations: Sequence["PrintedEquation"]) -> None:
    """Print each equation of the paper, whether it is right, and what is wrong with it where it is not."""
    console.print(_errata_table(equations))
    for equation in equations:
        _show_misprint(console, equation)
    misprints = sum(not equation.agrees for equation in equations)
    console.print(f"{len(equations)} equations, {counted(misprints, 'misprint')} in our copy of the paper")


def draw_errata(equations: Sequence["PrintedEquation"]) -> str:
    """Return the table of the comparison with print as an SVG picture that needs no network."""
    console = Console(record=True, width=PICTURE_WIDTH, file=io.StringIO(), force_terminal=True)
    console.print(_errata_table(equations))
    picture = console.export_svg(title="holonom errata", theme=DIMMED_MONOKAI, unique_id="errata")
    return FONT_FROM_NETWORK.sub("", picture)


def _errata_table(equations: Sequence["PrintedEquation"]) -> Table:
    table = Table("no.", "equation", "as printed", title="The paper as our copy prints it", title_justify="left")
    for equation in equations:
        table.add_row(equation.number, equation.name, styled("agrees" if equation.agrees else "differs"))
    return table


def _show_misprint(console: Console, equation: "PrintedEquation") -> None:
    said = {"difference": equation.difference, "corrected": equation.corrected, "remark": equation.remark}
    if equation.agrees and not equation.remark:
        return
    number = f"({equation.number}) " if equation.number else ""
    console.print(Text(f"{number}{equation.name}", style="cyan"))
    for what, text in said.items():
        if text:
            console.print(f"    {what}: {text}", soft_wrap=True, markup=False)
