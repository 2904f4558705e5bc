"""Find singularities near the initial state from the equations of motion.

A motion can be singular if a divisor of its program, or an argument of a root or logarithm, vanishes. These functions
are continued along the power series into the complex plane of the time, and their zeros are found by Newton's method.
A zero counts if the result of the program is singular there: on a small circle around it a Laurent expansion has
negative powers, and a shorter series gives the same ones. This also finds singularities that are too weak to affect
the coefficients. Where the powers depend on the length of the series, the motion itself is continued around the zero.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import Any, NamedTuple

import mpmath
import numpy as np

from ..language import translatable
from ..program.arithmetic import ELEMENTARY, Arithmetic, run_program
from ..program.motion_program import (
    Call,
    Constant,
    Expression,
    Name,
    Operation,
    Program,
    calls_in,
    names_in,
    names_used,
)
from ..program.rewriting import computing
from .continuation import ends_at
from .radius import COARSE, COMPLEX_PAIR, REAL_TIME, TOO_FEW, UNDECIDED, Radius

MOST_WORK = 40_000  # operations times critical functions beyond which nothing is looked for
RADII, ANGLES = 36, 24  # of the points that Newton's method begins from
REACH = 1e4  # of the unit of the time, if no coefficient determines a radius
CORRECTIONS = 40
CLOSE = 1e-6  # relative distance of two zeros that are one
CONVERGED = 1e-7
REFINEMENTS, REFINED = 12, 1e-10  # steps in many digits, and the last of them, relative to a zero
DIGITS, CIRCLE, POINTS = 60, mpmath.mpf("1e-3"), 32  # of the test on a circle around a zero
SETTLED = 1e-3  # relative change of a negative power by a shorter series, below which it is one of the motion
WEAKEST = mpmath.mpf("1e-25")  # of an output on that circle: a negative power that is none
ROUNDED = mpmath.mpf("1e-45")  # of the largest output on that circle: one that is rounding
TRUNCATED = 1e-3  # largest relative size of the last terms at which a series represents the motion
SHORTER = 2 / 3  # of a series: the part that must give the same result
SLOWEST = 7.0  # errors fall as the power -1/3 of the orders or faster: one is at most this times its change
MOST_TESTED = 8
UNTOLD = (TOO_FEW, UNDECIDED)

Evaluate = Callable[[Any], Sequence[Any]]


def decided(radius: Radius, series: Sequence[Sequence[mpmath.mpf]], program: Program | None, t0: mpmath.mpf) -> Radius:
    """Return the radius of convergence, by a singularity of the equations if nearer.

    Otherwise, and if this leaves a nearer one open, it is the estimate from the coefficients.

    Parameters
    ----------
    radius : Radius
        Estimated from the coefficients.
    series : sequence of sequence of mpf
        Of the coordinates, in powers of t - t0.
    program : Program or None
        Of t, coordinates and velocities, or None if it is not known.
    t0 : mpf
        Initial time, in the scene's unit.

    Returns
    -------
    Radius
    """
    if program is None or _switches(program):
        return radius
    bound = REACH if radius.estimate is None else radius.estimate + radius.uncertainty
    zeros = sorted(_zeros(program, series, t0, bound), key=lambda zero: abs(zero.place))[:MOST_TESTED]
    for zero in zeros:
        others = (abs(each.place - zero.place) for each in zeros)
        width = min((apart / 2 for apart in others if apart > CLOSE * abs(zero.place)), default=np.inf)
        if abs(zero.place) <= bound and _is_singular(program, series, t0, zero.place, width):
            found = _refined(zero, series, t0)
            if _depends_on_state(program):
                if radius in UNTOLD:
                    return _at_most(abs(found.place), radius)
                if _leaves_open(radius, abs(found.place)):
                    return radius
            as_far = [each for each in zeros if abs(abs(each.place) - abs(zero.place)) <= CIRCLE * abs(zero.place)]
            refined = [found if each is zero else _refined(each, series, t0) for each in as_far]
            return _located(found, _each_once(each.place for each in refined))
    return radius


def _leaves_open(radius: Radius, distance: float) -> bool:
    """Return True if coefficients do not exclude a nearer singularity.

    The motion itself may be singular there, at times at which its equations are regular.
    """
    return (
        radius.estimate is not None
        and radius.uncertainty > COARSE * radius.estimate
        and distance > radius.estimate - radius.uncertainty
    )


def _at_most(bound: float, radius: Radius) -> Radius:
    note = translatable(
        "unknown, %(bound)s at most, where the equations of motion are singular; these orders do not show more",
        bound=f"{bound:.8g}",
    )
    return replace(radius, note=note)


def _located(zero: "_Refined", zeros: Sequence[complex]) -> Radius:
    """Return the radius of convergence, with all singularities at that distance."""
    distance = abs(zero.place)
    as_far = [z for z in zeros if abs(abs(z) - distance) <= max(CLOSE * distance, zero.error)]
    kind = REAL_TIME if abs(zero.place.imag) <= max(CLOSE * distance, zero.error) else COMPLEX_PAIR
    note = translatable("the equations of motion are singular there; %(kind)s", kind=kind)
    return Radius(distance, zero.error, tuple(as_far), note, located=True)


def _depends_on_state(program: Program) -> bool:
    """Return True if the accelerations depend on the state.

    If so, a motion may be singular at times at which its equations are regular.
    """
    return not names_used(computing(program, program.outputs)).isdisjoint(program.inputs[1:])


def _switches(program: Program) -> bool:
    return any(_is_switched(expression) for _, expression in program.assignments)


def _is_switched(expression: Expression) -> bool:
    """Return True for |x| and signs of x, but for those in real roots.

    Roots are analytic where x is not zero.
    """
    match expression:
        case Call(
            Operation.MULTIPLY,
            (
                Call(Operation.SIGN, (x,)),
                Call(Operation.POWER, (Call(Operation.ABS, (same,)), Fraction(numerator=p, denominator=q))),
            ),
        ) if x == same and p % 2 and q % 2:
            return _is_switched(x)
        case Call(Operation.POWER, (Call(Operation.ABS, (x,)), Fraction(numerator=p, denominator=q))) if (
            p % 2 == 0 and q % 2
        ):
            return _is_switched(x)
        case Call(operation, arguments):
            return operation in (Operation.ABS, Operation.SIGN) or any(map(_is_switched, arguments))
    return False


# ---- functions whose zeros may be singularities ----


class _Zero(NamedTuple):
    place: complex  # t - t0
    function: Program  # that vanishes there


class _Refined(NamedTuple):
    place: complex
    error: float


def _zeros(program: Program, series: Sequence[Sequence[mpmath.mpf]], t0: mpmath.mpf, bound: float) -> Iterator[_Zero]:
    """Return the zeros of the critical functions, each once for each function."""
    critical = _critical_functions(program)
    if len(critical.outputs) * critical.operations > MOST_WORK:
        return
    motion = [np.array([float(c) for c in row]) for row in series]
    if not all(np.isfinite(row).all() for row in motion):
        return
    for name in critical.outputs:
        part = computing(critical, {name})
        used = set().union(*(names_in(expression) for _, expression in part.assignments))
        within = _accurate_within([row for place, row in enumerate(motion) if used & _names_of(program, place)])
        places = _zeros_of(partial(_at, part, motion, float(t0)), min(bound, within))
        yield from (_Zero(place, part) for place in places)


def _names_of(program: Program, place: int) -> set[str]:
    """Return a coordinate and its velocity."""
    n = len(program.inputs) // 2
    return {program.inputs[1 + place], program.inputs[1 + n + place]}


def _critical_functions(program: Program) -> Program:
    """Return a program of critical functions that are not constant.

    These are divisors and arguments of roots and logarithms.
    """
    found: dict[Expression, str] = {}
    assignments: list[tuple[str, Expression]] = []
    moving = set(program.inputs)
    for name, expression in program.assignments:
        for call in calls_in(expression):
            for argument in _critical_arguments(call):
                if names_in(argument) & moving and argument not in found:
                    found[argument] = f"critical[{len(found)}]"
                    assignments.append((found[argument], argument))
        if names_in(expression) & moving:
            moving.add(name)
        assignments.append((name, expression))
    return replace(program, assignments=tuple(assignments), outputs={name: Name(name) for name in found.values()})


def _critical_arguments(call: Call) -> Iterator[Expression]:
    """Yield the arguments whose zeros are singularities of a call."""
    one, (first, *rest) = Fraction(1), call.arguments
    square = Call(Operation.MULTIPLY, (first, first))
    match call.operation:
        case Operation.DIVIDE:
            yield rest[0]
        case Operation.POWER if not (isinstance(rest[0], Fraction) and rest[0].denominator == 1 and rest[0] >= 0):
            yield first
        case Operation.SQRT | Operation.LN:
            yield first
        case Operation.TAN:
            yield Call(Operation.COS, (first,))
        case Operation.TANH:
            yield Call(Operation.COSH, (first,))
        case Operation.ARCTAN | Operation.ARSINH:
            yield Call(Operation.ADD, (one, square))
        case Operation.ARCSIN | Operation.ARCCOS | Operation.ARCOSH | Operation.ARTANH:
            yield Call(Operation.SUBTRACT, (one, square))
        case Operation.ARCTAN2:
            yield Call(Operation.ADD, (square, Call(Operation.MULTIPLY, (rest[0], rest[0]))))


def _accurate_within(motion: Sequence[np.ndarray]) -> float:
    """Return the distance up to which the truncated series are accurate."""
    found = np.inf
    for row in motion:
        last = np.abs(row[-3:]).max()
        if last > 0:
            found = min(found, float((TRUNCATED * np.abs(row).max() / last) ** (1 / (len(row) - 1))))
    return found


# ---- zeros ----


def _zeros_of(function: Callable[[np.ndarray], np.ndarray], bound: float) -> list[complex]:
    """Return the zeros of an analytic function within a distance.

    Newton's method starts from many points at once.
    """
    bound = min(bound, REACH)
    radii = np.concatenate([np.geomspace(1e-4, 1, RADII // 2), np.linspace(0.05, 1, RADII // 2)]) * bound
    z = (radii[:, None] * np.exp(2j * np.pi * (np.arange(ANGLES) + 0.3) / ANGLES)).ravel()
    last = np.full(z.shape, np.inf)
    with np.errstate(all="ignore"):
        for _ in range(CORRECTIONS):
            step = 1e-6 * (np.abs(z) + 1e-3 * bound)
            value, slope = function(z), (function(z + step) - function(z - step)) / (2 * step)
            change = value / slope
            last = np.where(np.isfinite(change), np.abs(change), last)
            z = z - np.where(np.isfinite(change), change, 0)
        near = np.isfinite(z) & (np.abs(z) <= bound) & (last <= CONVERGED * np.abs(z)) & (np.abs(z) > 1e-5 * bound)
    return _each_once(z[near])


def _each_once(zeros: Iterable[complex]) -> list[complex]:
    distinct: list[complex] = []
    for zero in sorted(map(complex, zeros), key=abs):
        if all(abs(zero - other) > CLOSE * abs(zero) for other in distinct):
            distinct.append(zero)
    return distinct


# ---- numbers ----


def _at(program: Program, motion: Sequence[np.ndarray], t0: float, z: np.ndarray) -> np.ndarray:
    """Return the one output of a program at complex times t0 + z, along the series."""
    states = [np.polynomial.polynomial.polyval(z, row) for row in motion]
    rates = [np.polynomial.polynomial.polyval(z, np.polynomial.polynomial.polyder(row)) for row in motion]
    inputs = dict(zip(program.inputs, [t0 + z, *states, *rates], strict=True))
    (found,) = run_program(program, inputs, COMPLEX).values()
    return np.broadcast_to(found, z.shape)


def _in_digits(program: Program, series: Sequence[Sequence[mpmath.mpf]], t0: mpmath.mpf) -> Evaluate:
    """Return all outputs of a program at a complex time t0 + z, along the series.

    The numbers are mpmath's.
    """
    rows = [list(reversed(row)) for row in series]

    def evaluate(z: Any) -> Sequence[Any]:
        states, rates = zip(*(mpmath.polyval(row, z, derivative=1) for row in rows), strict=True)
        inputs = dict(zip(program.inputs, [t0 + z, *states, *rates], strict=True))
        return list(run_program(program, inputs, MPMATH).values())

    return evaluate


def _refined(zero: _Zero, series: Sequence[Sequence[mpmath.mpf]], t0: mpmath.mpf) -> _Refined:
    """Return a zero in many digits, with its error.

    The error follows from the change by a shorter series.

    If it is not found again, the singularity is within the circle of `_is_singular`.
    """
    with mpmath.workdps(2 * DIGITS):
        shorter = [row[: int(len(row) * SHORTER)] for row in series]
        place, other = (_multiple_zero(_in_digits(zero.function, rows, t0), zero.place) for rows in (series, shorter))
        circle = CIRCLE * abs(zero.place)
        if place is None or other is None or abs(place - zero.place) > circle:
            return _Refined(zero.place, float(circle))
        return _Refined(complex(place), float(max(SLOWEST * abs(place - other), CONVERGED * abs(place))))


def _multiple_zero(evaluate: Evaluate, place: complex) -> Any:
    """Return a zero of any multiplicity by Newton's method, or None if there is none.

    The multiplicity is 1/(1 - f f''/f'^2) (Traub, Iterative Methods for the Solution of Equations, chapter 7).
    """
    z, step = mpmath.mpc(place), mpmath.mpf(10) ** (-DIGITS // 2) * abs(place)
    for _ in range(REFINEMENTS):
        (before,), (here,), (after,) = (evaluate(z + k * step) for k in (-1, 0, 1))
        slope, curvature = (after - before) / (2 * step), (after - 2 * here + before) / step**2
        below = slope**2 - here * curvature
        if here == 0 or below == 0:
            return z if here == 0 else None
        change = here * slope / below
        z -= change
        if abs(change) <= REFINED * abs(z):
            return z
    return None


def _is_singular(
    program: Program, series: Sequence[Sequence[mpmath.mpf]], t0: mpmath.mpf, zero: complex, width: float
) -> bool:
    """Return True if a program is singular at a zero of a critical function.

    No other zero is nearer to it than the width.
    """
    with mpmath.workdps(DIGITS):
        shorter = [row[: int(len(row) * SHORTER)] for row in series]
        found, others = (_negative_powers(program, rows, t0, mpmath.mpc(zero)) for rows in (series, shorter))
        pairs, least = zip(found, others, strict=True), ROUNDED * max(size for _, size in found)
        if any(a > max(least, WEAKEST * size) and abs(a - b) < SETTLED * a for (a, size), (b, _) in pairs):
            return True

    def outputs(z: complex, state: np.ndarray) -> np.ndarray:
        found = run_program(program, dict(zip(program.inputs, [float(t0) + z, *state], strict=True)), COMPLEX)
        return np.array(list(found.values()), dtype=complex)

    start = np.array([complex(row[k]) for k in range(2) for row in series])
    return ends_at(outputs, start, zero, width)


def _negative_powers(
    program: Program, series: Sequence[Sequence[mpmath.mpf]], t0: mpmath.mpf, zero: Any
) -> Sequence[tuple[Any, Any]]:
    """Return the largest negative Laurent coefficient and the largest value by output.

    The Laurent expansion is about a zero.
    """
    evaluate, radius = _in_digits(program, series, t0), CIRCLE * abs(zero)
    turns = [mpmath.expjpi(mpmath.mpf(2 * k) / POINTS) for k in range(POINTS)]
    rows = list(zip(*(evaluate(zero + radius * turn) for turn in turns), strict=True))
    return [(_largest_negative(row, turns), max(map(abs, row))) for row in rows]


def _largest_negative(row: Sequence[Any], turns: Sequence[Any]) -> Any:
    sums = (mpmath.fsum(value * turns[k * power % POINTS] for k, value in enumerate(row)) for power in (1, 2, 3))
    return max(map(abs, sums)) / POINTS


def _arithmetic(functions: Any, number: Callable[[Fraction], Any], erf: Callable[[Any], Any]) -> Arithmetic[Any]:
    """Arithmetic of complex numbers by the functions of a module."""

    def quotient(a: Any, b: Any) -> Any:
        return a / b if functions is np or b else functions.nan

    def power(base: Any, exponent: Any) -> Any:
        return base ** (int(exponent) if exponent.denominator == 1 else number(exponent))

    named = {op: getattr(functions, name) for op, name in ELEMENTARY.items() if hasattr(functions, name)}
    return Arithmetic(
        number=number,
        constants={Constant.PI: functions.pi, Constant.E: functions.e},
        power=power,
        operations={
            **named,
            Operation.ADD: lambda *terms: sum(terms[1:], terms[0]),
            Operation.MULTIPLY: lambda *factors: _product(factors),
            Operation.SUBTRACT: lambda a, b: a - b,
            Operation.DIVIDE: quotient,
            Operation.NEGATE: lambda a: -a,
            Operation.POWER: lambda a, b: a**b,
            Operation.ABS: lambda a: a,  # in real roots, here up to a factor of modulus one
            Operation.SIGN: lambda a: a**0,
            Operation.ERF: erf,
            Operation.ARCTAN2: lambda y, x: -1j * functions.log((x + 1j * y) / functions.sqrt(x * x + y * y)),
        },
    )


def _product(factors: Sequence[Any]) -> Any:
    found = factors[0]
    for factor in factors[1:]:
        found = found * factor
    return found


def _complex_erf(z: Any) -> Any:
    from scipy.special import erf

    return erf(z)


COMPLEX = _arithmetic(np, lambda fraction: complex(float(fraction)), _complex_erf)
MPMATH = _arithmetic(mpmath, lambda fraction: mpmath.mpf(fraction.numerator) / fraction.denominator, mpmath.erf)
