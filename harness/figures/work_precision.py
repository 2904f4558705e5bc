"""Work and precision: time and operations against the digits kept, method by method."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..benchmark.work_precision.measurement import WHOLE_MOTION, Group, Measurement
from .style import MARKERS, PALETTE, figure_style, new_figure, write_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..benchmark.work_precision.study import Study

WIDTH, HEIGHT = 11.0, 16.0  # inches
FEW_DIGITS = 20  # as far as numbers of the hardware reach, and a little beyond
SECONDS, OPERATIONS = "time / s", "operations"


@dataclass(frozen=True)
class Panel:
    """What one panel shows."""

    title: str
    shows: Callable[[Measurement], bool]
    quantity: str


PANELS = (
    Panel("Methods, to t = {until:g}", lambda m: _in_contest(m) and digits_of(m) <= FEW_DIGITS, SECONDS),
    Panel("The same by operations", lambda m: _in_contest(m) and digits_of(m) <= FEW_DIGITS, OPERATIONS),
    Panel("Many digits, to t = {until:g}", lambda m: m.group is Group.TAYLOR, SECONDS),
    Panel("The same by operations", lambda m: m.group is Group.TAYLOR, OPERATIONS),
    Panel("One series, to t = {instant:g}, order by order", lambda m: m.group is Group.SERIES, SECONDS),
    Panel("Cures of drift and the two solves", lambda m: m.group in {Group.DRIFT, Group.SOLVE}, SECONDS),
)
TITLE = "What accuracy costs: {scene}"


def draw_study(study: "Study", path: Path) -> None:
    """Draw a study in six panels.

    Parameters
    ----------
    path : Path
        The SVG file.

    Raises
    ------
    HolonomError
        The file cannot be written; Matplotlib is not installed.
    """
    with figure_style():
        figure = new_figure(WIDTH, HEIGHT)
        for axes, panel in zip(figure.subplots(3, 2).flat, PANELS, strict=True):
            _draw(axes, [m for m in study.measurements if panel.shows(m)], panel.quantity)
            axes.set_title(panel.title.format(until=float(study.until), instant=_instant_of_series(study)))
        figure.suptitle(TITLE.format(scene=study.scene), x=0.01, ha="left")
        figure.supxlabel(str(study.machine), x=0.01, ha="left", fontsize="small")
    write_figure(figure, path)


def digits_of(measurement: Measurement) -> float:
    """Decimal digits that a run kept."""
    return -math.log10(measurement.error)


def _draw(axes: "Axes", measurements: Sequence[Measurement], quantity: str) -> None:
    for index, method in enumerate(dict.fromkeys(m.method for m in measurements)):
        rows = [m for m in measurements if m.method == method]
        work = [m.seconds if quantity == SECONDS else m.operations for m in rows]
        # The second time around the palette, colours meet other markers.
        marker = MARKERS[(index + index // len(PALETTE)) % len(MARKERS)]
        line = "--" if rows[0].group is Group.SOLVER else "-"
        colour = PALETTE[index % len(PALETTE)]
        axes.semilogy([digits_of(m) for m in rows], work, color=colour, marker=marker, linestyle=line, label=method)
    axes.set(xlabel="digits kept", ylabel=quantity)
    if measurements:
        axes.legend(fontsize="small", loc="upper left", bbox_to_anchor=(0.0, -0.2), ncols=2)


def _in_contest(measurement: Measurement) -> bool:
    return measurement.group in WHOLE_MOTION


def _instant_of_series(study: "Study") -> float:
    return float(next((m.instant for m in study.measurements if m.group is Group.SERIES), study.until))
