"""Random search for a law that makes every motion free, in floating-point numbers.

The statement that no such law exists is tested by this search. Near a random time of the time span the controls are
polynomials in the time with unknown coefficients. Parameters without a value are drawn with both signs. The
multipliers of the bordered equations, times the sizes of the constraints' gradients, are minimized at random states
on the constraint manifold by the Levenberg-Marquardt method. If there is a law, the residual falls at least by the
fourth power of the interval's length. If the controls satisfy the equations at the time alone, it falls by the second
or first power. Maxima's results are not used.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import sympy as sp

from .independent import IndependentEquations
from .system import MechanicalSystem, dotted

TRIALS = 8
"""Random times, parameters and states from which the search starts."""

STEPS = 14
"""Largest number of Levenberg-Marquardt steps from each start."""

STATES = 4
"""Random states at each time."""

DEGREE = 5
"""Degree of the polynomials in the time."""

REACH = 0.02
"""Distance of the outermost times from the middle one."""

LARGEST_SYSTEM = 12
"""Accelerations and multipliers up to which the search is made."""

LARGEST_CONTROL = 1e3
"""Coefficients above this size are rejected: a multiplier may vanish towards infinity."""

VANISHING = 1e-9
NEARLY_VANISHING = 1e-4
"""Relative size of constraint forces taken for zero: at one time, and along a polynomial."""

NARROWING = 4
"""How many times shorter the second interval is."""

LEAST_FALL = NARROWING**3
"""How many times smaller the constraint forces of a law are there at least: between the second power and the fourth."""

Span = tuple[float, float]
Vector = list[float]


class FreeLaw(NamedTuple):
    """Controls for which all constraint forces seem to vanish near a time."""

    time: float
    reach: float  # of the times at which they were tried
    largest: float  # constraint force that was left there
    controls: Mapping[str, float]  # values at the time
    parameters: Mapping[str, float]  # those that were drawn


class _NoValueError(ArithmeticError):
    """An expression has no finite real value, or a state is singular."""


def find_free_law(
    system: MechanicalSystem, values: Mapping[sp.Symbol, sp.Expr], span: Span | None, seed: str
) -> FreeLaw | None:
    """Return controls for which the multipliers vanish in all random states, or None.

    None means that the search found none.

    Parameters
    ----------
    system : MechanicalSystem
    values : mapping of Symbol to Expr
        Values of the parameters. Others are drawn at random.
    span : tuple of two floats or None
        First and last time.
    seed : str
        The same seed gives the same search.

    Returns
    -------
    FreeLaw or None
        Law near one time.
    """
    if not system.controls or len(system.coordinates) + len(system.multipliers) > LARGEST_SYSTEM:
        return None
    try:
        numbers = _Numbers.of(system, values)
    except (NameError, TypeError, ValueError):
        return None
    for trial in range(TRIALS):
        draw = random.Random(f"{seed} {trial}")
        try:
            found = _Trial.drawn(numbers, span, draw).law(draw)
        except (_NoValueError, NameError, TypeError):
            continue
        if found is not None:
            return found
    return None


@dataclass(frozen=True)
class _Numbers:
    """The equations of a system as floating-point functions."""

    system: MechanicalSystem
    parameters: tuple[sp.Symbol, ...]
    manifold: Callable[..., list[Vector]]  # columns: the g constraints, then their n derivatives
    rates: Callable[..., list[Vector]]
    bordered: Callable[..., list[Vector]]  # columns: those of the matrix, then the constant terms

    @classmethod
    def of(cls, system: MechanicalSystem, values: Mapping[sp.Symbol, sp.Expr]) -> _Numbers:
        equations = IndependentEquations(system)
        motion = equations.bordered
        jacobian = [[f.diff(q) for q in system.coordinates] for f in system.constraints]
        moving = {
            *system.coordinates,
            *system.velocities,
            *(dotted(dots, u) for u in system.controls for dots in ("dot", "ddot")),
            *system.controls,
            system.time,
        }
        met = set().union(*(e.free_symbols for e in (*system.constraints, *motion.residuals)))
        parameters = tuple(sorted(met - moving - {*motion.unknowns} - {*values}, key=str))
        names = (
            system.time,
            *system.coordinates,
            *system.velocities,
            *(symbol for u in system.controls for symbol in (u, dotted("dot", u), dotted("ddot", u))),
            *parameters,
        )

        named = [sp.Dummy() for _ in names]
        inserted = {**values, **dict(zip(names, named, strict=True))}

        def function(columns: Sequence[Sequence[sp.Expr]]) -> Callable[..., list[Vector]]:
            flat = [entry.xreplace(inserted).xreplace(inserted) for column in columns for entry in column]
            evaluate = sp.lambdify(named, flat, modules=[{"sign": lambda x: (x > 0) - (x < 0)}, "math"], cse=True)
            height = len(columns[0])
            return lambda *point: list(_batched(evaluate(*point), height))

        return cls(
            system,
            parameters,
            function([system.constraints, *zip(*jacobian, strict=True)]),
            function([equations.constraint_derivatives]),
            function([*zip(*motion.coefficients, strict=True), motion.constants]),
        )


def _batched(numbers: Sequence[float], size: int) -> Iterator[Vector]:
    """Cut a sequence into lists of a size."""
    return (list(numbers[k : k + size]) for k in range(0, len(numbers), size))


@dataclass(frozen=True)
class _Trial:
    """A time, parameters and states for the search for a law."""

    numbers: _Numbers
    time: float
    reach: float
    parameters: Vector
    states: list[Vector]  # coordinates and velocities before they are moved onto the manifold

    @classmethod
    def drawn(cls, numbers: _Numbers, span: Span | None, draw: random.Random) -> _Trial:
        first, last = span or (-2.0, 2.0)
        reach = min(REACH, (last - first) / 10)
        time = draw.uniform(first + reach, last - reach)
        size = 2 * len(numbers.system.coordinates)
        return cls(
            numbers,
            time,
            reach,
            [draw.choice([-1, 1]) * draw.uniform(0.2, 2) for _ in numbers.parameters],
            [[draw.uniform(-1.5, 1.5) for _ in range(size)] for _ in range(STATES)],
        )

    def law(self, draw: random.Random) -> FreeLaw | None:
        """Search for a law, at the time alone first.

        Most systems without a law fail there.
        """
        controls = self.numbers.system.controls
        start = [draw.uniform(-1.5, 1.5) for _ in range(3 * len(controls))]
        scale = max(1.0, _norm(self.forces(start, 2, [0.0])))
        found, size = _minimized(lambda x: self.forces(x, 2, [0.0]), start)
        if size > VANISHING * scale or _norm(found) > LARGEST_CONTROL:
            return None
        start = [c for k in range(len(controls)) for c in (*found[3 * k : 3 * k + 3], *[0.0] * (DEGREE - 2))]
        found, size = self.polynomial(start)
        if size > NEARLY_VANISHING * scale or _norm(found) > LARGEST_CONTROL / self.reach**DEGREE:
            return None
        _, narrow = replace(self, reach=self.reach / NARROWING).polynomial(start)
        if narrow > max(VANISHING * scale, size / LEAST_FALL):
            return None
        return FreeLaw(
            self.time,
            self.reach,
            size,
            {u.name: found[k * (DEGREE + 1)] for k, u in enumerate(controls)},
            {p.name: value for p, value in zip(self.numbers.parameters, self.parameters, strict=True)},
        )

    def polynomial(self, start: Vector) -> tuple[Vector, float]:
        """Return coefficients with the smallest constraint forces, and their norm."""
        nodes = [self.reach * k / 2 for k in (-2, -1, 0, 1, 2)]
        return _minimized(lambda x: self.forces(x, DEGREE, nodes), start)

    def forces(self, coefficients: Vector, degree: int, nodes: Sequence[float]) -> Vector:
        """Return constraint forces in all states at all times for polynomial controls.

        The polynomials are in units of the reach.
        """
        found = []
        for node in nodes:
            controls = []
            for k in range(0, len(coefficients), degree + 1):
                controls += _polynomial(coefficients[k : k + degree + 1], node / self.reach, self.reach)
            for state in self.states:
                found += self._forces_in(state, controls, self.time + node)
        return found

    def _forces_in(self, state: Vector, controls: Vector, t: float) -> Vector:
        n, numbers = len(self.numbers.system.coordinates), self.numbers
        q, v = state[:n], state[n:]

        def evaluated(function: Callable[..., list[Vector]]) -> list[Vector]:
            try:
                return function(t, *q, *v, *controls, *self.parameters)
            except (ValueError, ZeroDivisionError, OverflowError):
                raise _NoValueError from None

        for _ in range(20):
            f, *slopes = evaluated(numbers.manifold)
            if _norm(f) < 1e-13 * (1 + _norm(q)):
                break
            q = _moved(q, f, slopes)
        else:
            raise _NoValueError
        v = _moved(v, *evaluated(numbers.rates), slopes)
        *columns, constants = evaluated(numbers.bordered)
        multipliers = _solved(list(zip(*columns, strict=True)), [-each for each in constants])[n:]
        gradients = (math.hypot(*gradient) for gradient in zip(*slopes, strict=True))
        return [size * each for size, each in zip(gradients, multipliers, strict=True)]


def _polynomial(c: Vector, s: float, unit: float) -> Vector:
    """Return value, first and second derivative of c0 + c1 t + c2 t^2/2 + ...

    The time is t = unit*s. The later terms are in powers of s.
    """
    powers = [c[0], c[1] * unit, c[2] * unit**2 / 2, *c[3:]]
    value = sum(a * s**k for k, a in enumerate(powers))
    rate = sum(k * a * s ** (k - 1) for k, a in enumerate(powers) if k > 0) / unit
    second = sum(k * (k - 1) * a * s ** (k - 2) for k, a in enumerate(powers) if k > 1) / unit**2
    return [value, rate, second]


def _moved(x: Vector, residuals: Vector, slopes: Sequence[Vector]) -> Vector:
    """Return the shortest Newton step.

    slopes[k] are the derivatives of the residuals by x[k].
    """
    range_of_rows = range(len(residuals))
    products = [[sum(slope[i] * slope[j] for slope in slopes) for j in range_of_rows] for i in range_of_rows]
    weights = _solved(products, residuals)
    return [
        each - sum(w * s for w, s in zip(weights, slope, strict=True)) for each, slope in zip(x, slopes, strict=True)
    ]


def _minimized(residuals: Callable[[Vector], Vector], start: Vector) -> tuple[Vector, float]:
    """Return the minimum by Levenberg-Marquardt steps, and the norm of the residuals."""
    x, damping = start, 1e-3
    r = residuals(x)
    for _ in range(STEPS):
        columns = []
        for k, each in enumerate(x):
            by = 1e-7 * (1 + abs(each))
            columns.append([(a - b) / by for a, b in zip(residuals([*x[:k], each + by, *x[k + 1 :]]), r, strict=True)])
        slope = [sum(a * b for a, b in zip(column, r, strict=True)) for column in columns]
        products = [[sum(a * b for a, b in zip(c, d, strict=True)) for d in columns] for c in columns]
        for _ in range(6):
            damped = [
                [p + (damping * (p + 1e-12) if k == j else 0) for j, p in enumerate(row)]
                for k, row in enumerate(products)
            ]
            try:
                trial = [a - b for a, b in zip(x, _solved(damped, slope), strict=True)]
                there = residuals(trial)
            except _NoValueError:
                there = None
            if there is not None and _norm(there) < _norm(r):
                x, r, damping = trial, there, damping / 10
                break
            damping *= 10
        else:
            break
        if _norm(r) < 1e-14:
            break
    return x, _norm(r)


def _solved(matrix: Sequence[Sequence[float]], right: Sequence[float]) -> Vector:
    """Solve by Gaussian elimination with the largest pivot of each column."""
    rows = [[*row, b] for row, b in zip(matrix, right, strict=True)]
    size = len(rows)
    for k in range(size):
        best = max(range(k, size), key=lambda i: abs(rows[i][k]))
        if not abs(rows[best][k]) > 1e-14 or not math.isfinite(rows[best][k]):
            raise _NoValueError
        rows[k], rows[best] = rows[best], rows[k]
        for i in range(k + 1, size):
            factor = rows[i][k] / rows[k][k]
            if factor:
                rows[i] = [a - factor * b for a, b in zip(rows[i], rows[k], strict=True)]
    x = [0.0] * size
    for k in reversed(range(size)):
        x[k] = (rows[k][size] - sum(rows[k][j] * x[j] for j in range(k + 1, size))) / rows[k][k]
    return x


def _norm(x: Sequence[float]) -> float:
    return max(map(abs, x), default=0.0)
