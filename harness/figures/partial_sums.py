"""Partial sums of a motion's power series: they follow the motion up to the radius of convergence, and leave it there.

No order helps beyond the radius. The more terms, the more sharply they leave.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..series.radius import Radius
from .style import INK, LINES, PALETTE, figure_style, legend_above, new_figure, svg_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ORDERS = (2, 5, 10, 20, 40)
HEADROOM = 0.6  # of the motion's extent, above and below it
SMALLEST = 1e-16  # error that is still drawn


def draw_partial_sums(name: str, coefficients: Sequence[float], radius: Radius, times: NDArray, motion: NDArray) -> str:
    """Draw the partial sums of a series over the motion that it is of, and their errors.

    Parameters
    ----------
    name : str
        The coordinate.
    coefficients : sequence of float
        Of (t - t0)^0, (t - t0)^1, ...: more than the highest of the orders drawn.
    radius : Radius
        Finite.
    times, motion : ndarray, shape (k,)
        t - t0, and the coordinate there, from an integration that does not know the series.

    Returns
    -------
    str
        SVG.
    """
    with figure_style():
        figure = new_figure(8, 6)
        curves, errors = figure.subplots(2, 1, sharex=True)
        curves.plot(times, motion, color=INK, linewidth=3, alpha=0.5, label="motion")
        for order, colour, line in zip(ORDERS, PALETTE, (*LINES, "-"), strict=False):
            sums = np.polynomial.polynomial.polyval(times, coefficients[: order + 1])
            curves.plot(times, sums, color=colour, linestyle=line, label=f"order {order}")
            errors.semilogy(times, np.maximum(abs(sums - motion), SMALLEST), color=colour, linestyle=line)
        _finish(curves, errors, name, motion, radius)
        return svg_text(figure)


def _finish(curves: "Axes", errors: "Axes", name: str, motion: NDArray, radius: Radius) -> None:
    extent = HEADROOM * np.ptp(motion)
    curves.set_ylim(motion.min() - extent, motion.max() + extent)
    curves.set_ylabel(f"{name} (dimensionless)")
    errors.set_ylabel("error (dimensionless)")
    errors.set_xlabel("t (dimensionless)")
    for axes in (curves, errors):
        axes.axvline(radius.estimate, color=INK, linestyle=":", linewidth=1)
    curves.text(radius.estimate, curves.get_ylim()[1], " radius", va="top")
    legend_above(curves)
