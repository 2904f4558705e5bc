"""Radius of convergence of the series of a motion.

Of the paper's example, under u = u0 + t the motion is singular where 1 + 2 u^2 = 0, at t = -u0 ± i/sqrt(2): the series
converges up to sqrt(u0^2 + 1/2). Under u = u0 exp(t) it is entire. The points are estimated from the coefficients
alone.
"""

from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction

import numpy as np
from numpy.polynomial.polynomial import polyval
from numpy.typing import NDArray

from ..language import gettext
from ..number_texts import number, numbers
from ..sandbox import Limits
from ..series.compute import compute_series
from ..series.power_series import MotionSeries
from ..series.radius import Radius, estimate_radius
from ..series.request import SeriesRequest
from . import INITIAL_SCENE, PAPER

CONTROLS = [Fraction(k, 4) for k in range(-8, 9)]
ORDER = 160
AT_ONCE = 2  # runs of Maxima


def find_radii(controls: Sequence[Fraction] = CONTROLS) -> dict[float, Radius]:
    """Estimate radii of the paper's second task under other initial controls.

    Parameters
    ----------
    controls : sequence of Fraction
        Initial values u0.

    Returns
    -------
    dict of float to Radius
        Estimated radii by u0.
    """
    requests = [SeriesRequest(ORDER, INITIAL_SCENE, settings={"u0": str(u0)}) for u0 in controls]
    with ThreadPoolExecutor(AT_ONCE) as pool:
        found = pool.map(lambda request: compute_series(PAPER, request, Limits()), requests)
        return dict(zip(map(float, controls), map(radius_by_coefficients, found), strict=True))


def radius_by_coefficients(series: MotionSeries) -> Radius:
    """Estimate the radius of convergence without the equations of motion.

    Parameters
    ----------
    series : MotionSeries
        Power series of a motion.

    Returns
    -------
    Radius
    """
    return estimate_radius([numbers(row) for row in series.coordinates.values()])


def partial_sums(
    series: MotionSeries, name: str, times: NDArray, orders: Iterable[int]
) -> dict[str, tuple[NDArray, NDArray]]:
    """Return the partial sums of the power series of a coordinate, as curves.

    Parameters
    ----------
    series : MotionSeries
        Power series of a motion.
    name : str
        Name of the coordinate.
    times : ndarray, shape (k,)
        Times.
    orders : iterable of int
        Orders of the sums. The order of the whole series represents the motion.

    Returns
    -------
    dict of str to tuple of ndarray, shape (k,)
        Times and values by label.
    """
    coefficients = [float(number(each)) for each in series.coordinates[name]]
    steps = np.asarray(times, dtype=float) - float(number(series.t0))
    labels = {order: gettext("order %(order)s", order=order) for order in orders} | {series.order: gettext("motion")}
    return {labels[order]: (times, polyval(steps, coefficients[: order + 1])) for order in orders}


def errors_of(sums: Mapping[str, tuple[NDArray, NDArray]], truth: NDArray) -> dict[str, tuple[NDArray, NDArray]]:
    """Return the errors of partial sums, as curves.

    Parameters
    ----------
    sums : mapping of str to tuple of ndarray, shape (k,)
        Times and values by label.
    truth : ndarray, shape (k,)
        Values of the motion.

    Returns
    -------
    dict of str to tuple of ndarray, shape (k,)
        Times and errors by label.
    """
    return {label: (times, abs(values - truth)) for label, (times, values) in sums.items()}
