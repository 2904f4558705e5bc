"""A motion with an effect and without it, seen from above."""

from typing import TYPE_CHECKING

from ..simulation.result import Simulation
from .style import BLUE, VERMILION, figure_style, new_figure, svg_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WIDTH, HEIGHT = 9.0, 4.8  # inches


def draw_with_and_without(present: Simulation, absent: Simulation, across: str, along: str) -> str:
    """Draw the way of a body in the plane of two coordinates, with an effect and without it.

    Parameters
    ----------
    across, along : str
        The coordinates on the two axes.

    Returns
    -------
    str
        SVG.
    """
    reach = 1.05 * max(abs(motion.coordinates[name]).max() for motion in (present, absent) for name in (across, along))
    with figure_style():
        figure = new_figure(WIDTH, HEIGHT)
        panels = figure.subplots(1, 2, sharex=True, sharey=True)
        panels[0].set(xlim=(-reach, reach), ylim=(-reach, reach))
        for panel, motion, colour in zip(panels, (absent, present), (BLUE, VERMILION), strict=True):
            _draw(panel, motion, across, along, colour)
            panel.set_xlabel(f"{across} (units of the scene)")
        panels[0].set_ylabel(f"{along} (units of the scene)")
        return svg_text(figure)


def _draw(axes: "Axes", motion: Simulation, across: str, along: str, colour: str) -> None:
    x, y = motion.coordinates[across], motion.coordinates[along]
    axes.plot(x, y, color=colour, linewidth=1)
    axes.plot(x[:1], y[:1], "o", color=colour, label="start")
    axes.plot(x[-1:], y[-1:], "s", color=colour, label=f"t = {motion.instants[-1]:g}")
    axes.set_title(motion.title, fontsize="small")
    axes.set_aspect("equal")
    axes.legend(loc="upper right")
