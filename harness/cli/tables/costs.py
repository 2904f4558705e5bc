"""What the terms and effects of a scene cost."""

from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table
from rich.text import Text

from .text import styled

if TYPE_CHECKING:
    from ...program.effects import MeasuredCosts

NANOSECONDS = 1e9  # in a second


def show_costs(console: Console, costs: "MeasuredCosts") -> None:
    """Print the terms of (3) and (7) and the effects of a scene, with what each costs."""
    unit = f"ns in {costs.measured_in}"
    terms = Table("eq.", "term", "status", "operations", unit, title=costs.scene, title_justify="left")
    for term in costs.terms:
        cost = (str(term.operations), _nanoseconds(term.seconds)) if term.status == "present" else ("", "")
        terms.add_row(term.equation, Text(term.term), styled(term.status), *cost)
    effects = Table("effect", "status", "operations", unit)
    for effect in costs.effects:
        operations = _indispensable(effect.status) if effect.operations is None else f"{effect.operations:+d}"
        effects.add_row(effect.name, styled(effect.status), operations, _added_nanoseconds(effect.seconds))
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
