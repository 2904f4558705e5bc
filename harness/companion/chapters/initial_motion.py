"""Chapter on the initial motion: state, accelerations and power series."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
from sympy import Expr, Symbol

from ...figures.curves import Panel
from ...figures.style import with_symbols
from ...language import gettext
from ...number_texts import number, numbers
from ...record import Equation, Scene
from ...series.power_series import MotionSeries, NumberTexts
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
    accelerations = named_equations(bob, BOB_SCENE)["initial_accelerations"]
    return {
        "bob_numbers": _numeric_values(accelerations, scene_named(bob, BOB_SCENE)),
        "slope": Fraction(results["varied"].sensitivities["d(lambda1, u0)"][0]),
        "time": TIME,
        "orders": (LOW_ORDER, HIGH_ORDER),
        "compared": _compared(expanded),
        "beginning": beginning(expanded),
    }


def _numeric_values(equation: Equation, scene: Scene) -> dict[str, Expr]:
    """Return the right sides of an equation at the initial state, by left sides."""
    values = {f"{name}_0": value for name, value in scene.initial_state.items()} | dict(scene.parameter_values)
    numbers = {Symbol(name, real=True): value for name, value in values.items()}
    return {str(each.left): each.right.subs(numbers) for each in equation.relations}


def _compared(expanded: MotionSeries) -> list[tuple[str, mpmath.mpf, mpmath.mpf]]:
    """Return for each coordinate its name and partial sums of low and high order."""
    with mpmath.workdps(expanded.digits):
        step = mpmath.mpf(TIME.numerator) / TIME.denominator - number(expanded.t0)
        return [
            (name, _partial_sum(series[: LOW_ORDER + 1], step), _partial_sum(series, step))
            for name, series in expanded.coordinates.items()
        ]


def _partial_sum(coefficients: NumberTexts, step: mpmath.mpf) -> mpmath.mpf:
    """Return the sum of the known terms of a power series."""
    return mpmath.polyval(numbers(coefficients)[::-1], step)


def beginning(expanded: MotionSeries) -> Panel:
    """Return the beginning of a coordinate: its motion and its lowest partial sums.

    Parameters
    ----------
    expanded : MotionSeries
        Power series of the motion.

    Returns
    -------
    Panel
        Panel of the figure.
    """
    with mpmath.workdps(expanded.digits):
        coefficients = [float(each) for each in numbers(expanded.coordinates[SHOWN])]
    times = np.linspace(0, float(LAST), 101)
    orders = {gettext("order %(order)s", order=order): order for order in range(1, LOW_ORDER + 1)} | {
        gettext("motion"): HIGH_ORDER
    }
    sums = {name: np.polynomial.polynomial.polyval(times, coefficients[: k + 1]) for name, k in orders.items()}
    return Panel(
        gettext("%(quantity)s (dimensionless)", quantity=with_symbols(SHOWN)),
        {name: (times, values) for name, values in sums.items()},
    )
