"""Chapter on the radius of convergence of a power series."""

from collections.abc import Mapping
from functools import partial
from typing import Any

import mpmath
import sympy
from sympy import Expr, Symbol

from ...number_texts import number, numbers
from ...series.power_series import MotionSeries
from ...simulation.result import Simulation
from ..cards import named_equations, scene_named
from ..chapter import FILES
from ..convergence import draw_partial_sums, draw_radius, find_radii
from ..expressions import zeros
from ..runs import Derived, Run, drawn
from . import INITIAL_SCENE

ORDERS, TIMES = (5, 10, 20, 40, 80), (0.5, 1.0)  # within the radius and beyond it
COORDINATE = "q3"


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
    exact = _singular_times(paper, INITIAL_SCENE)
    start = scene_named(paper, INITIAL_SCENE).time_span[0]
    return {
        "denominator": denominator(paper),
        "exact": exact,
        "exact_radius": min(sympy.Abs(time - start) for time in exact),
        "coordinate": COORDINATE,
        "confronted": confronted(expanded, motion),
        "orders": ORDERS,
        FILES: {
            "partial-sums.svg": _partial_sums(expanded, motion),
            "radius.svg": drawn(partial(draw_radius, results["radius"])),
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


def _singular_times(paper: Derived, name: str) -> list[Expr]:
    """Return complex times at which the denominator of (11) vanishes in a scene."""
    scene = scene_named(paper, name)
    values = {Symbol(parameter, real=True): value for parameter, value in scene.parameter_values.items()}
    law = {Symbol(control, real=True): value.subs(values) for control, value in scene.control_law.items()}
    return zeros(denominator(paper).subs(law))


def _partial_sums(expanded: MotionSeries, motion: Simulation) -> str:
    """Return the figure of the partial sums of one coordinate, as SVG."""
    with mpmath.workdps(expanded.digits):
        coefficients = [float(each) for each in numbers(expanded.coordinates[COORDINATE])]
        times = motion.times - float(number(expanded.t0))
    return draw_partial_sums(COORDINATE, coefficients, expanded.radius, times, motion.coordinates[COORDINATE])


def confronted(expanded: MotionSeries, motion: Simulation) -> dict[float, list[float]]:
    """Return errors of the partial sums within the radius and beyond it, by order.

    Parameters
    ----------
    expanded : MotionSeries
        Power series of the motion.
    motion : Simulation
        Simulated motion.

    Returns
    -------
    dict of float to list of float
        Errors by time.
    """
    truth = motion.coordinates[COORDINATE]
    with mpmath.workdps(expanded.digits):
        coefficients = numbers(expanded.coordinates[COORDINATE])
        start = number(expanded.t0)
        places = [min(range(len(truth)), key=lambda k: abs(motion.times[k] - each)) for each in TIMES]
        return {
            float(motion.times[k]): [
                float(abs(mpmath.polyval(coefficients[order::-1], mpmath.mpf(motion.times[k]) - start) - truth[k]))
                for order in ORDERS
            ]
            for k in places
        }
