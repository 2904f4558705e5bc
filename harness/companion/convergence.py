"""Convergence of the series of a motion: partial sums and radius of convergence.

Partial sums agree with the motion up to the radius of convergence, and leave it there. No order helps beyond. The more
terms, the more sharply they leave.

Of the paper's example, under u = u0 + t the motion is singular where 1 + 2 u^2 = 0, at t = -u0 ± i/sqrt(2): the series
converges up to sqrt(u0^2 + 1/2). Under u = u0 exp(t) it is entire. The
points are estimated from the coefficients alone.
"""

import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..figures.style import (
    BLUE,
    GREEN,
    INK,
    LINES,
    PALETTE,
    VERMILION,
    figure_style,
    legend_above,
    new_figure,
    svg_text,
    write_figure,
)
from ..files import shared
from ..language import gettext
from ..sandbox import Limits
from ..series.compute import compute_series
from ..series.power_series import MotionSeries
from ..series.radius import ENTIRE, Radius
from ..series.request import SeriesRequest

if TYPE_CHECKING:
    from matplotlib.axes import Axes


ORDERS = (2, 5, 10, 20, 40)
HEADROOM = 0.6  # of the motion's extent, above and below it
SMALLEST = 1e-16  # error that is still drawn


def draw_partial_sums(name: str, coefficients: Sequence[float], radius: Radius, times: NDArray, motion: NDArray) -> str:
    """Draw the partial sums of a series over its motion, and their errors, as SVG.

    Parameters
    ----------
    name : str
        The coordinate.
    coefficients : sequence of float
        Of (t - t0)^0, (t - t0)^1, ...: more than the highest of the orders drawn.
    radius : Radius
        Finite.
    times : ndarray, shape (k,)
        Times.
    motion : ndarray, shape (k,)
        Values of the integrated coordinate.

    Returns
    -------
    str
        SVG document.
    """
    with figure_style():
        figure = new_figure(6, 5)
        curves, errors = figure.subplots(2, 1, sharex=True)
        curves.plot(times, motion, color=INK, linewidth=3, alpha=0.5, label=gettext("motion"))
        for order, colour, line in zip(ORDERS, PALETTE, (*LINES, "-"), strict=False):
            sums = np.polynomial.polynomial.polyval(times, coefficients[: order + 1])
            curves.plot(times, sums, color=colour, linestyle=line, label=gettext("order %(order)s", order=order))
            errors.semilogy(times, np.maximum(abs(sums - motion), SMALLEST), color=colour, linestyle=line)
        _finish(curves, errors, name, motion, radius)
        return svg_text(figure)


def _finish(curves: "Axes", errors: "Axes", name: str, motion: NDArray, radius: Radius) -> None:
    extent = HEADROOM * np.ptp(motion)
    curves.set_ylim(motion.min() - extent, motion.max() + extent)
    curves.set_ylabel(gettext("%(quantity)s (dimensionless)", quantity=name))
    errors.set_ylabel(gettext("error (dimensionless)"))
    errors.set_xlabel(gettext("t (dimensionless)"))
    for axes in (curves, errors):
        axes.axvline(radius.estimate, color=INK, linestyle=":", linewidth=1)
    curves.text(radius.estimate, curves.get_ylim()[1], " " + gettext("radius"), va="top")
    legend_above(curves)


PAPER = shared("examples") / "paper" / "paper.mac"
LINEAR, EXPONENTIAL = "initial_motion_scene", "free_motion_scene"  # u = u0 + t, u = u0 exp(t)
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
    linear = _expanded(controls, LINEAR, max(ORDERS_OF_RADII))
    exponential = _expanded(controls, EXPONENTIAL, ORDER_OF_ENTIRE)
    coarse, fine = ([series.up_to(order).radius for series in linear] for order in ORDERS_OF_RADII)
    return RadiiFound(controls, coarse, fine, [series.radius for series in exponential])


def draw_radius(found: RadiiFound, file: Path) -> None:
    """Draw the radius of convergence and the nearest singularities against u0, as SVG.

    Parameters
    ----------
    found : RadiiFound
        Estimated radii.
    file : Path
        SVG file.

    Raises
    ------
    HolonomError
        Matplotlib is not installed, or the file cannot be written.
    """
    with figure_style():
        figure = new_figure(6, 9)
        radii, plane = figure.subplots(2, 1)
        _draw_radii(radii, *found)
        _draw_singularities(plane, found.controls, found.fine)
        write_figure(figure, file)


def _expanded(controls: Sequence[Fraction], scene: str, order: int) -> list[MotionSeries]:
    """Return a scene's motion, under each of the initial controls."""
    requests = [SeriesRequest(order, scene, settings={"u0": str(u0)}) for u0 in controls]
    with ThreadPoolExecutor(AT_ONCE) as pool:
        return list(pool.map(lambda request: compute_series(PAPER, request, Limits()), requests))


def _draw_radii(
    axes: "Axes",
    controls: Sequence[Fraction],
    coarse: Sequence[Radius],
    fine: Sequence[Radius],
    entire: Sequence[Radius],
) -> None:
    u0 = np.linspace(float(controls[0]), float(controls[-1]), 201)
    axes.plot(u0, np.sqrt(u0**2 + 0.5), color=INK, linewidth=1, label="√(u₀² + 1/2)")
    for radii, order, colour, marker in (
        (coarse, ORDERS_OF_RADII[0], VERMILION, "s"),
        (fine, ORDERS_OF_RADII[1], BLUE, "o"),
    ):
        known = [(float(u), r.estimate, r.uncertainty) for u, r in zip(controls, radii, strict=True) if r.estimate]
        axes.errorbar(
            *zip(*known, strict=True),
            fmt=marker,
            color=colour,
            label=gettext("u = u₀ + t, %(order)s orders", order=order),
        )
    infinite = [float(u) for u, radius in zip(controls, entire, strict=True) if radius == ENTIRE]
    axes.plot(
        infinite, [HIGHEST] * len(infinite), "^", color=GREEN, clip_on=False, label=gettext("u = u₀ exp(t): entire")
    )
    axes.set(xlabel=gettext("initial control u₀"), ylabel=gettext("radius of convergence"), ylim=(0, HIGHEST))
    axes.set_title(gettext("How far the series of the motion holds"), pad=12)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)


def _draw_singularities(axes: "Axes", controls: Sequence[Fraction], radii: Sequence[Radius]) -> None:
    drawn = list(zip(controls, radii, strict=True))[::2]
    true = [complex(-float(u), sign * math.sqrt(0.5)) for u, _ in drawn for sign in (-1, 1)]
    axes.plot(*_parts(true), "o", color=INK, fillstyle="none", markersize=10, label="1 + 2 (u₀ + t)² = 0")
    found = [z for _, radius in drawn for z in radius.singularities]
    axes.plot(*_parts(found), "x", color=BLUE, label=gettext("from %(order)s orders", order=ORDERS_OF_RADII[1]))
    for u0, _ in drawn:
        axes.annotate(f"u₀ = {float(u0):g}", (-float(u0), 0.88), ha="center", rotation=40, fontsize="small")
    axes.plot(0, 0, "+", color=INK)
    axes.annotate("t = 0", (0.07, 0.05))
    axes.set(xlabel="Re t", ylabel="Im t", xlim=(-2.4, 2.4), ylim=(-1.5, 1.5))
    axes.set_title(gettext("What stops it: singularities in the complex time plane"), pad=12)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)


def _parts(points: Sequence[complex]) -> tuple[list[float], list[float]]:
    return [z.real for z in points], [z.imag for z in points]
