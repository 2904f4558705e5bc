"""Picture of the paper's example: a plane hinged along q1 + q2 = 0, tilted by u.

The particle at (q1, q2, q3) stays on the plane q3 = u (q1 + q2). The reaction is lambda df/dq = lambda (-u, -u, 1),
normal to it.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..figures.style import BLUE, GREEN, INK, VERMILION, figure_style, new_figure, svg_text
from ..language import gettext

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SEEN = np.array([[-7.0, 24.0, 0.0], [-14.4, -4.2, 20.0]]) / 25  # rows: to the right and upwards on the page
REACH, ARROW, WIDE = 3.2, 1.3, 1.7  # lengths of axes, of the reaction, half the width of the plane
ROOM = 1.3  # for a label to the right of the plane
ABOVE = 1.25  # how far the plane goes beyond the particle


def draw_tilted_plane(particle: Sequence[float], tilt: float) -> str:
    """Draw the plane tilted by u, the particle on it and the reaction, as SVG.

    Parameters
    ----------
    particle : sequence of float
        Position q1, q2, q3.
    tilt : float
        Control u.

    Returns
    -------
    str
        SVG document.
    """
    q = np.asarray(particle, dtype=float)
    foot = np.array([q[0] - q[1], q[1] - q[0], 0.0]) / 2
    along, up = np.array([1.0, -1.0, 0.0]) / np.sqrt(2), ABOVE * (q - foot)
    level = np.array([up[0], up[1], 0.0])
    normal = np.array([-tilt, -tilt, 1.0])
    with figure_style():
        figure = new_figure(5.6, 4.4)
        axes = figure.subplots()
        for place, name in enumerate(("q₁", "q₂", "q₃")):
            _arrow(axes, np.zeros(3), REACH * np.eye(3)[place], INK, 1.0)
            _label(axes, 1.07 * REACH * np.eye(3)[place], name, INK)
        corners = [foot - WIDE * along, foot + WIDE * along]
        _fill(axes, [*corners, corners[1] + level, corners[0] + level], INK, 0.06)
        _fill(axes, [*corners, corners[1] + up, corners[0] + up], BLUE, 0.18)
        axes.plot(*_seen(np.array(corners)).T, color=INK, linewidth=3.5)
        _label(axes, corners[0] + np.array([0.0, 0.1, 0.2]), gettext("hinge: q₁ + q₂ = 0"), INK, "left")
        rise = [corners[0] + np.array([level[0], level[1], part * up[2]]) for part in np.linspace(0, 1, 9)]
        axes.plot(*_seen(np.array(rise)[:-1]).T, color=VERMILION, linewidth=1.6)
        _arrow(axes, rise[-2], rise[-1] - rise[-2], VERMILION, 1.6)
        _label(axes, rise[4] + np.array([0.0, 0.12, 0.0]), gettext("the control u\ntilts the plane"), VERMILION, "left")
        _arrow(axes, q, ARROW * normal, GREEN, 2.2)
        _label(axes, q + 1.12 * ARROW * normal, gettext("reaction λ ∂f/∂q"), GREEN, "left")
        axes.plot(*_seen(q), "o", color=VERMILION, markersize=9)
        _label(axes, q + np.array([0.0, 0.25, 0.2]), gettext("particle"), INK, "left")
        axes.set_aspect("equal")
        axes.margins(0.08)
        axes.set_xlim(right=axes.get_xlim()[1] + ROOM)
        axes.set_axis_off()
        return svg_text(figure)


def _seen(points: NDArray) -> NDArray:
    return points @ SEEN.T


def _fill(axes: "Axes", corners: Sequence[NDArray], colour: str, strength: float) -> None:
    axes.fill(*_seen(np.array(corners)).T, facecolor=colour, alpha=strength, edgecolor=colour, linewidth=1)


def _arrow(axes: "Axes", start: NDArray, way: NDArray, colour: str, width: float) -> None:
    style = {"arrowstyle": "-|>", "color": colour, "linewidth": width, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", _seen(start + way), _seen(start), arrowprops=style)
    axes.plot(*_seen(np.array([start, start + way])).T, linestyle="none")


def _label(axes: "Axes", place: NDArray, text: str, colour: str, side: str = "center") -> None:
    axes.annotate(text, _seen(place), color=colour, ha=side, va="center", fontsize=11)
