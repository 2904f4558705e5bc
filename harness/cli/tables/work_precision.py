"""What accuracy costs in time: one table, then plain advice."""

from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table

from ...benchmark.work_precision.measurement import Group

if TYPE_CHECKING:
    from ...benchmark.work_precision.advice import Advice, Price
    from ...benchmark.work_precision.study import Study

TITLES = {
    Group.SERIES: "One series, added up at t = {instant}",
    Group.TAYLOR: "The Taylor engine, to t = {instant}",
    Group.RUNGE_KUTTA: "The Runge-Kutta engine, to t = {instant}",
    Group.SOLVER: "Others on the same motion program, to t = {instant}",
    Group.DRIFT: "Cures of drift at equal tolerance, to t = {instant}",
    Group.SOLVE: "The two solves at equal tolerance, to t = {instant}",
}


def show_study(console: Console, study: "Study") -> None:
    """Print every measurement, what was left out and why, and the advice that follows."""
    console.print(f"{study.scene}: {study.title}", soft_wrap=True)
    for group, title in TITLES.items():
        rows = [m for m in study.measurements if m.group is group]
        if not rows:
            continue
        table = Table(title=title.format(instant=float(rows[0].instant)), title_justify="left")
        for name in ("method", "setting"):
            table.add_column(name)
        for name in ("relative error", "seconds", "seconds to prepare", "operations"):
            table.add_column(name, justify="right")
        for m in rows:
            prepared = "" if m.preparation_seconds is None else f"{m.preparation_seconds:.2g}"
            table.add_row(m.method, m.setting, f"{m.error:.1e}", f"{m.seconds:.2e}", prepared, f"{m.operations}")
        console.print(table)
    for omission in study.omissions:
        console.print(f"left out: {omission.method}, {omission.setting}: {omission.reason}", soft_wrap=True)
    for advice in study.advice:
        console.print(_sentence(advice), soft_wrap=True)
    for price in study.prices:
        console.print(_price(price), soft_wrap=True)
    reference = study.reference
    console.print(
        f"Errors are against a run with {reference.digits} digits and order {reference.order}; one with "
        f"{reference.confirming_digits} digits and order {reference.confirming_order} differs by "
        f"{reference.difference:.1g}.",
        soft_wrap=True,
    )
    console.print(f"Seconds are those of one run, once it is prepared. Measured on {study.machine}.", soft_wrap=True)


def _sentence(advice: "Advice") -> str:
    m = advice.cheapest
    if m is None:
        return f"For {advice.digits} digits: none of these methods gets there."
    return f"For {advice.digits} digits: {m.method}, {m.setting}, {m.seconds:.2g} s (error {m.error:.1g})."


def _price(price: "Price") -> str:
    return (
        f"One more digit takes {100 * (price.factor - 1):.0f} % more time with {price.method}, "
        f"between {price.first_digits:.0f} and {price.last_digits:.0f} digits."
    )
