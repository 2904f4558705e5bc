"""Print costs of terms and effects, accuracy studies, and results of hard cases."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table
from rich.text import Text

from ..benchmark.work_precision.measurement import Group
from ..hidden import visible_line
from .heading import heading
from .text import counted, styled

if TYPE_CHECKING:
    from ..benchmark.hard_cases.case import CaseReport
    from ..benchmark.work_precision.advice import Advice, Price
    from ..benchmark.work_precision.study import Study
    from ..program.effects import MeasuredCosts


NANOSECONDS = 1e9  # in a second


def show_costs(console: Console, costs: "MeasuredCosts") -> None:
    """Print the terms of (3) and (7) and the effects of a scene, each with its cost.

    Parameters
    ----------
    console : Console
        Console to print on.
    costs : MeasuredCosts
        Operations, and seconds for each evaluation.
    """
    unit = f"ns in {costs.measured_in}"
    terms = Table("eq.", "term", "status", "operations", unit, title=visible_line(costs.scene), title_justify="left")
    for term in costs.terms:
        cost = (str(term.operations), _nanoseconds(term.seconds)) if term.status == "present" else ("", "")
        terms.add_row(term.equation, Text(term.term), styled(term.status), *cost)
    effects = Table("effect", "status", "operations", unit)
    for effect in (*costs.effects, *costs.pairs):
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


TITLES = {
    Group.SERIES: "One series, added up at t = {time}",
    Group.TAYLOR: "The Taylor engine, to t = {time}",
    Group.RUNGE_KUTTA: "The Runge-Kutta engine, to t = {time}",
    Group.SOLVER: "Others on the same motion program, to t = {time}",
    Group.STABILIZATION: "Stabilization methods at equal tolerance, to t = {time}",
    Group.SOLVE: "The two solves at equal tolerance, to t = {time}",
}


def show_study(console: Console, study: "Study") -> None:
    """Print every measurement, the methods left out with the reasons, and the advice.

    Parameters
    ----------
    console : Console
        Console to print on.
    study : Study
        Errors and seconds of each method.
    """
    console.print(heading(study.scene, study.title), soft_wrap=True)
    for group, title in TITLES.items():
        rows = [m for m in study.measurements if m.group is group]
        if not rows:
            continue
        table = Table(title=title.format(time=float(rows[0].time)), title_justify="left")
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


def show_stability(console: Console, reports: Sequence["CaseReport"]) -> None:
    """Print the correct digits of each method in each hard case, with the advice.

    Parameters
    ----------
    console : Console
        Console to print on.
    reports : sequence of CaseReport
        Results of each method, one report for each case.
    """
    from ..explanations import advice

    table = Table("case", "method", "quantity", "digits", "outcome")
    table.title, table.title_justify = "Correct digits in hard cases", "left"
    table.columns[3].justify = "right"
    for report in reports:
        table.add_section()
        name = report.case.name
        for result in report.results:
            digits = "" if result.digits is None else f"{result.digits:.1f}"
            table.add_row(name, result.method, result.quantity, digits, styled(result.outcome))
            name = ""
    console.print(table)
    for report in reports:
        console.print(Text(report.case.name, style="cyan"))
        console.print(f"    truth: {report.case.truth}", soft_wrap=True)
        console.print(f"    {advice(report.case.kind)}", soft_wrap=True)
    failed = sum(report.fails for report in reports)
    console.print(f"{counted(len(reports), 'hard case')}, {counted(failed, 'failure')}")
