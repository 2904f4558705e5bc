"""Hard cases as a figure: the digits that each method keeps, and how they go as a case becomes harder."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..benchmark.hard_cases.case import CaseReport, Outcome, Result, Sweep
from .style import BLUE, LINES, MARKERS, PALETTE, VERMILION, figure_style, legend_above, new_figure, write_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WIDTH, HEIGHT_OF_ROW, HEIGHT_OF_SWEEP, MARGINS = 8.0, 0.2, 3.2, 1.4  # inches
MOST_DIGITS = 16.5


def draw_stability(reports: Sequence[CaseReport], file: Path) -> None:
    """Draw the digits that every method keeps of every case.

    Parameters
    ----------
    file : Path
        The SVG file.

    Raises
    ------
    HolonomError
        Matplotlib is not installed; the file cannot be written.
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
        write_figure(figure, file)


def _rows(report: CaseReport) -> list[Result | str]:
    """The name of a case, then what has digits to show."""
    return [report.case.name, *(result for result in report.results if result.digits is not None)]


def _draw_digits(axes: "Axes", rows: Sequence[Result | str]) -> None:
    shown = {place: row for place, row in enumerate(rows) if isinstance(row, Result)}
    for verdicts, colour, marker in (({Outcome.HOLDS}, BLUE, "o"), ({Outcome.LOSES, Outcome.FAILS}, VERMILION, "X")):
        digits = {place: result.digits for place, result in shown.items() if result.verdict in verdicts}
        axes.hlines(list(digits), 0, list(digits.values()), color=colour, alpha=0.4, linewidth=3)
        axes.plot(list(digits.values()), list(digits), marker, color=colour, clip_on=False)
    labels = [f"{row.method}: {row.quantity}" if isinstance(row, Result) else row for row in rows]
    axes.set_yticks(range(len(rows)), labels, fontsize="small")
    for place, label in enumerate(axes.get_yticklabels()):
        label.set_fontweight("normal" if place in shown else "bold")
    axes.tick_params(axis="y", length=0)
    axes.grid(False, axis="y")
    axes.set(xlim=(0, MOST_DIGITS), xticks=range(0, 17, 2), ylim=(len(rows) - 0.5, -0.5))
    axes.set_xlabel("decimal digits kept: a dot has those asked for, a cross has not")


def _draw_sweep(axes: "Axes", sweep: Sweep) -> None:
    for (method, digits), colour, marker, line in zip(sweep.digits.items(), PALETTE, MARKERS, LINES, strict=False):
        axes.semilogx(sweep.values, digits, marker=marker, linestyle=line, color=colour, label=method)
    axes.invert_xaxis()
    axes.set(xlabel=sweep.variable, ylabel="digits of the accelerations", ylim=(0, MOST_DIGITS))
    legend_above(axes)
