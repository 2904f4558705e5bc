"""A heyoka integrator in a unit of time near the motion's.

A Taylor coefficient of order 20 is in units of the time to the power of -20, beyond the range of doubles for motions of
1e-15 or 1e15 of a unit. Steps depend on the largest of all coefficients: where the unit is short, velocities are much
smaller than coordinates, and their errors count for nothing. In a unit near the motion's they are alike. Units are
powers of two, so that all numbers stay the same to the last bit.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...program.heyoka_function import import_heyoka
from ...program.motion_problem import MotionProblem
from ..constraints.stabilization import Equations
from ..evaluation import Numbers

NEAR = 10  # powers of two between units, the same ones for similar sizes
RANGE = 2.0**24  # units for one time: coefficients of their steps are within the range of doubles


def unit_of(problem: MotionProblem, time: float) -> float:
    """Return the unit of time for an integrator in double precision.

    One that is too long does no harm: velocities decide about steps, and coordinates follow from them.

    Parameters
    ----------
    problem : MotionProblem
        The motion, which gives the time span.
    time : float
        Nominal time of the motion.

    Returns
    -------
    float
        A power of two near the length of the time span, one for all lengths that are less but within the range.
    """
    first, last = map(float, problem.time_span or (0, 0))
    length = min(max(last - first, time), RANGE * time)
    unit = float(units_near(length))
    return unit if unit > 1 or length < 1 / RANGE else 1.0


def units_near(sizes: float | Numbers) -> float | Numbers:
    """Return powers of two near sizes.

    Parameters
    ----------
    sizes : float or ndarray
        Positive numbers.

    Returns
    -------
    float or ndarray
    """
    return 2.0 ** (NEAR * np.round(np.log2(sizes) / NEAR))


def in_unit(equations: Equations, unit: float, velocities: Sequence[Any] = ()) -> Equations:
    """Return equations of motion with their time in a unit.

    Parameters
    ----------
    equations : list of (expression, expression)
        Variable and derivative.
    unit : float
        Unit of the time.
    velocities : sequence of expression
        Variables that are in it, too.

    Returns
    -------
    list of (expression, expression)
    """
    heyoka = import_heyoka()
    unit, inverse = heyoka.expression(unit), heyoka.expression(1 / unit)
    scaled = {heyoka.time: unit * heyoka.time} | {velocity: inverse * velocity for velocity in velocities}
    found = [(variable, unit * heyoka.subs(rate, scaled)) for variable, rate in equations]
    return [(variable, unit * rate if variable in velocities else rate) for variable, rate in found]


class ScaledTime:
    """A heyoka integrator with a unit of time.

    It takes and gives times and states as they are.

    Of heyoka's interface, it has the part that the Taylor engine uses. The polynomials of a step are in powers of the
    time in the unit.

    Parameters
    ----------
    integrator : taylor_adaptive
        Of the equations that `in_unit` returns.
    unit : float
        Unit of the time, and of the velocities.

    Attributes
    ----------
    sizes : ndarray, shape (2n,)
        Variables of the integrator, in terms of the state.
    """

    def __init__(self, integrator: Any, unit: float) -> None:
        self._inner, self._unit = integrator, unit
        self.pars, self.tol, self.order = integrator.pars, integrator.tol, integrator.order
        self.sizes = sizes_of_state(len(integrator.state), unit)
        self.state = integrator.state / self.sizes

    @property
    def time(self) -> float:
        """The time that is reached."""
        return self._inner.time * self._unit

    @time.setter
    def time(self, time: float) -> None:
        self._inner.time = time / self._unit

    @property
    def dtime(self) -> tuple[float, float]:
        """The time in twice the digits: the sum of two numbers."""
        whole, rest = self._inner.dtime
        return whole * self._unit, rest * self._unit

    @property
    def last_h(self) -> float:
        """Length of the last step."""
        return self._inner.last_h * self._unit

    @property
    def tc(self) -> Any:
        """Coefficients of the last step's polynomials, in powers of time in the unit."""
        return self._inner.tc / self.sizes[:, None]

    def propagate_until(self, until: float, max_steps: int, **options: Any) -> tuple[Any, ...]:
        """Take steps as heyoka does (see `Integrator.propagate_until`)."""
        bound = {name: options[name] / self._unit for name in ("max_delta_t",) if name in options}
        self._inner.state[:] = self.state * self.sizes
        outcome, shortest, longest, *others = self._inner.propagate_until(
            until / self._unit, max_steps, **options | bound
        )
        self.state[:] = self._inner.state / self.sizes
        return outcome, shortest * self._unit, longest * self._unit, *others


def sizes_of_state(length: int, unit: float) -> Numbers:
    """Return the variables of an integrator in terms of the state.

    Parameters
    ----------
    length : int
        Of the state: coordinates, then velocities.
    unit : float
        Unit of the time.

    Returns
    -------
    ndarray, shape (2n,)
    """
    return np.repeat([1.0, unit], length // 2)
