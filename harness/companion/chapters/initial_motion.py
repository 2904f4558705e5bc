"""Chapter on the initial motion: state, accelerations and power series."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
from numpy.polynomial.polynomial import polyval
from sympy import Symbol

from ...figures.curves import Panel
from ...figures.style import with_symbols
from ...language import gettext
from ...number_texts import number, numbers
from ...series.power_series import MotionSeries
from ..cards import named_equations, scene_named
from ..runs import Run, answer
from . import INITIAL_SCENE, PAPER

BOB_SCENE = "drawn_in_scene"
LOW_ORDER, HIGH_ORDER = 3, 40
TIME, LAST = Fraction(1, 10), Fraction(1, 2)
SHOWN = "q1"  # the coordinate that is drawn

OPTIONS = (("order", LOW_ORDER), ("sensitivities", ("u0",)))
RUNS = {"varied": Run(answer, ("series", PAPER, INITIAL_SCENE, OPTIONS))}


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
    bob, expanded = results["bob"], results["expanded"]
    scene = scene_named(bob, BOB_SCENE)
    begun = {f"{name}_0": value for name, value in scene.initial_state.items()} | dict(scene.parameter_values)
    values = {Symbol(name, real=True): value for name, value in begun.items()}
    accelerations = named_equations(bob, BOB_SCENE)["initial_accelerations"].relations
    return {
        "bob_numbers": {str(each.left): each.right.subs(values) for each in accelerations},
        "slope": Fraction(results["varied"].sensitivities["d(lambda1, u0)"][0]),
        "time": TIME,
        "orders": (LOW_ORDER, HIGH_ORDER),
        "compared": _compared(expanded),
        "beginning": _beginning(expanded),
    }


def _compared(expanded: MotionSeries) -> list[tuple[str, mpmath.mpf, mpmath.mpf]]:
    """Return for each coordinate its name and partial sums of low and high order."""
    with mpmath.workdps(expanded.digits):
        step = mpmath.mpf(TIME.numerator) / TIME.denominator - number(expanded.t0)
        known = {name: numbers(series) for name, series in expanded.coordinates.items()}
        return [(name, *(mpmath.polyval(a[k::-1], step) for k in (LOW_ORDER, HIGH_ORDER))) for name, a in known.items()]


def _beginning(expanded: MotionSeries) -> Panel:
    """Return the beginning of a coordinate: its motion and its lowest partial sums."""
    coefficients = [float(number(each)) for each in expanded.coordinates[SHOWN]]
    times = np.linspace(0, float(LAST), 101)
    orders = {gettext("order %(order)s", order=order): order for order in range(1, LOW_ORDER + 1)}
    orders[gettext("motion")] = HIGH_ORDER
    return Panel(
        gettext("%(quantity)s (dimensionless)", quantity=with_symbols(SHOWN)),
        {name: (times, polyval(times, coefficients[: order + 1])) for name, order in orders.items()},
    )
