"""Chapter on the radius of convergence of a power series."""

from collections.abc import Mapping
from typing import Any

import mpmath
import numpy as np
import sympy
from numpy.polynomial.polynomial import polyval
from sympy import Expr, Symbol

from ...figures.curves import Panel, draw_curves
from ...figures.style import with_symbols
from ...language import gettext
from ...number_texts import number, numbers
from ...series.power_series import MotionSeries
from ...simulation.result import Simulation
from ..cards import named_equations, scene_named
from ..chapter import FILES
from ..convergence import draw_radius, find_radii
from ..expressions import zeros
from ..runs import Derived, Run
from . import INITIAL_SCENE

ORDERS, TIMES = (5, 10, 20, 40, 80), (0.5, 1.0)  # within the radius and beyond it
DRAWN = ORDERS[:-1]
COORDINATE = "q3"
HEADROOM = 0.6  # of the motion's extent, above and below it
SMALLEST = 1e-16  # error that is still drawn


RUNS = {"radius": Run(find_radii)}


def page(results: Mapping[str, Any]) -> dict[str, Any]:
    """Return values of the page.

    Parameters
    ----------
    results : mapping
        Results of the runs by their names.

    Returns
    -------
    dict
        Values by name.
    """
    paper, expanded, motion = results["paper"], results["series"], results["motion"]
    scene, divisor = scene_named(paper, INITIAL_SCENE), denominator(paper)
    law = {Symbol(name, real=True): value for name, value in scene.control_law.items()}
    values = {Symbol(name, real=True): value for name, value in scene.parameter_values.items()}
    exact = zeros(divisor.subs(law).subs(values))
    sums, truth = _partial_sums(expanded, motion), motion.coordinates[COORDINATE]
    places = [int(np.argmin(abs(motion.times - time))) for time in TIMES]
    return {
        "denominator": divisor,
        "exact": exact,
        "exact_radius": min(sympy.Abs(time - scene.time_span[0]) for time in exact),
        "coordinate": COORDINATE,
        "confronted": {motion.times[k]: [abs(each - truth)[k] for each in sums.values()] for k in places},
        "orders": ORDERS,
        FILES: {
            "partial-sums.svg": _draw(motion, sums, expanded.radius.estimate),
            "radius.svg": draw_radius(results["radius"]),
        },
    }


def denominator(paper: Derived) -> Expr:
    """Return the denominator of the accelerations (11).

    Parameters
    ----------
    paper : Derived
        Derivation of the paper's example.

    Returns
    -------
    Expr
        Common denominator.
    """
    accelerations = named_equations(paper)["accelerations"].relations
    return sympy.fraction(sympy.together(accelerations[0].right))[1]


def _partial_sums(expanded: MotionSeries, motion: Simulation) -> dict[int, np.ndarray]:
    """Return the partial sums of the coordinate along a motion, by order."""
    with mpmath.workdps(expanded.digits):
        coefficients = [float(each) for each in numbers(expanded.coordinates[COORDINATE])]
        times = motion.times.astype(float) - float(number(expanded.t0))
    return {order: polyval(times, coefficients[: order + 1]) for order in ORDERS}


def _draw(motion: Simulation, sums: Mapping[int, np.ndarray], radius: float) -> str:
    """Draw the partial sums over the motion, and their errors, as SVG."""
    times, truth = motion.times, motion.coordinates[COORDINATE]
    label = gettext("%(quantity)s (dimensionless)", quantity=with_symbols(COORDINATE))
    low, high = truth.min() - HEADROOM * np.ptp(truth), truth.max() + HEADROOM * np.ptp(truth)
    names = {gettext("order %(order)s", order=order): sums[order] for order in DRAWN}
    shown = {name: (times, np.where((low < each) & (each < high), each, np.nan)) for name, each in names.items()}
    errors = {name: (times, np.maximum(abs(each - truth), SMALLEST)) for name, each in names.items()}
    end = {gettext("radius"): (np.full(2, radius), np.array([low, high]))}
    panels = [
        Panel(
            gettext("%(quantity)s (dimensionless)", quantity=label), shown | {gettext("motion"): (times, truth)} | end
        ),
        Panel(gettext("error (dimensionless)"), errors, "log"),
    ]
    return draw_curves(panels, gettext("t (dimensionless)"))
