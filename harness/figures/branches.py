"""Draw equilibria over a control, with a panel for each coordinate.

Marker and colour show the stability.
"""

from typing import TYPE_CHECKING

from ..language import gettext
from ..stability.equilibria import Stability
from .style import BLUE, GREEN, ORANGE, VERMILION, figure_style, legend_above, new_figure, with_symbols

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..stability.branches import Branches

WIDTH, HEIGHT_OF_PANEL = 7.0, 3.0  # inches
MARKS = {
    Stability.ASYMPTOTIC: {"marker": "D", "color": GREEN},
    Stability.STABLE: {"marker": "o", "color": BLUE},
    Stability.UNSTABLE: {"marker": "o", "color": VERMILION, "markerfacecolor": "none"},
    Stability.UNDECIDED: {"marker": "x", "color": ORANGE},
}


def branches_figure(branches: "Branches") -> "Figure":
    """Return the figure of equilibria over a control.

    Parameters
    ----------
    branches : Branches
        Equilibria for each value of the control.

    Returns
    -------
    Figure

    Raises
    ------
    HolonomError
        Matplotlib is not installed.
    """
    names = list(next((each.coordinates for found in branches for each in found), {"": 0.0}))
    with figure_style():
        figure = new_figure(WIDTH, HEIGHT_OF_PANEL * len(names))
        panels = figure.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
        for stability, mark in MARKS.items():
            kind = [(found.controls[branches.control], each) for found in branches for each in found]
            kind = [(value, each.coordinates) for value, each in kind if each.stability is stability]
            for name, panel in zip(names, panels, strict=True):
                if kind:
                    across, up = zip(*((value, q[name]) for value, q in kind), strict=True)
                    panel.plot(across, up, linestyle="none", markersize=3.0, label=gettext(stability), **mark)
        for name, panel in zip(names, panels, strict=True):
            panel.set_ylabel(gettext("%(quantity)s\n(units of the scene)", quantity=with_symbols(name)))
        panels[0].set_xlim(min(branches.values), max(branches.values))
        panels[-1].set_xlabel(gettext("%(quantity)s (units of the scene)", quantity=with_symbols(branches.control)))
        legend_above(panels[0])
    return figure
