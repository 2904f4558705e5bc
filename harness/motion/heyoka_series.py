"""The initial motion of a scene as power series, in double or quadruple precision, by heyoka's Taylor integrators.

An integrator expands its state at every step, to an order that its tolerance decides: the order is asked for in those
terms, and the coefficients of the first step are taken. Multipliers and constraint forces are no state; each is the
rate of an additional one, which starts from zero.
"""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from harness.confined import Limits
from harness.failures import Failure, HolonomError
from harness.maxima import run_batch
from harness.motion.heyoka_function import dynamics, heyoka_expressions, import_heyoka
from harness.motion.program import Program, read_program
from harness.motion.request import scene_argument
from harness.motion.series import MotionSeries, Numbers, SeriesRequest

HIGHEST_ORDER = 370  # its tolerance exp(-2*order) is about the smallest number that a double holds


class Precision(StrEnum):
    """Floating-point numbers that heyoka computes with."""

    DOUBLE = "double"
    QUADRUPLE = "quadruple"


DIGITS = {Precision.DOUBLE: 17, Precision.QUADRUPLE: 36}  # decimal digits that tell any two numbers apart


@dataclass(frozen=True)
class InitialValueProblem:
    """A motion as a program of (t, q, dot q) alone, and where it starts.

    Attributes
    ----------
    title : str
    start : mapping of str to str
        The time, coordinates and velocities, as decimal digits.
    program : Program
    """

    title: str
    start: Mapping[str, str]
    program: Program


def compute_series(file: Path, request: SeriesRequest, precision: Precision, limits: Limits) -> MotionSeries:
    """Expand a scene's motion with heyoka.

    Parameters
    ----------
    file : Path
        The scene file.
    request : SeriesRequest
        Its digits do not matter.
    precision : Precision
    limits : Limits
        What Maxima may take to write the motion program.

    Returns
    -------
    MotionSeries

    Raises
    ------
    HolonomError
        As `harness.maxima.run_batch`; heyoka is not installed; the order is too high, or the coefficients overflow.
    """
    arguments = f"{scene_argument(request.scene)}, {DIGITS[precision]}"
    call = f"lambda([file], write_initial_value_problem(file, {arguments}))"
    problem = read_problem(run_batch(file, call, limits, request.settings))
    return expand(problem, request.order, precision)


def read_problem(text: str) -> InitialValueProblem:
    """Read what Maxima writes."""
    document = json.loads(text)
    return InitialValueProblem(document["title"], document["start"], read_program(json.dumps(document["program"])))


def expand(problem: InitialValueProblem, order: int, precision: Precision) -> MotionSeries:
    """Expand a motion in power series.

    Parameters
    ----------
    problem : InitialValueProblem
    order : int
        From 2 to `HIGHEST_ORDER`.
    precision : Precision

    Returns
    -------
    MotionSeries

    Raises
    ------
    HolonomError
        heyoka is not installed; the order is too high, or a coefficient is too large for the numbers.
    """
    integrator = make_integrator(problem, order, precision)
    integrator.step(write_tc=True)
    coefficients = integrator.tc
    if not np.all(np.isfinite(coefficients.astype(float))):
        raise HolonomError(
            Failure.ORDER_TOO_HIGH, detail="the coefficients leave the range of a double or are singular"
        )
    state, reactions = _names(problem.program)
    digits = DIGITS[precision]
    coordinates = state[: len(state) // 2]
    found = {name: _texts(row[: order + 1], digits) for name, row in zip(coordinates, coefficients, strict=False)}
    rates = {
        name: _texts([row[n + 1] * (n + 1) for n in range(order + 1)], digits)
        for name, row in zip(reactions, coefficients[len(state) :], strict=True)
    }
    return MotionSeries(
        scene=problem.program.scene or "",
        title=problem.title,
        order=order,
        t0=problem.start["t"],
        arithmetic=str(precision),
        coordinates=found,
        multipliers={name: row for name, row in rates.items() if not name.startswith("Lambda")},
        constraint_forces={name: row for name, row in rates.items() if name.startswith("Lambda")},
    )


def make_integrator(problem: InitialValueProblem, order: int, precision: Precision) -> Any:
    """Set up heyoka's integrator of a motion; its state ends with the integrals of multipliers and forces.

    Parameters
    ----------
    problem : InitialValueProblem
    order : int
        The coefficients of the multipliers reach it; those of the state go one further.
    precision : Precision

    Returns
    -------
    heyoka.taylor_adaptive_dbl or heyoka.taylor_adaptive_real128
    """
    if order > HIGHEST_ORDER:
        raise HolonomError(Failure.ORDER_TOO_HIGH, detail=f"heyoka reaches order {HIGHEST_ORDER}, not {order}")
    heyoka = import_heyoka()
    real = _real(heyoka, precision)
    state, reactions = _names(problem.program)
    equations = dynamics(problem.program, {}, lambda q: _ratio(q, real))
    variables = {symbol: heyoka.expression(symbol) for symbol in state}
    values = heyoka_expressions(problem.program, {"t": heyoka.time, **variables}, lambda q: _ratio(q, real))
    equations += [(heyoka.expression(f"integral of {name}"), values[name]) for name in reactions]
    start = [real(problem.start[name]) for name in state] + [real(0)] * len(reactions)
    return heyoka.taylor_adaptive(
        equations,
        np.array(start),
        time=real(problem.start["t"]),
        tol=real(math.exp(-2 * order) * (1 + 1e-9)),
        fp_type=real,
        compact_mode=True,  # the other mode's code grows with the square of the order: 30 s to compile at order 160
    )


def _names(program: Program) -> tuple[list[str], list[str]]:
    """The state, coordinates first, and what is no state: multipliers and constraint forces."""
    coordinates = [name for name in program.inputs if f"ddot({name})" in program.outputs]
    reactions = [name for name in program.outputs if not name.startswith("ddot(")]
    return [*coordinates, *(f"dot({name})" for name in coordinates)], reactions


def _real(heyoka: ModuleType, precision: Precision) -> type:
    return float if precision is Precision.DOUBLE else heyoka.real128


def _ratio(value: Fraction, real: type) -> Any:
    return real(str(value.numerator)) / real(str(value.denominator))


def _texts(row: Any, digits: int) -> Numbers:
    return tuple(str(x) if digits > DIGITS[Precision.DOUBLE] else f"{x:.{digits - 1}e}" for x in row)
