"""Draw accuracy studies, and the correct digits of each method in hard cases."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from textwrap import fill
from typing import TYPE_CHECKING

from ..benchmark.hard_cases.case import CaseReport, Outcome, Result, Sweep
from ..benchmark.work_precision.measurement import WHOLE_MOTION, Group, Measurement
from ..language import gettext, translatable, translated
from .style import BLUE, LINES, MARKERS, PALETTE, VERMILION, figure_style, legend_above, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..benchmark.work_precision.study import Study


PANEL = 5.5, 5.3  # inches
MACHINE = 70  # characters in a line below a panel
FEW_DIGITS = 20  # digits of the hardware numbers, and a few more
SECONDS, OPERATIONS = translatable("time / s"), translatable("operations")


@dataclass(frozen=True)
class View:
    """The content of one panel."""

    title: str
    shows: Callable[[Measurement], bool]
    quantity: str


PANELS = (
    View(translatable("Methods, to t = %(until)g"), lambda m: _is_compared(m) and digits_of(m) <= FEW_DIGITS, SECONDS),
    View(translatable("The same by operations"), lambda m: _is_compared(m) and digits_of(m) <= FEW_DIGITS, OPERATIONS),
    View(translatable("Many digits, to t = %(until)g"), lambda m: m.group is Group.TAYLOR, SECONDS),
    View(translatable("The same by operations"), lambda m: m.group is Group.TAYLOR, OPERATIONS),
    View(translatable("One series, to t = %(time)g, order by order"), lambda m: m.group is Group.SERIES, SECONDS),
    View(
        translatable("Stabilization methods and the two solves"),
        lambda m: m.group in {Group.STABILIZATION, Group.SOLVE},
        SECONDS,
    ),
)


TIMES = PANELS[0], PANELS[2]


def study_figure(study: "Study", panels: Sequence[View] = PANELS, columns: int = 2) -> "Figure":
    """Return the figure of a study, in panels.

    Parameters
    ----------
    study : Study
        Measurements with their scene and machine.
    panels : sequence of View
        Panels, row by row.
    columns : int
        Number of panels in a row.

    Returns
    -------
    Figure

    Raises
    ------
    HolonomError
        Matplotlib is not installed.
    """
    with figure_style():
        rows = math.ceil(len(panels) / columns)
        figure = new_figure(PANEL[0] * columns, PANEL[1] * rows)
        for axes, panel in zip(figure.subplots(rows, columns, squeeze=False).flat, panels, strict=True):
            _draw_panel(axes, [m for m in study.measurements if panel.shows(m)], panel.quantity)
            axes.set_title(gettext(panel.title, until=float(study.until), time=_time_of_series(study)))
        figure.suptitle(gettext("What accuracy costs: %(scene)s", scene=study.scene), x=0.01, ha="left")
        figure.supxlabel(fill(str(study.machine), MACHINE * columns), x=0.01, ha="left", fontsize="small")
        return figure


def digits_of(measurement: Measurement) -> float:
    """Return the correct decimal digits of a run.

    Parameters
    ----------
    measurement : Measurement
        Its relative error is positive.

    Returns
    -------
    float
    """
    return -math.log10(measurement.error)


def _draw_panel(axes: "Axes", measurements: Sequence[Measurement], quantity: str) -> None:
    for index, method in enumerate(dict.fromkeys(m.method for m in measurements)):
        rows = [m for m in measurements if m.method == method]
        work = [m.seconds if quantity == SECONDS else m.operations for m in rows]
        # The second time around the palette, colours meet other markers.
        marker = MARKERS[(index + index // len(PALETTE)) % len(MARKERS)]
        line = "--" if rows[0].group is Group.SOLVER else "-"
        colour = PALETTE[index % len(PALETTE)]
        axes.semilogy(
            [digits_of(m) for m in rows], work, color=colour, marker=marker, linestyle=line, label=translated(method)
        )
    axes.set(xlabel=gettext("correct digits"), ylabel=translated(quantity))
    if measurements:
        axes.legend(fontsize="small", loc="upper left", bbox_to_anchor=(0.0, -0.2), ncols=2)


def _is_compared(measurement: Measurement) -> bool:
    return measurement.group in WHOLE_MOTION


def _time_of_series(study: "Study") -> float:
    return float(next((m.time for m in study.measurements if m.group is Group.SERIES), study.until))


WIDTH, HEIGHT_OF_ROW, HEIGHT_OF_SWEEP, MARGINS = 6.5, 0.2, 3.2, 1.4  # inches
MOST_DIGITS = 16.5


def stability_figure(reports: Sequence[CaseReport]) -> "Figure":
    """Return the figure of the correct digits of every method in every case.

    Parameters
    ----------
    reports : sequence of CaseReport
        The hard cases, in the order in which they are drawn.

    Returns
    -------
    Figure

    Raises
    ------
    HolonomError
        Matplotlib is not installed.
    """
    rows = [row for report in reports for row in _rows(report)]
    sweeps = [report.sweep for report in reports if report.sweep is not None]
    heights = [HEIGHT_OF_ROW * len(rows), *(HEIGHT_OF_SWEEP for _ in sweeps)]
    with figure_style():
        figure = new_figure(WIDTH, sum(heights) + MARGINS)
        panels = figure.subplots(len(heights), 1, height_ratios=heights, squeeze=False)[:, 0]
        _draw_digits(panels[0], rows)
        for panel, sweep in zip(panels[1:], sweeps, strict=True):
            _draw_sweep(panel, sweep)
        return figure


def _rows(report: CaseReport) -> list[Result | str]:
    """Yield the name of a case, then the methods with digits to show."""
    return [report.case.name, *(result for result in report.results if result.digits is not None)]


def _draw_digits(axes: "Axes", rows: Sequence[Result | str]) -> None:
    shown = {place: row for place, row in enumerate(rows) if isinstance(row, Result)}
    for outcomes, colour, marker in (({Outcome.HOLDS}, BLUE, "o"), ({Outcome.LOSES, Outcome.FAILS}, VERMILION, "X")):
        digits = {place: result.digits for place, result in shown.items() if result.outcome in outcomes}
        axes.hlines(list(digits), 0, list(digits.values()), color=colour, alpha=0.4, linewidth=3)
        axes.plot(list(digits.values()), list(digits), marker, color=colour, clip_on=False)
    labels = [
        f"{translated(row.method)}: {translated(row.quantity)}" if isinstance(row, Result) else translated(row)
        for row in rows
    ]
    axes.set_yticks(range(len(rows)), labels, fontsize="small")
    for place, label in enumerate(axes.get_yticklabels()):
        label.set_fontweight("normal" if place in shown else "bold")
    axes.tick_params(axis="y", length=0)
    axes.grid(False, axis="y")
    axes.set(xlim=(0, MOST_DIGITS), xticks=range(0, 17, 2), ylim=(len(rows) - 0.5, -0.5))
    axes.set_xlabel(gettext("correct decimal digits: a dot has the required ones, a cross has not"), loc="right")


def _draw_sweep(axes: "Axes", sweep: Sweep) -> None:
    for (method, digits), colour, marker, line in zip(sweep.digits.items(), PALETTE, MARKERS, LINES, strict=False):
        axes.semilogx(sweep.values, digits, marker=marker, linestyle=line, color=colour, label=translated(method))
    axes.invert_xaxis()
    axes.set(xlabel=translated(sweep.variable), ylabel=gettext("digits of the accelerations"), ylim=(0, MOST_DIGITS))
    legend_above(axes)
