"""Drift: how far a motion leaves its constraints, and its energy balance, under each cure."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..simulation.request import Stabilization
from ..simulation.result import Simulation
from .style import LINES, PALETTE, figure_style, legend_above, new_figure, svg_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WIDTH, HEIGHT = 9.0, 6.5  # inches


def draw_drift(motions: Mapping[Stabilization, Simulation]) -> str:
    """Draw the residuals of the constraints, and the error of the energy, against the time.

    Parameters
    ----------
    motions : mapping of Stabilization to Simulation
        One motion under each cure, with its residuals and its energy.

    Returns
    -------
    str
        SVG.
    """
    with figure_style():
        figure = new_figure(WIDTH, HEIGHT)
        constraints, energy = figure.subplots(2, 1, sharex=True)
        for (cure, motion), colour, line in zip(motions.items(), PALETTE, LINES, strict=False):
            style = {"color": colour, "linestyle": line, "label": cure}
            _draw(constraints, motion.instants, motion.residuals["position"], **style)
            _draw(energy, motion.instants, motion.energy["energy_error"], **style)
        constraints.set_ylabel("distance from the constraints\n(dimensionless)")
        energy.set_ylabel("energy out of balance\n(units of the scene)")
        energy.set_xlabel("t (units of the scene)")
        legend_above(constraints)
        return svg_text(figure)


def _draw(axes: "Axes", instants: NDArray, errors: NDArray, **style: str) -> None:
    axes.semilogy(instants, np.where(errors == 0, np.nan, abs(errors)), **style)
