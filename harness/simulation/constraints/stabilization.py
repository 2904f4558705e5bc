"""Equations of motion for heyoka's integrators, with or without stabilization.

The projection program gives the least d and e, in the mass metric, with J d = -f and J e = -df/dt. With them

    Baumgarte:  d/dt q = v,            d/dt v = a + 2 gamma e + gamma^2 d,
    GGL:        d/dt q = v + gamma d,  d/dt v = a + gamma e,

where f obeys f'' + 2 gamma f' + gamma^2 f = 0 in the first, and f and df/dt die out like exp(-gamma t) in the second.
Baumgarte, Comput. Methods Appl. Mech. Eng. 1 (1972) 1. Gear, Gupta & Leimkuhler, J. Comput. Appl. Math. 12 (1985) 77,
whose multipliers mu and nu, d = A^-1 J^T mu and e = A^-1 J^T nu, act here through a rate instead of for ever.
"""

from fractions import Fraction
from typing import Any

from ...program.heyoka_function import dynamics, heyoka_expressions, import_heyoka
from ...program.motion_problem import MotionProblem
from ...program.motion_program import Program
from ...program.precision import Precision
from ..inputs import heyoka_inputs
from ..request import Stabilization

Equations = list[tuple[Any, Any]]


def equations_of_motion(problem: MotionProblem, program: Program, precision: Precision) -> Equations:
    """Return the first-order equations without stabilization.

    Each coordinate and velocity has its derivative. Open inputs are heyoka's parameters.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    program : Program
        Program with the accelerations as outputs.
    precision : Precision
        Numbers of the coefficients.

    Returns
    -------
    list of (expression, expression)
        Variable and derivative, coordinates before velocities.
    """
    return dynamics(program, heyoka_inputs(problem, precision.number("0")), precision.ratio)


def stabilized(
    equations: Equations, problem: MotionProblem, precision: Precision, stabilization: Stabilization, decay: float
) -> Equations:
    """Return equations of motion with the terms of a stabilization.

    Parameters
    ----------
    equations : list of (expression, expression)
        As `equations_of_motion` returns them.
    problem, precision : MotionProblem, Precision
        As for `equations_of_motion`.
    stabilization : Stabilization
        ``BAUMGARTE`` or ``GGL``.
    decay : float
        gamma, per unit of time.

    Returns
    -------
    list of (expression, expression)
    """
    gamma = import_heyoka().expression(precision.ratio(Fraction(decay)))
    two = import_heyoka().expression(precision.ratio(Fraction(2)))
    found = heyoka_expressions(problem.projection, heyoka_inputs(problem, precision.number("0")), precision.ratio)
    n = len(problem.coordinates)
    position = [found[f"position_correction[{s}]"] for s in range(1, n + 1)]
    velocity = [found[f"velocity_correction[{s}]"] for s in range(1, n + 1)]
    if stabilization is Stabilization.BAUMGARTE:
        pull = [two * gamma * e + gamma * gamma * d for d, e in zip(position, velocity, strict=True)]
        terms = [import_heyoka().expression(precision.number("0"))] * n + pull
    else:
        terms = [gamma * d for d in (*position, *velocity)]
    return [(variable, rate + term) for (variable, rate), term in zip(equations, terms, strict=True)]
