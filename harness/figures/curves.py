"""Draw curves over the time in panels below each other, and constraint drift."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..language import gettext
from ..simulation.request import Stabilization
from ..simulation.result import Simulation
from .style import LINES, MARKERS, PALETTE, figure_style, legend_above, new_figure, svg_text

WIDTH, HEIGHT_OF_PANEL = 6.0, 2.6  # inches


@dataclass(frozen=True)
class Panel:
    """One panel."""

    ylabel: str  # what is drawn, with its unit
    curves: Mapping[str, tuple[NDArray, NDArray]]  # times and values, by what the legend calls them
    scale: Literal["linear", "log"] = "linear"  # of the values
    points: Mapping[str, tuple[Sequence[float], Sequence[float]]] = field(default_factory=dict)  # drawn as marks
    limits: tuple[float | None, float | None] = (None, None)  # lowest and highest value that is shown


def draw_curves(panels: Sequence[Panel], xlabel: str) -> str:
    """Draw panels over one axis, as SVG.

    Parameters
    ----------
    panels : sequence of Panel
        From top to bottom.
    xlabel : str
        Label of the common axis, with its unit.

    Returns
    -------
    str
        SVG document.

    Raises
    ------
    HolonomError
        Matplotlib is not installed.
    """
    with figure_style():
        figure = new_figure(WIDTH, HEIGHT_OF_PANEL * len(panels))
        drawn = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
        for axes, panel in zip(drawn, panels, strict=True):
            for place, (label, (times, values)) in enumerate(panel.curves.items()):
                style = {"color": PALETTE[place % len(PALETTE)], "linestyle": LINES[place % len(LINES)]}
                axes.plot(times, values, label=label, **style)
            for place, (label, (x, y)) in enumerate(panel.points.items()):
                style = {"color": PALETTE[-1 - place], "markersize": 9 - 4 * place, "fillstyle": "none"}
                axes.plot(x, y, MARKERS[place], label=label, **style)
            axes.set(ylabel=panel.ylabel, yscale=panel.scale, ylim=panel.limits)
            legend_above(axes)
        drawn[-1].set_xlabel(xlabel)
        return svg_text(figure)


def draw_drift(motions: Mapping[Stabilization, Simulation]) -> str:
    """Draw the residuals of constraints and energy under each stabilization, as SVG.

    Zeros are not drawn: the axes are logarithmic.

    Parameters
    ----------
    motions : mapping of Stabilization to Simulation
        The same motion under each stabilization, with residuals and energy.

    Returns
    -------
    str
        SVG document.
    """
    errors = {
        gettext("distance from the constraints\n(dimensionless)"): lambda motion: motion.residuals["position"],
        gettext("energy out of balance\n(units of the scene)"): lambda motion: motion.energy["energy_error"],
    }
    panels = [
        Panel(
            what,
            {str(stabilization): (each.times, _nonzero(of(each))) for stabilization, each in motions.items()},
            "log",
        )
        for what, of in errors.items()
    ]
    return draw_curves(panels, gettext("t (units of the scene)"))


def _nonzero(errors: NDArray) -> NDArray:
    return np.where(errors == 0, np.nan, abs(errors))
