"""Curves over the time in panels below each other, the legend of each above it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from numpy.typing import NDArray

from .style import LINES, PALETTE, figure_style, legend_above, new_figure, svg_text

WIDTH, HEIGHT_OF_PANEL = 6.0, 2.6  # inches


@dataclass(frozen=True)
class Panel:
    """One panel.

    Attributes
    ----------
    ylabel : str
        What is drawn, with its unit.
    curves : mapping of str to (ndarray, ndarray)
        Instants and values, by what the legend calls them.
    scale : str
        Of the values.
    """

    ylabel: str
    curves: Mapping[str, tuple[NDArray, NDArray]]
    scale: Literal["linear", "log"] = "linear"


def draw_curves(panels: Sequence[Panel], xlabel: str) -> str:
    """Draw panels over one axis.

    Parameters
    ----------
    xlabel : str
        What is below all of them, with its unit.

    Returns
    -------
    str
        SVG.

    Raises
    ------
    HolonomError
        Matplotlib is not installed.
    """
    with figure_style():
        figure = new_figure(WIDTH, HEIGHT_OF_PANEL * len(panels))
        drawn = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
        for axes, panel in zip(drawn, panels, strict=True):
            for place, (label, (instants, values)) in enumerate(panel.curves.items()):
                style = {"color": PALETTE[place % len(PALETTE)], "linestyle": LINES[place % len(LINES)]}
                axes.plot(instants, values, label=label, **style)
            axes.set(ylabel=panel.ylabel, yscale=panel.scale)
            legend_above(axes)
        drawn[-1].set_xlabel(xlabel)
        return svg_text(figure)
