"""Power series of the initial motion, and its continuation, by heyoka.

heyoka's Taylor integrators expand their state at every step, to an order that depends on the tolerance. The tolerance
is chosen by the order, and the coefficients of the first step are taken. Multipliers and constraint forces are not in
the state. Each is the derivative of an additional state variable that is initially zero.

A continuation integrates step by step, with the precision of the numbers as tolerance.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from types import ModuleType
from typing import Any

import mpmath
import numpy as np

from ..failures import ErrorKind, HolonomError
from ..language import translatable
from ..program.expense import order_for, require_means
from ..program.heyoka_function import dynamics, heyoka_expressions, import_heyoka, zero_multipliers
from ..program.motion_problem import MotionProblem, motion_problem, require_expandable, require_signs_known
from ..program.motion_program import Program
from ..program.precision import GUARD_DIGITS, Precision, read_precision
from ..program.request import Request
from ..program.rewriting import with_numbers
from ..sandbox import Limits
from ..source import Source
from .power_series import Continuation, MotionSeries, NumberTexts
from .request import SeriesRequest

MOST_STEPS = 10**6  # of a continuation
ONCE, OFTEN = 0, 3  # LLVM's levels of optimisation: compiled in a tenth of the time, and run in half


def expand_by_heyoka(file: Source | Path, request: SeriesRequest, limits: Limits) -> MotionSeries:
    """Expand a scene's motion with heyoka, and continue it if requested.

    Parameters
    ----------
    file : Source or Path
        Scene file.
    request : SeriesRequest
        Its precision is not None. Its end, if any, is that of the continuation.
    limits : Limits
        Limits of each run of Maxima.

    Returns
    -------
    MotionSeries

    Raises
    ------
    HolonomError
        As `motion_problem`, `expand` and `continue_motion`.
    """
    precision = read_precision(str(request.precision))
    asked = Request(request.scene, settings=request.settings)
    problem = motion_problem(file, asked, limits, precision.digits + GUARD_DIGITS)
    motion = expand(problem, request.order, precision)
    if request.until is None:
        return motion
    return replace(motion, continuation=continue_motion(problem, request.until, precision))


def expand(problem: MotionProblem, order: int, precision: Precision) -> MotionSeries:
    """Expand a motion in power series, to order 2 or more.

    Parameters
    ----------
    problem : MotionProblem
        The motion, whose initial values have at least the digits of the precision.
    order : int
        Highest power of t - t0, at least 2.
    precision : Precision
        Numbers of heyoka.

    Returns
    -------
    MotionSeries
        Series of coordinates, multipliers, and observed constraint forces and controls, without continuation.

    Raises
    ------
    HolonomError
        heyoka is not installed, or the order is too high, or a coefficient is too large for the numbers.
    """
    require_signs_known(problem)
    require_means(problem, precision, order)
    integrator = expanding_integrator(problem, order, precision)
    integrator.step(write_tc=True)
    coefficients = integrator.tc
    if not np.all(np.isfinite(coefficients)):
        raise HolonomError(
            ErrorKind.ORDER_TOO_HIGH,
            detail=translatable(
                "the coefficients leave the range of %(precision)s or are singular", precision=precision.name
            ),
        )
    coordinates = zip(problem.coordinates, coefficients, strict=False)
    rates = zip(_computed(problem), map(_rate, coefficients[len(problem.state) :]), strict=True)
    computed = {name: _texts(row, precision) for name, row in rates}
    return MotionSeries(
        scene=problem.scene,
        title=problem.title,
        order=order,
        t0=problem.start["t"],
        arithmetic=precision.name,
        coordinates={name: _texts(row[: order + 1], precision) for name, row in coordinates},
        multipliers={name: row for name, row in computed.items() if name in problem.reactions},
        constraint_forces={name: row for name, row in computed.items() if name.startswith("Lambda")},
        controls={name: computed[name] for name in _controls(problem)},
        program=_of_state(problem),
    )


def _of_state(problem: MotionProblem) -> Program:
    """Return the motion program of the time and the state alone."""
    unused = {name: Fraction(0) for name in problem.multipliers}
    return with_numbers(with_numbers(problem.motion, problem.values), unused)


def continue_motion(problem: MotionProblem, until: Fraction, precision: Precision) -> Continuation:
    """Integrate a motion step by step to the time `until`.

    Parameters
    ----------
    problem : MotionProblem
        The motion, whose initial values have at least the digits of the precision.
    until : Fraction
        Final time, in the scene's unit. It may be before the initial time.
    precision : Precision
        Numbers of heyoka. Their rounding is the tolerance.

    Returns
    -------
    Continuation
        States after each step, the initial one first.

    Raises
    ------
    HolonomError
        heyoka is not installed, or the steps shrink to nothing, or there are more than `MOST_STEPS`.
    """
    last = precision.ratio(until)
    require_means(problem, precision, order_for(precision.digits + GUARD_DIGITS))
    integrator = _integrator(import_heyoka(), problem, precision, [])
    states = [(integrator.time, integrator.state.copy())]
    shortest = abs(last - integrator.time) * precision.number(f"1e-{precision.sure_digits}")

    def keep_state(following: Any) -> bool:
        states.append((following.time, following.state.copy()))
        return abs(following.last_h) > shortest or following.time == last

    outcome, *_ = integrator.propagate_until(last, callback=keep_state, max_steps=MOST_STEPS)
    if outcome != import_heyoka().taylor_outcome.time_limit:
        _raise_error(float(integrator.time), len(states))
    times, values = zip(*states, strict=True)
    rows = [(name, _texts(row, precision)) for name, row in zip(problem.state, zip(*values, strict=True), strict=True)]
    n = len(problem.coordinates)
    return Continuation(precision.sure_digits, _texts(times, precision), dict(rows[:n]), dict(rows[n:]))


def expanding_integrator(problem: MotionProblem, order: int, precision: Precision, effort: int = ONCE) -> Any:
    """Return heyoka's integrator for one expansion.

    Parameters
    ----------
    problem : MotionProblem
        The motion to expand.
    order : int
        Highest power of t - t0 for the multipliers. The state is expanded to one order more.
    precision : Precision
        Numbers of heyoka.
    effort : int
        Level of LLVM's optimisation, ``ONCE`` or ``OFTEN``.

    Returns
    -------
    taylor_adaptive
        Its state ends with the integrals of multipliers, constraint forces and controls.

    Raises
    ------
    HolonomError
        heyoka is not installed, or the order is too high.
    """
    if order > precision.highest_order:
        raise HolonomError(
            ErrorKind.ORDER_TOO_HIGH,
            detail=translatable(
                "in %(precision)s heyoka reaches order %(order)s",
                precision=precision.name,
                order=precision.highest_order,
            ),
        )
    heyoka = import_heyoka()
    variables = {"t": heyoka.time, **{name: heyoka.expression(name) for name in problem.state}}
    variables |= _unused(problem, precision)
    programs = filter(None, (problem.motion, problem.controls))
    values = {k: x for each in programs for k, x in heyoka_expressions(each, variables, precision.ratio).items()}
    integrals = [(heyoka.expression(f"integral of {name}"), values[name]) for name in _computed(problem)]
    return _integrator(
        heyoka,
        problem,
        precision,
        integrals,
        tol=precision.number(mpmath.nstr(mpmath.exp(-2 * order) * (1 + mpmath.mpf(1e-9)), 15)),
        opt_level=effort,
    )


def _integrator(
    heyoka: ModuleType, problem: MotionProblem, precision: Precision, integrals: Sequence[tuple], **options: Any
) -> Any:
    require_expandable(problem)
    start = [precision.number(problem.start[name]) for name in problem.state]
    return heyoka.taylor_adaptive(
        [
            *dynamics(problem.motion, _unused(problem, precision), precision.ratio),
            *integrals,
        ],
        np.array(start + [precision.number("0")] * len(integrals)),
        time=precision.number(problem.start["t"]),
        compact_mode=True,  # the other mode's code grows with the square of the order: 30 s to compile at order 160
        **precision.options,
        **options,
    )


def _computed(problem: MotionProblem) -> list[str]:
    """Return names of computed multipliers, constraint forces and controls."""
    unwanted = {*map("ddot({})".format, problem.coordinates), *problem.multipliers[len(problem.reactions) :]}
    return [*(name for name in problem.motion.outputs if name not in unwanted), *_controls(problem)]


def _controls(problem: MotionProblem) -> tuple[str, ...]:
    return tuple(problem.controls.outputs) if problem.controls else ()


def _unused(problem: MotionProblem, precision: Precision) -> dict[str, Any]:
    return zero_multipliers(problem.multipliers, precision.number("0"))


def _rate(coefficients: Sequence[Any]) -> list[Any]:
    """Return the coefficients of the derivative."""
    return [coefficients[n] * n for n in range(1, len(coefficients))]


def _texts(row: Sequence[Any], precision: Precision) -> NumberTexts:
    return tuple(map(precision.text, row))


def _raise_error(time_point: float, states: int) -> None:
    many = states > MOST_STEPS
    few = translatable("its radius of convergence shrinks to nothing")
    reason = translatable("it arrived after %(steps)s steps", steps=MOST_STEPS) if many else few
    raise HolonomError(
        ErrorKind.NO_CONTINUATION,
        detail=translatable(
            "the motion cannot be continued beyond t = %(time)s, where %(reason)s",
            time=f"{time_point:.10g}",
            reason=reason,
        ),
    )
