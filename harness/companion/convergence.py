"""Radius of convergence of the series of a motion.

Of the paper's example, under u = u0 + t the motion is singular where 1 + 2 u^2 = 0, at t = -u0 ± i/sqrt(2): the series
converges up to sqrt(u0^2 + 1/2). Under u = u0 exp(t) it is entire. The points are estimated from the coefficients
alone.
"""

import math
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..figures.style import BLUE, GREEN, INK, VERMILION, figure_style, new_figure, svg_text
from ..language import gettext
from ..sandbox import Limits
from ..series.compute import compute_series
from ..series.power_series import MotionSeries
from ..series.radius import ENTIRE, Radius
from ..series.request import SeriesRequest
from .chapters import FREE_SCENE, INITIAL_SCENE, PAPER

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CONTROLS = [Fraction(k, 4) for k in range(-8, 9)]
ORDERS_OF_RADII = (26, 160)  # few, so that the uncertainty shows; and many
ORDER_OF_ENTIRE = 60
HIGHEST = 2.5  # radius in the drawing
AT_ONCE = 2  # runs of Maxima


class RadiiFound(NamedTuple):
    """Radii by initial control: for u0 + t at low and high order, and for u0 exp(t)."""

    controls: Sequence[Fraction]
    coarse: list[Radius]
    fine: list[Radius]
    entire: list[Radius]


def find_radii(controls: Sequence[Fraction] = CONTROLS) -> RadiiFound:
    """Estimate the radii that `draw_radius` draws.

    Parameters
    ----------
    controls : sequence of Fraction
        Initial values u0.

    Returns
    -------
    RadiiFound
        Estimated radii.
    """
    linear = _expanded(controls, INITIAL_SCENE, max(ORDERS_OF_RADII))
    exponential = _expanded(controls, FREE_SCENE, ORDER_OF_ENTIRE)
    coarse, fine = ([series.up_to(order).radius for series in linear] for order in ORDERS_OF_RADII)
    return RadiiFound(controls, coarse, fine, [series.radius for series in exponential])


def _expanded(controls: Sequence[Fraction], scene: str, order: int) -> list[MotionSeries]:
    """Return a scene's motion, under each of the initial controls."""
    requests = [SeriesRequest(order, scene, settings={"u0": str(u0)}) for u0 in controls]
    with ThreadPoolExecutor(AT_ONCE) as pool:
        return list(pool.map(lambda request: compute_series(PAPER, request, Limits()), requests))


def draw_radius(found: RadiiFound) -> str:
    """Draw the radius of convergence and the nearest singularities against u0, as SVG.

    Parameters
    ----------
    found : RadiiFound
        Estimated radii.

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
        figure = new_figure(6, 9)
        radii, plane = figure.subplots(2, 1)
        _draw_radii(radii, found)
        _draw_singularities(plane, found)
        for axes in (radii, plane):
            axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)
        return svg_text(figure)


def _draw_radii(axes: "Axes", found: RadiiFound) -> None:
    u0 = np.linspace(float(found.controls[0]), float(found.controls[-1]), 201)
    axes.plot(u0, np.sqrt(u0**2 + 0.5), color=INK, linewidth=1, label="√(u₀² + 1/2)")
    kinds = zip((found.coarse, found.fine), ORDERS_OF_RADII, (VERMILION, BLUE), "so", strict=True)
    for radii, order, colour, marker in kinds:
        pairs = zip(found.controls, radii, strict=True)
        known = [(float(u), each.estimate, each.uncertainty) for u, each in pairs if each.estimate]
        label = gettext("u = u₀ + t, %(order)s orders", order=order)
        axes.errorbar(*zip(*known, strict=True), fmt=marker, color=colour, label=label)
    infinite = [float(u) for u, radius in zip(found.controls, found.entire, strict=True) if radius == ENTIRE]
    heights = np.full(len(infinite), HIGHEST)
    axes.plot(infinite, heights, "^", color=GREEN, clip_on=False, label=gettext("u = u₀ exp(t): entire"))
    axes.set(xlabel=gettext("initial control u₀"), ylabel=gettext("radius of convergence"), ylim=(0, HIGHEST))
    axes.set_title(gettext("Radius of convergence of the series of the motion"), pad=12)


def _draw_singularities(axes: "Axes", found: RadiiFound) -> None:
    drawn = found.controls[::2]
    true = [complex(-float(u), sign * math.sqrt(0.5)) for u in drawn for sign in (-1, 1)]
    _mark(axes, true, "o", color=INK, fillstyle="none", markersize=10, label="1 + 2 (u₀ + t)² = 0")
    estimated = (z for radius in found.fine[::2] for z in radius.singularities)
    _mark(axes, estimated, "x", color=BLUE, label=gettext("from %(order)s orders", order=ORDERS_OF_RADII[1]))
    for u0 in drawn:
        axes.annotate(f"u₀ = {float(u0):g}", (-float(u0), 0.88), ha="center", rotation=40, fontsize="small")
    _mark(axes, [0], "+", color=INK)
    axes.annotate("t = 0", (0.07, 0.05))
    axes.set(xlabel="Re t", ylabel="Im t", xlim=(-2.4, 2.4), ylim=(-1.5, 1.5))
    axes.set_title(gettext("Nearest singularities in the complex plane of the time"), pad=12)


def _mark(axes: "Axes", points: Iterable[complex], marker: str, **style: object) -> None:
    """Mark points of the complex plane."""
    found = np.array(list(points), dtype=complex)
    axes.plot(found.real, found.imag, marker, **style)
