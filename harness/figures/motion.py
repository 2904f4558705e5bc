"""A motion as a figure: coordinates, and multipliers where the scene observes them, over the time."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..simulation.result import Simulation
from .style import LINES, PALETTE, figure_style, lettered, new_figure, write_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH, HEIGHT_OF_PANEL = 9.0, 3.2  # inches
UNLIKE = 30.0  # how many times larger a curve is that leaves another one flat
NOTHING = 1e-9  # size of a curve that is rounding alone
LEGIBLE = 12  # curves that a legend can still tell apart


def draw_motion(simulation: Simulation, file: Path) -> None:
    """Draw a motion into a file.

    Parameters
    ----------
    file : Path
        The SVG or PNG file.

    Raises
    ------
    HolonomError
        Matplotlib is not installed; the file cannot be written.
    """
    with figure_style():
        write_figure(motion_figure(simulation), file)


def motion_figure(simulation: Simulation) -> "Figure":
    """The figure of a motion, a panel for each kind of quantity that it holds.

    Raises
    ------
    HolonomError
        Matplotlib is not installed.
    """
    groups = {
        "coordinates": simulation.coordinates,
        "velocities": simulation.velocities,
        "multipliers": simulation.multipliers,
        "constraint forces": simulation.constraint_forces,
        "controls": simulation.controls,
    }
    drawn = [(title, part) for title, curves in groups.items() for part in of_like_size(curves)]
    with figure_style():
        figure = new_figure(WIDTH, HEIGHT_OF_PANEL * len(drawn))
        panels = figure.subplots(len(drawn), 1, sharex=True, squeeze=False)[:, 0]
        for panel, (title, curves) in zip(panels, drawn, strict=True):
            _draw(panel, simulation.instants.astype(float), curves)
            panel.set_ylabel(f"{title}\n(units of the scene)")
        panels[0].set_title(simulation.title)
        panels[-1].set_xlabel("t (units of the scene)")
    return figure


def of_like_size(curves: Mapping[str, NDArray]) -> list[dict[str, NDArray]]:
    """Curves in groups, each of which can be read on one axis: the largest first, none hundreds of times another.

    Curves that are zero but for rounding go with the smallest.
    """
    sizes = {name: float(np.max(np.abs(samples.astype(float)), initial=0.0)) for name, samples in curves.items()}
    parts: list[dict[str, NDArray]] = []
    top = 0.0
    for name in sorted(curves, key=sizes.__getitem__, reverse=True):
        if not parts or NOTHING < sizes[name] < top / UNLIKE:
            parts.append({})
            top = sizes[name]
        parts[-1][name] = curves[name]
    return [{name: curves[name] for name in curves if name in part} for part in parts]


def _draw(axes: "Axes", instants: NDArray[np.float64], curves: Mapping[str, NDArray]) -> None:
    for index, (name, samples) in enumerate(curves.items()):
        line = LINES[index // len(PALETTE) % len(LINES)]
        colour = PALETTE[index % len(PALETTE)]
        axes.plot(instants, samples.astype(float), linestyle=line, color=colour, label=lettered(name))
    if len(curves) <= LEGIBLE:
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
