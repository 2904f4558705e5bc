"""Power series of a motion, and how far they hold."""

from typing import TYPE_CHECKING

import mpmath
from rich.console import Console
from rich.table import Table

if TYPE_CHECKING:
    from ...series.power_series import Continuation, MotionSeries, Values

SHOWN_DIGITS = 12  # of numbers that would be longer than the next
SHOWN_TEXT = 24  # characters of an exact number


def show_series(console: Console, motion: "MotionSeries", values: "Values | None" = None) -> None:
    """Print the power series of a motion, how far they hold, and values asked for."""
    table = Table("order", title=f"{motion.scene}: {motion.title}, about t = {motion.t0}", title_justify="left")
    columns = dict(motion.all_series())
    for name in columns:
        table.add_column(name)
    for n, row in enumerate(zip(*columns.values(), strict=True)):
        table.add_row(str(n), *map(short_number, row))
    console.print(table)
    radius = motion.radius
    size = "" if radius.estimate is None else f"{radius.estimate:.8g}, known to {radius.uncertainty:.1g}; "
    console.print(f"{motion.arithmetic} arithmetic; radius of convergence: {size}{radius.remark}", soft_wrap=True)
    if motion.switch is not None:
        console.print(f"This is the motion as long as {motion.switch} keeps its sign.", soft_wrap=True, markup=False)
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


def short_number(text: str) -> str:
    """A number in ``p/q`` or decimal notation: as it is where it is exact and short, else rounded."""
    from ...series.power_series import number

    return text if len(text) <= SHOWN_TEXT and "." not in text else _rounded(number(text))


def _rounded(value: mpmath.mpf) -> str:
    return mpmath.nstr(value, SHOWN_DIGITS)
