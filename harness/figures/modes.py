"""Draw eigenvalues in the complex plane, and modes on the drawing of the system.

A mode is drawn at four phases of its oscillation, in grey the state about which it oscillates. A system without a
drawing has its coordinates as stems.
"""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..language import gettext
from .drawing import extents
from .film import artist
from .style import BLUE, INK, VERMILION, figure_style, new_figure, with_symbols

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..stability.linearization import Linearization

MOST_MODES = 8  # panels, of the slowest modes
SIDE = 3.0  # inches of a panel
COLUMNS = 3
AMPLITUDE = 0.15  # of the size of the picture, by which the place that moves most moves
ROUNDING = 1e-9  # of the largest eigenvalue: parts that are shown as zero
SMALL = 1e-6  # of an amplitude: moves that are linear in it
PHASES = np.exp(1j * np.pi / 2 * np.arange(4))
LOOKS = ({"alpha": 1.0}, {"alpha": 0.35}, {"alpha": 1.0, "linestyle": "--"}, {"alpha": 0.35, "linestyle": "--"})
MARGIN = 1.15 * AMPLITUDE


def modes_figure(linear: "Linearization") -> "Figure":
    """Return the figure of eigenvalues and modes.

    Parameters
    ----------
    linear : Linearization
        Linear system about one state.

    Returns
    -------
    Figure

    Raises
    ------
    HolonomError
        Matplotlib is not installed.
    """
    values = _rounded(linear.eigenvalues, linear.eigenvalue_errors)
    shown = [k for k, value in enumerate(values) if value.imag >= 0][:MOST_MODES]
    rows = -(-(1 + len(shown)) // COLUMNS)
    with figure_style():
        figure = new_figure(SIDE * COLUMNS, SIDE * rows)
        first, *panels = figure.subplots(rows, COLUMNS, squeeze=False).ravel()
        first.axhline(0.0, color=INK, linewidth=0.6)
        first.axvline(0.0, color=INK, linewidth=0.6)
        first.plot(values.real, values.imag, "x", color=VERMILION)
        if not values.real.any():
            first.set_xlim(-1, 1)
        first.set(title=gettext("eigenvalues"), xlabel=gettext("real part"), ylabel=gettext("imaginary part"))
        for panel, k in zip(panels, shown, strict=False):
            panel.set_title(_written(values[k]))
            draw = _draw_stems if linear.drawing is None else _draw_shapes
            draw(panel, linear, linear.modes[:, k])
        for panel in panels[len(shown) :]:
            panel.set_axis_off()
        stems = {name: stem for panel in panels for stem, name in zip(*panel.get_legend_handles_labels(), strict=True)}
        if stems:
            figure.legend([*stems.values()], [*stems], loc="outside lower center", ncols=2)
    return figure


def _rounded(values: NDArray, errors: NDArray) -> NDArray:
    """Return eigenvalues with zeros for parts that are rounding errors."""
    least = np.where(np.abs(values) <= errors, np.inf, ROUNDING * np.max(np.abs(values), initial=0.0))
    return np.where(np.abs(values.real) > least, values.real, 0) + 1j * np.where(
        np.abs(values.imag) > least, values.imag, 0
    )


def _written(value: complex) -> str:
    real = f"{value.real:.4g} " if value.real or not value.imag else ""
    return f"{real}± {value.imag:.4g} i" if value.imag else real.rstrip()


def _draw_shapes(panel: "Axes", linear: "Linearization", mode: NDArray) -> None:
    shapes = linear.drawing.shapes
    numbers = _numbers(linear, np.zeros((len(mode), 1)))
    (left, right), (low, high) = extents(shapes, numbers)
    size = max(right - left, high - low) or 1.0
    moved = _numbers(linear, SMALL * (mode[:, None] * PHASES).real)
    farthest = max(np.max(np.abs(row - rest), initial=0.0) for row, rest in zip(moved, numbers, strict=True)) / SMALL
    moved = _numbers(linear, (mode[:, None] * PHASES).real * AMPLITUDE * size / (farthest or 1.0))
    for shape, rest, row in zip(shapes, numbers, moved, strict=True):
        artist(panel, shape, rest, color=INK, alpha=0.25)(0)
        for frame, look in enumerate(LOOKS):
            artist(panel, shape, row, **look)(frame)
    room = MARGIN * size
    panel.set(xlim=(left - room, right + room), ylim=(low - room, high + room), aspect="equal")


def _numbers(linear: "Linearization", deviations: NDArray) -> list[NDArray]:
    times = np.full(deviations.shape[1], linear.point["t"])
    places = {q: linear.point[q] + row for q, row in zip(linear.coordinates, deviations, strict=True)}
    return linear.drawing.numbers(times, places)


def _draw_stems(panel: "Axes", linear: "Linearization", mode: NDArray) -> None:
    places = np.arange(len(mode))
    parts = (mode.real, BLUE, gettext("real part")), (mode.imag, VERMILION, gettext("imaginary part"))
    for part, colour, name in parts:
        if part.any():
            panel.stem(places, part, linefmt=colour, basefmt=INK, markerfmt="o", label=name)
    panel.set_xticks(places, [with_symbols(name) for name in linear.coordinates], rotation=90, fontsize="x-small")
