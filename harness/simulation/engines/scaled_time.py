"""A heyoka integrator in a unit of time near the motion's.

A Taylor coefficient of order 20 is in units of the time to the power of -20, beyond the range of doubles for motions of
1e-15 or 1e15 of a unit. In other units of the time it is not. They are powers of two, so that all numbers stay the same
to the last bit.
"""

from math import frexp
from typing import Any

from ...program.heyoka_function import import_heyoka
from ...program.precision import Precision
from ..constraints.stabilization import Equations

NEAR = 24  # powers of two around one: times that are taken as they are


def unit_of(time: float, precision: Precision) -> Any:
    """Return the unit of time for an integrator.

    It is one for times near one and for numbers of a longer range.

    Parameters
    ----------
    time : float
        Nominal time of the motion.
    precision : Precision
        Numbers of the integrator.

    Returns
    -------
    number
        A power of two.
    """
    power = frexp(time)[1]
    return precision.number(repr(2.0**power) if precision.name == "double" and abs(power) > NEAR else "1")


def in_unit(equations: Equations, unit: float) -> Equations:
    """Return equations of motion with their time in a unit.

    Parameters
    ----------
    equations : list of (expression, expression)
        Variable and derivative.
    unit : float
        Unit of the time.

    Returns
    -------
    list of (expression, expression)
    """
    heyoka = import_heyoka()
    scaled = {heyoka.time: heyoka.expression(unit) * heyoka.time}
    return [(variable, heyoka.expression(unit) * heyoka.subs(rate, scaled)) for variable, rate in equations]


class ScaledTime:
    """A heyoka integrator with a unit of time.

    It takes and gives times as they are.

    Of heyoka's interface, it has the part that the Taylor engine uses. The polynomials of a step are in the unit.

    Parameters
    ----------
    integrator : taylor_adaptive
        Of the equations that `in_unit` returns.
    unit : float
        Unit of the time.
    """

    def __init__(self, integrator: Any, unit: float) -> None:
        self._inner, self._unit = integrator, unit
        self.state, self.pars, self.tol, self.order = (
            integrator.state,
            integrator.pars,
            integrator.tol,
            integrator.order,
        )

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
        return self._inner.tc

    def propagate_until(self, until: float, max_steps: int, **options: Any) -> tuple[Any, ...]:
        """Take steps as heyoka's integrators do.

        Parameters
        ----------
        until : float
            Last time.
        max_steps : int
            Largest number of steps.
        **options : object
            Those of heyoka.

        Returns
        -------
        tuple
            Outcome, shortest and longest step, number of steps, then heyoka's further results.
        """
        bound = {name: options[name] / self._unit for name in ("max_delta_t",) if name in options}
        outcome, shortest, longest, *others = self._inner.propagate_until(
            until / self._unit, max_steps, **options | bound
        )
        return outcome, shortest * self._unit, longest * self._unit, *others
