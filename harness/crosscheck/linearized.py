"""Verdicts on documents of `linearize` and `equilibria`.

Residuals and gradients are SymPy's, of the description alone. Nothing is solved a second time in the same way:

- The columns of C and D, with the accelerations that belong to them, are put into the gradients of Lagrange's equations
  and of the constraints, which must vanish. The derivatives of xi = N^T A dq and eta = N^T A dv must be rows of A, B.
- Eigenvalues and modes are put into A x = s x. Power sums show if all eigenvalues are there.
- States at rest are put into the equations. Their eigenvalues are those of a quadratic pencil between null spaces.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import scipy.linalg
import sympy as sp
from mpmath import mp

from ..description import Description
from ..simulation.constraints.directions import or_one
from ..simulation.matrices import Matrix, Vector
from .described_motion import DescribedMotion
from .evaluation import Steps
from .independent import IndependentEquations
from .irregular_point import IrregularPoint
from .law import SIGNED, is_switched
from .polynomial_equilibria import count_real_solutions, read_exact
from .report import CheckResult, Verdict
from .system import described_system, dotted, exact, gradient
from .taylor import Taylor

DIGITS = 7  # of results in double precision, in which they have to agree
SHAKEN, SHAKES = 1e-14, 4  # relative changes of values, whose effect is that of rounding errors, and their number
LARGER = 100  # rounding errors, in terms of that effect
ROUNDED = 1e-6  # of the largest terms: sizes of rounding errors, to `DIGITS`
ROUNDED_PLACE = 1e-12  # of the largest coordinate: what may be rounding
EXACT_DIGITS = 60  # in which exact values are put into the equations
SWITCHING = sp.sign, sp.Abs, sp.Heaviside, sp.Piecewise, sp.Max, sp.Min
NEARBY, NEARBY_DIGITS = mp.mpf("1e-60"), 150  # displacement to a limit, and digits there
MOST_ORIENTATIONS = 2  # with which solutions are counted: each is an unknown more
ENERGY = sp.Symbol("energy", real=True)


class Condition(NamedTuple):
    """A difference that should vanish, with the sizes of its terms."""

    what: str
    difference: Any  # None if it could not be computed
    size: Any = 1.0


class DescribedEquations:
    """The equations of a described scene and their gradients, in double precision.

    Controls that servo-constraints or prescribed reactions move are the last coordinates.
    """

    def __init__(self, description: Description, name: str) -> None:
        scene = next(each for each in description.scenes if each.name == name)
        self.motion = DescribedMotion(description, scene)
        system = described_system(description.system, scene.effects)
        values = {sp.Symbol(k, real=True): exact(x) for k, x in scene.parameter_values.items()}
        self.coordinates = (*system.coordinates, *_symbols((*self.motion.freed, *self.motion.moved)))
        self.controls = tuple(u for u in system.controls if u.name in scene.control_law)
        self.found = tuple(u for u in system.controls if u not in (*self.controls, *self.coordinates))
        self.multipliers, self._system, self._names = system.multipliers, system, {}
        self._values = values
        constraints = [*system.constraints, *map(exact, scene.servo_constraints)]
        rates = [system.time_derivative(f) for f in constraints]
        self.outputs = tuple(scene.outputs)
        momenta = gradient(system.kinetic_energy, system.velocities)
        L = system.kinetic_energy - system.potential_energy
        energy = sp.Add(*(v * p for v, p in zip(system.velocities, gradient(L, system.velocities), strict=True))) - L
        self._rows = {
            "equation": IndependentEquations(system).motion,
            "constraint": constraints,
            "rate": rates,
            "acceleration": [system.time_derivative(f) for f in rates],
            "output": [exact(scene.outputs[each]).subs(ENERGY, energy) for each in self.outputs],
        }
        mass = [entry for p in momenta for entry in gradient(p, system.velocities)]
        self._groups = {
            "q": self.coordinates,
            "v": tuple(dotted("dot", q) for q in self.coordinates),
            "a": tuple(dotted("ddot", q) for q in self.coordinates),
            "lambda": (*self.multipliers, *self.found),
            "u": self.controls,
            "du": tuple(dotted("dot", u) for u in self.controls),
            "ddu": tuple(dotted("ddot", u) for u in self.controls),
        }
        parts: dict[str, list[sp.Expr]] = {"mass": mass, "mass_rate": [system.time_derivative(entry) for entry in mass]}
        for row, expressions in self._rows.items():
            parts[row] = list(expressions)
            for group, symbols in self._groups.items():
                parts[f"{row}_by_{group}"] = [slope for each in expressions for slope in gradient(each, symbols)]
        self._shapes = {name: len(each) for name, each in parts.items()}
        self.orientations = [exact(each).subs(values) for each in description.system.orientations]
        self._at_rest = [each.subs(values) for row in ("equation", "constraint") for each in self._rows[row]]
        self._smooth = [_between_switchings(each.subs(values)) for part in parts.values() for each in part]
        self._steps = Steps(self._smooth)

    @cached_property
    def energy_change(self) -> str:
        """Change of the energy by forces: conserved, dissipated or open.

        The controls are constant. Forces have a potential, or are gyroscopic or dissipative: linear, or by the signs
        of factors of their power.
        """
        q, v = self._groups["q"], self._groups["v"]
        constant = dict.fromkeys([*self._groups["du"], *self._groups["ddu"]], 0)
        forces = sp.Matrix([each.subs(self._values).subs(constant) for each in self._system.forces])
        forces = forces.col_join(sp.zeros(len(q) - len(forces), 1))
        at_rest = forces.subs(dict.fromkeys(v, 0))
        slopes = at_rest.jacobian(q)
        power = sp.expand((forces - at_rest).dot(v))
        if any(sp.simplify(each) != 0 for each in slopes - slopes.T):
            return "open"
        if power == 0:
            return "conserved"
        damping = -sp.hessian(power, v) / 2
        linear = not damping.free_symbols and sp.expand(power + (sp.Matrix([v]) * damping).dot(v)) == 0
        takes = bool(damping.is_positive_semidefinite) if linear else bool(sp.factor(power).is_nonpositive)
        return "dissipated" if takes else "open"

    @property
    def linear(self) -> bool:
        """True if the equations are linear for constant controls."""
        moving = [symbol for group in ("q", "v", "a", "lambda") for symbol in self._groups[group]]
        polynomials = [each.as_poly(*moving) for each in self._at_rest]
        return all(each is not None and each.total_degree() <= 1 for each in polynomials)

    @property
    def changes_with_time(self) -> bool:
        """True if the equations of motion contain the time, except through controls."""
        time = sp.Symbol("t", real=True)
        return bool(self.motion.scene.prescribed_reactions) or any(each.has(time) for each in self._at_rest)

    @cached_property
    def reacting(self) -> list[int]:
        """Indices of multipliers that the scene does not prescribe."""
        given = self.motion.scene.prescribed_reactions
        return [beta for beta, name in enumerate(self.multipliers) if name.name not in given]

    def at_rest(self, controls: Mapping[str, float | str]) -> list[sp.Expr]:
        """Return the exact equations of states at rest.

        Parameters
        ----------
        controls : mapping of str to float or str
            Constant values, as they are written.

        Returns
        -------
        list of Expr
            Functions of the coordinates and multipliers that vanish.
        """
        moving = [symbol for group in ("v", "a", "du", "ddu") for symbol in self._groups[group]]
        constant = {sp.Symbol(name, real=True): sp.Rational(str(value)) for name, value in controls.items()}
        time = {sp.Symbol("t", real=True): sp.Rational(float(self.motion.first_time))}
        given = {
            sp.Symbol(name, real=True): exact(reaction).subs(self._values | time)
            for name, reaction in self.motion.scene.prescribed_reactions.items()
        }
        return [each.subs(given).subs(dict.fromkeys(moving, 0) | constant | time) for each in self._at_rest]

    def orientation(self, point: Mapping[str, float | sp.Expr]) -> list[int | None]:
        """Return the signs that no motion changes.

        Parameters
        ----------
        point : mapping of str to number
            Values of some names.

        Returns
        -------
        list of int or None
            None where another name decides.
        """
        values = {sp.Symbol(name, real=True): sp.sympify(value) for name, value in point.items()}
        found = [each.subs(values) for each in self.orientations]
        return [int(np.sign(float(each))) if each.is_number else None for each in found]

    def names(self, group: str) -> list[str]:
        """Return the names of a group of symbols.

        Parameters
        ----------
        group : str
            ``q``, ``v``, ``a``, ``lambda``, ``u``, ``du`` or ``ddu``.

        Returns
        -------
        list of str
        """
        return [symbol.name for symbol in self._groups[group]]

    def at(self, point: Mapping[str, float]) -> dict[str, Matrix]:
        """Evaluate residuals and gradients.

        Parameters
        ----------
        point : mapping of str to float
            Values of all names.

        Returns
        -------
        dict of str to ndarray

        Raises
        ------
        IrregularPoint
            One of them has no real value around the point.
        """
        values = {sp.Symbol(name, real=True): mp.mpf(x) for name, x in point.items()}
        try:
            return self._arranged(self._steps.real_at(values))
        except IrregularPoint:
            return self._arranged(self._limits(values))

    def _limits(self, values: Mapping[sp.Symbol, mp.mpf]) -> Vector:
        """Return values that random points nearby have in common, nan if they differ."""
        random, moved = np.random.default_rng(0), (*self._groups["q"], *self._groups["v"])
        with mp.workdps(NEARBY_DIGITS):
            points = [
                {**values, **{name: values[name] + NEARBY * x for name, x in zip(moved, way, strict=True)}}
                for way in random.normal(size=(SHAKES, len(moved)))
            ]
            near = np.array([self._steps.real_at(each) for each in points], dtype=float)
        apart = np.ptp(near, axis=0) > 10.0**-DIGITS * np.max(np.abs(near), axis=0) + float(NEARBY) ** 0.5
        return np.where(apart, np.nan, near[0])

    def quickly_at(self, point: Mapping[str, float]) -> dict[str, Matrix]:
        """Evaluate residuals and gradients in double precision.

        Parameters
        ----------
        point : mapping of str to float
            Values of all names.

        Returns
        -------
        dict of str to ndarray
        """
        names, function = self._function
        found = np.array(function(*(point[name] for name in names)), dtype=float)
        return self._arranged(found) if np.isfinite(found).all() else self.at(point)

    @cached_property
    def _function(self) -> tuple[list[str], Callable[..., list[float]]]:
        symbols = sorted(set().union(*(each.free_symbols for each in self._smooth)), key=str)
        return list(map(str, symbols)), sp.lambdify(symbols, self._smooth, "scipy", cse=True)

    @property
    def switches(self) -> bool:
        """True if signs change the equations or the laws."""
        laws = self.motion.scene.control_law.trees.values()
        return any(each.has(*SWITCHING) for each in self._smooth) or any(is_switched(law, SIGNED) for law in laws)

    def _arranged(self, numbers: Sequence[Any]) -> dict[str, Matrix]:
        ends = np.cumsum(list(self._shapes.values()))[:-1]
        found = dict(zip(self._shapes, np.split(np.array(numbers, dtype=float), ends), strict=True))
        for row, expressions in self._rows.items():
            for group, symbols in self._groups.items():
                name = f"{row}_by_{group}"
                found[name] = found[name].reshape(len(expressions), len(symbols))
        n, more = len(self._system.coordinates), len(self.coordinates) - len(self._system.coordinates)
        for name in ("mass", "mass_rate"):
            found[name] = np.pad(found[name].reshape(n, n), (0, more))
        return found

    def prescribed(self, t: float) -> dict[str, float]:
        """Return the prescribed reactions at a time.

        Parameters
        ----------
        t : float
            Time, in the scene's unit.

        Returns
        -------
        dict of str to float
        """
        found = self.motion.reactions.at(Taylor(0), mp.mpf(t), self.motion.parameters())
        return {name: float(row[0]) for name, row in found.items()}

    @cached_property
    def span(self) -> float:
        """Length of the time span, one without it."""
        given = self.motion.scene.span_trees
        first, last = (float(self.motion.number_of(each)) for each in given or (0, 1))
        return last - first or 1.0

    def scales(self, points: Sequence[Mapping[str, float]]) -> dict[str, Vector]:
        """Return sizes of the quantities of each group, by some points.

        A coordinate is as large as at one of the points or initially, or as its velocity takes it in the time span. If
        it is zero or rounding there, it is as large as the largest. Multipliers are as large as the largest. Controls
        are as large as their derivatives make them.

        Parameters
        ----------
        points : sequence of mapping of str to float
            Values of names.

        Returns
        -------
        dict of str to ndarray
            Sizes of q, v, a, lambda, u, du and ddu, in their order.
        """
        span = self.span
        initial = {name: float(self.motion.number_of(x)) for name, x in self.motion.scene.initial_state.trees.items()}

        def largest(name: str) -> float:
            return max((abs(point[name]) for point in (*points, initial) if name in point), default=0.0)

        found = {group: np.array([largest(name) for name in self.names(group)]) for group in self._groups}
        q = np.where(found["q"] > 0, found["q"], span * found["v"])
        largest_q = q.max(initial=0.0) or 1.0
        q = np.where(q > ROUNDED_PLACE * largest_q, q, largest_q)
        u = found["u"] + span * found["du"] + span**2 * found["ddu"]
        reactions = np.full(len(found["lambda"]), found["lambda"].max(initial=0.0))
        return {
            "q": q, "v": q / span, "a": q / span**2, "lambda": reactions, "u": u, "du": u / span, "ddu": u / span**2
        }  # fmt: skip

    def law(self, t: float) -> dict[str, float]:
        """Return the controls with a law and their derivatives at a time.

        Parameters
        ----------
        t : float
            Time, in the scene's unit.

        Returns
        -------
        dict of str to float
        """
        found = self.motion.law.at(Taylor(2), mp.mpf(t), self.motion.parameters())
        histories = {name: [*map(float, row), 0.0, 0.0][:3] for name, row in found.items()}
        named = {name: (name, f"dot({name})", f"ddot({name})") for name in histories}
        scaled = {name: (u, du, 2 * half) for name, (u, du, half) in histories.items()}
        return {each: x for name in named for each, x in zip(named[name], scaled[name], strict=True)}


def _symbols(names: Iterable[str]) -> tuple[sp.Symbol, ...]:
    return tuple(sp.Symbol(name, real=True) for name in names)


def _between_switchings(expression: sp.Expr) -> sp.Expr:
    return expression.replace(sp.DiracDelta, lambda *_: sp.Integer(0))


def verify(conditions: Iterator[Condition]) -> CheckResult:
    """Return the verdict on conditions: the first that does not hold, if any.

    Parameters
    ----------
    conditions : iterator of Condition

    Returns
    -------
    CheckResult
    """
    unchecked = []
    try:
        for what, difference, size in conditions:
            if difference is None:
                unchecked.append(what)
            elif not np.all(np.abs(difference) <= 10.0**-DIGITS * np.maximum(np.abs(size), np.finfo(float).tiny)):
                return CheckResult(Verdict.DISAGREES, DIGITS, 1, f"{what} does not hold")
    except IrregularPoint:
        return CheckResult(Verdict.UNDECIDED, None, None, "an expression has no real value there")
    if unchecked:
        return CheckResult(Verdict.UNDECIDED, None, None, f"not checked: {', '.join(unchecked)}")
    return CheckResult(Verdict.AGREES, DIGITS, 1)


# ---- a linear system -------------------------------------------------------------------------------------------------


def conditions_on_linearization(equations: DescribedEquations, content: Mapping[str, Any]) -> Iterator[Condition]:
    """Yield the conditions on a document of `linearize`.

    Parameters
    ----------
    equations : DescribedEquations
        The reference.
    content : mapping
        The document.

    Yields
    ------
    Condition
    """
    yield from conditions_on_rates(equations, content, equations.scales([content["point"]]))
    n, s = len(content["coordinates"]), len(content["A"])
    shapes = {"mass": (n, n), "eigenvalues": (s, 2), "modes": (n, s, 2), "frequencies": (s,), "damping": (s,)}
    yield from conditions_on_shapes(content, shapes)
    here = equations.at(content["point"])
    yield from _conditions_on_rest(equations, content, here)
    N, mass = np.array(content["basis"]).reshape(len(content["coordinates"]), -1), here["mass"]
    yield Condition("mass", np.array(content["mass"]) - mass, _sizes(mass, mass))
    yield from _conditions_on_modes(content, N, mass)
    yield from _conditions_on_ranks(content)


def conditions_on_shapes(content: Mapping[str, Any], shapes: Mapping[str, tuple[int, ...]]) -> Iterator[Condition]:
    """Yield the conditions on the sizes of lists in a document.

    Parameters
    ----------
    content : mapping
        The document.
    shapes : mapping of str to tuple of int
        Shape of each list, by its name, or by two names with a point between them.

    Yields
    ------
    Condition
    """
    for name, shape in shapes.items():
        group, _, entry = name.partition(".")
        part = content[group][entry] if entry else content[group]
        yield Condition(f"shape of {name}", not _has_shape(part, *shape))


def _has_shape(part: Any, length: int, *lengths: int) -> bool:
    return len(part) == length and all(_has_shape(each, *lengths) for each in part if lengths)


def conditions_on_rates(
    equations: DescribedEquations, content: Mapping[str, Any], scales: Mapping[str, Vector]
) -> Iterator[Condition]:
    """Yield the conditions on a linear system: state, basis and matrices.

    Parameters
    ----------
    equations : DescribedEquations
        The reference.
    content : mapping
        Entries of a document of `linearize`.
    scales : mapping of str to ndarray
        Sizes of the quantities, as `DescribedEquations.scales` returns them.

    Yields
    ------
    Condition
    """
    q, v, a, u = (equations.names(group) for group in ("q", "v", "a", "u"))
    reactions, point, outputs = equations.names("lambda"), content["point"], content["outputs"]
    yield Condition("coordinates", content["coordinates"] != q)
    yield Condition("controls", content["controls"] != u)
    n, m, r, p = len(q), len(content["A"]) // 2, len(u), len(outputs)
    shapes = {"basis": (n, m), "A": (2 * m, 2 * m), "C": (p, 2 * m)}
    shapes |= {f"{name}.{rate}": (rows, r) for name, rows in (("B", 2 * m), ("D", p)) for rate in ("u", "du", "ddu")}
    yield from conditions_on_shapes(content, shapes)
    if "leading" in content:
        yield Condition("leading", len(content["leading"]) != m or not set(q).issuperset(content["leading"]))
        chosen = _matrix(content["basis"], m)[[q.index(name) for name in content["leading"]]]
        yield Condition("leading", np.linalg.matrix_rank(chosen) < m)
    solved = [name for name in outputs if name in reactions]
    yield Condition("outputs", outputs != [*q, *v, *solved, *equations.outputs])
    yield from _conditions_on_point(equations, content)
    given_here, span = equations.at(point), equations.span
    natural = {group: or_one(sizes) for group, sizes in scales.items()}
    here, length = _in_natural_units(given_here, natural, span)
    mass, N = here["mass"], _matrix(content["basis"], m) * length / natural["q"][:, None]
    rates, rows = (np.hstack([_matrix(content[a], 2 * m), *_parts(content, b)]) for a, b in ("AB", "CD"))
    units = np.concatenate([np.repeat([length, length / span], m), *(natural[each] for each in ("u", "du", "ddu"))])
    rates = rates * units / np.repeat([length / span, length / span**2], m)[:, None]
    pushes = natural["lambda"][[reactions.index(name) for name in solved]]
    rows = rows * units / np.concatenate([natural["q"], natural["v"], pushes, np.ones(len(equations.outputs))])[:, None]
    width = rows.shape[1]
    Q, V = rows[:n], rows[n : 2 * n]
    solution = np.zeros((len(reactions), width))
    solution[[reactions.index(name) for name in solved]] = rows[2 * n :][: len(solved)]
    inputs = np.eye(width)[2 * m :].reshape(3, len(u), width)
    identity = np.eye(2 * m, width)
    xi, eta = identity[:m], identity[m:]
    yield Condition("N^T mass N = 1", N.T @ mass @ N - np.eye(m))
    yield Condition("basis", Q[:, :m] - N, np.abs(N))
    for name, rows_of, state in (("coordinates", Q, xi), ("velocities", V, eta)):
        size = np.abs(state) + _product_sizes(N.T @ mass, rows_of)
        yield Condition(f"tangent coordinates of {name}", N.T @ mass @ rows_of - state, size)
    known = {"q": Q, "v": V, "lambda": solution, **dict(zip(("u", "du", "ddu"), inputs, strict=True))}
    for row in ("constraint", "rate"):
        yield Condition(f"deviation of each {row}", *_deviation(here, row, known))
    forces = np.vstack([here["equation_by_a"], here["acceleration_by_a"]])
    others = [_deviation(here, row, known) for row in ("equation", "acceleration")]
    missed, size = (np.vstack(each) for each in zip(*others, strict=True))
    accelerations = _least(forces, -missed, size)
    size = size + _product_sizes(forces, accelerations)
    yield Condition("equations of motion of deviations", forces @ accelerations + missed, size)
    mass_rate = here["mass_rate"]
    turning = np.vstack([-here["rate_by_q"] @ N, -N.T @ mass_rate @ N / 2])
    moving = _least(np.vstack([here["constraint_by_q"], N.T @ mass]), turning)
    both = [(moving.T @ mass + N.T @ mass_rate), N.T @ mass]
    for name, first, second, given in (("xi", Q, V, rates[:m]), ("eta", V, accelerations, rates[m:])):
        size = _product_sizes(both[0], first) + _product_sizes(both[1], second)
        yield Condition(
            f"derivatives of {name} in A and B", both[0] @ first + both[1] @ second - given, size + np.abs(given)
        )
    if equations.outputs:
        known |= {"a": accelerations}
        own, size = _deviation(here, "output", known)
        errors = _in_natural_units(_rounding_errors(equations, point, given_here), natural, span)[0]
        _, rounding = _deviation(errors, "output", known)
        constant = ~np.hstack([here[f"output_by_{group}"] for group in known]).any(axis=1)
        rounding[constant] += LARGER * np.finfo(float).eps * np.max(np.abs(rows))
        given = rows[2 * n + len(solved) :]
        size = size + np.abs(given) + 10.0**DIGITS * rounding  # terms that cancel leave rounding errors
        yield Condition("outputs of the scene in C and D", own - given, size)


def _in_natural_units(
    here: Mapping[str, Matrix], natural: Mapping[str, Vector], span: float
) -> tuple[dict[str, Matrix], float]:
    """Return gradients and masses where all quantities and the time span are one.

    Also return the unit of xi, the length in the mass metric of what moves most.
    """
    orders = {"rate": 1, "acceleration": 2}
    found = {
        name: matrix * natural[group] * span ** orders.get(row, 0)
        for name, matrix in here.items()
        for row, by, group in [name.partition("_by_")]
        if by
    }
    metric = np.outer(natural["q"], natural["q"])
    length = float(np.sqrt(np.max(np.abs(metric * here["mass"]), initial=0.0))) or 1.0
    found["mass"] = metric * here["mass"] / length**2
    found["mass_rate"] = metric * here["mass_rate"] * span / length**2
    return found, length


def _conditions_on_rest(
    equations: DescribedEquations, content: Mapping[str, Any], here: Mapping[str, Matrix]
) -> Iterator[Condition]:
    point, scales = content["point"], equations.scales([content["point"]])
    forces = sum(np.abs(here[f"equation_by_{group}"]) @ scales[group] for group in ("q", "lambda"))
    inertia = np.abs(here["equation_by_a"])
    moved = np.max(forces[:, None] / np.where(inertia, inertia, np.inf), axis=0, initial=0.0)
    scales["a"] = np.maximum(scales["a"], moved)
    moving = [
        abs(point[name]) / size
        for group in ("v", "a", "du", "ddu")
        for name, size in zip(equations.names(group), or_one(scales[group]), strict=True)
    ]
    changing = max((*moving, float(equations.changes_with_time)))
    yield Condition("rest", changing if content["at_rest"] else not changing)


def _conditions_on_point(equations: DescribedEquations, content: Mapping[str, Any]) -> Iterator[Condition]:
    point, scene = content["point"], equations.motion.scene
    groups = ("q", "v", "a", "lambda", "u", "du", "ddu")
    names = [name for group in groups for name in equations.names(group)]
    yield Condition("names of the point", set(point) != {"t", *names})
    law = equations.law(point["t"]) if content["at"] is not None else {}
    scales = equations.scales([point, law])
    sizes = {name: size for group in groups for name, size in zip(equations.names(group), scales[group], strict=True)}
    if content["at"] is not None:
        yield Condition("time", content["at"] != point["t"])
        yield from (Condition(f"law of {name}", point[name] - x, sizes[name]) for name, x in law.items())
        if content["at"] == float(equations.motion.first_time):
            for name, value in scene.initial_state.trees.items():
                x = float(equations.motion.number_of(value))
                size = abs(x) + sizes.get(name, 0.0)
                yield Condition(f"initial value of {name}", point.get(name, x) - x, size)
    for name, x in equations.prescribed(point["t"]).items():
        yield Condition(f"prescribed {name}", point[name] - x, abs(x) + sizes[name])
    here = equations.at(point)
    for row in ("constraint", "rate", "acceleration", "equation"):
        size = sum(
            np.abs(here[f"{row}_by_{group}"]) @ (scales[group] + [abs(point[name]) for name in equations.names(group)])
            for group in groups
        )
        yield Condition(f"each {row} at the point", here[row], size)


def _conditions_on_modes(content: Mapping[str, Any], N: Matrix, mass: Matrix) -> Iterator[Condition]:
    A, m = _matrix(content["A"], 2 * N.shape[1]), N.shape[1]
    values, modes = (_complex(content[name]) for name in ("eigenvalues", "modes"))
    size = np.linalg.norm(A, 2) if m else 1.0
    powers = np.eye(2 * m)
    for k in range(1, 2 * m + 1):
        powers = powers @ (A / (size or 1.0))
        total = np.sum((values / (size or 1.0)) ** k)
        yield Condition(f"sum of the eigenvalues to the power {k}", np.trace(powers) - total, 2 * m)
    yield from _conditions_on_eigenvalues("", A, values)
    for value, mode in zip(values, modes.T, strict=True):
        xi = N.T @ mass @ mode
        yield Condition("modes are tangent", N @ xi - mode, 1 + np.abs(N) @ np.abs(xi))
        x = np.concatenate([xi, np.linalg.lstsq(A[:m, m:], value * xi - A[:m, :m] @ xi, rcond=None)[0]])
        yield Condition("mode of an eigenvalue", A @ x - value * x, (size or 1.0) * np.linalg.norm(x))
        yield Condition("largest entry of a mode", np.max(np.abs(mode), initial=0.0) - 1 if xi.any() else 0.0)
    yield Condition("frequencies", np.abs(values) / (2 * np.pi) - content["frequencies"], np.abs(values))
    damped = np.where(values, -values.real / np.where(values, np.abs(values), 1), 0)
    yield Condition(
        "damping", damped - content["damping"], np.abs(damped) + LARGER * np.finfo(float).eps * 10.0**DIGITS
    )


def _conditions_on_eigenvalues(place: str, A: Matrix, given: Vector, least: float = 0.0) -> Iterator[Condition]:
    """Compare eigenvalues, to rounding errors of A.

    An eigenvalue moves by its condition times the error of A, but a multiple one by no more than half the digits.
    """
    if not A.size:
        return
    truth, left, right = scipy.linalg.eig(A, left=True, right=True)
    with np.errstate(divide="ignore"):
        conditions = 1 / np.abs(np.einsum("ij,ij->j", left.conj(), right))
    size = max(np.max(np.abs(truth)), least)
    missing = list(given)
    for value, condition in zip(truth, conditions, strict=True):
        nearest = min(missing, key=lambda z, value=value: abs(z - value))
        missing.remove(nearest)
        moved = abs(value) + 10.0**DIGITS * LARGER * np.finfo(float).eps * condition * np.linalg.norm(A, 2)
        yield Condition(f"{place}eigenvalue", nearest - value, max(min(moved, size * 10.0 ** (DIGITS // 2)), least))


def _conditions_on_ranks(content: Mapping[str, Any]) -> Iterator[Condition]:
    A, C = (_matrix(content[name], len(content["A"])) for name in "AC")
    b_u, b_du, b_ddu = _parts(content, "B")
    for name, matrix, entering in (
        ("controllable", A, b_u + A @ (b_du + A @ b_ddu)),
        ("observable", A.T, C.T),
    ):
        if (rank := content[f"{name}_rank"]) is not None:  # null where rounding leaves it open
            yield Condition(f"{name}_rank", rank != _reached(matrix, entering))


def _reached(A: Matrix, B: Matrix) -> int:
    """Return Kalman's rank, by the invariant functionals that vanish on B."""
    balanced, (scale, _) = scipy.linalg.matrix_balance(A, permute=False, separate=True)
    A, B = balanced / (np.linalg.norm(balanced) or 1.0), B / scale[:, None]
    lengths = np.linalg.norm(B, axis=0)
    B = B / or_one(lengths)
    functionals, outside = np.eye(len(A)), B
    while outside.size:
        _, values, right = np.linalg.svd(outside.T)
        rank = int(np.count_nonzero(values > 10.0 ** -(DIGITS + 1)))
        if not rank:
            break
        functionals = right[rank:] @ functionals
        moved = functionals @ A
        outside = moved - moved @ functionals.T @ functionals
    return len(A) - len(functionals)


def _parts(content: Mapping[str, Any], name: str) -> list[Matrix]:
    return [_matrix(content[name][rate], len(content["controls"])) for rate in ("u", "du", "ddu")]


def _matrix(rows: Sequence[Sequence[float]], columns: int) -> Matrix:
    return np.array(rows, dtype=float).reshape(len(rows), columns)


def _complex(pairs: Any) -> Matrix:
    numbers = np.array(pairs, dtype=float)
    return numbers[..., 0] + 1j * numbers[..., 1] if numbers.size else np.zeros(numbers.shape)


def _deviation(here: Mapping[str, Matrix], row: str, known: Mapping[str, Matrix]) -> tuple[Matrix, Matrix]:
    """Return the deviation of expressions, with the sizes of terms."""
    terms = [(here[f"{row}_by_{group}"], each) for group, each in known.items()]
    return sum(a @ b for a, b in terms), sum(_product_sizes(a, b) for a, b in terms)


def _rounding_errors(
    equations: DescribedEquations, point: Mapping[str, float], here: Mapping[str, Matrix]
) -> Mapping[str, Matrix]:
    """Return bounds of the rounding errors in matrices.

    They follow from their changes with the last digits of values.
    """
    random = np.random.default_rng(0)
    changes = SHAKEN * random.uniform(-1.0, 1.0, size=(SHAKES, len(point)))
    beside = [equations.at({k: x + x * by for (k, x), by in zip(point.items(), row, strict=True)}) for row in changes]
    return {name: LARGER * np.max([np.abs(each[name] - here[name]) for each in beside], axis=0) for name in here}


def _product_sizes(a: Matrix, b: Matrix) -> Matrix:
    """Return sizes of the terms of a product. Zeros may be rounding errors."""
    a, b = np.abs(a), np.abs(b)
    return a @ b + ROUNDED * a.sum(axis=1)[:, None] * b.max(initial=0.0)


def _least(matrix: Matrix, right: Matrix, sizes: Matrix | float = 0.0) -> Matrix:
    """Solve by least squares, each row relative to the sizes of its terms."""
    found = _of_least_squares(matrix, right, np.linalg.norm(matrix, axis=1))
    return _of_least_squares(matrix, right, np.max(_product_sizes(matrix, found) + sizes, axis=1, initial=0.0))


def _of_least_squares(matrix: Matrix, right: Matrix, sizes: Vector) -> Matrix:
    rows = or_one(sizes)[:, None]
    return np.linalg.lstsq(matrix / rows, right / rows, rcond=None)[0]


def _sizes(*matrices: Matrix) -> Vector:
    return sum(np.abs(each).max(initial=0.0) for each in matrices)


# ---- states at rest --------------------------------------------------------------------------------------------------


def conditions_on_equilibria(equations: DescribedEquations, content: Mapping[str, Any]) -> Iterator[Condition]:
    """Yield the conditions on a document of `equilibria`.

    Parameters
    ----------
    equations : DescribedEquations
        The reference.
    content : mapping
        The document.

    Yields
    ------
    Condition
    """
    q, v, a, reactions = (equations.names(group) for group in ("q", "v", "a", "lambda"))
    controls, found = content["controls"], content["found"]
    rates = [name for group in ("du", "ddu") for name in equations.names(group)]
    at_rest = {"t": float(equations.motion.first_time), **dict.fromkeys((*v, *a, *rates), 0.0), **controls}
    yield Condition("controls", list(controls) != equations.names("u"))
    counted = content["regular"] and len(found) == content["count"] and all(_of(found, "isolated"))
    yield Condition("complete", content["complete"] != counted)
    yield Condition("names", _of(found, "name") != [f"e{k}" for k in range(1, len(found) + 1)])
    yield from _conditions_on_turns(equations, content, at_rest)
    rational = content["rational"]
    wrong = any(u not in controls or float(Fraction(x)) != controls[u] for u, x in rational.items())
    yield Condition("rational controls", wrong or (rational.keys() != controls.keys() and any(_of(found, "exact"))))
    equations_at_rest = equations.at_rest(controls | rational)
    yield from _conditions_on_orientations(equations, content, at_rest)
    if content["count"] is not None and len(equations.orientations) > MOST_ORIENTATIONS:
        yield Condition("number of solutions", None)
    elif content["count"] is not None:
        # a positive polynomial is the square of two numbers
        roots = [sp.Dummy(real=True) for _ in equations.orientations]
        signs = equations.orientation({**at_rest, **found[0]["coordinates"]}) if found else [1] * len(roots)
        oriented = [root**2 - sign * g for root, g, sign in zip(roots, equations.orientations, signs, strict=True)]
        conditions, unknowns = [*equations_at_rest, *oriented], [*_symbols(q), *roots]
        reacting = [reactions[beta] for beta in equations.reacting]
        count = count_real_solutions(conditions, [*unknowns, *_symbols(reacting)])
        if count is None:  # of dependent constraints, some multipliers are chosen as zero
            used = [name for name in reacting if any(each["multipliers"][name] for each in found)]
            none = dict.fromkeys(_symbols(name for name in reacting if name not in used), 0)
            count = count_real_solutions([each.subs(none) for each in conditions], [*unknowns, *_symbols(used)])
        listed = content["count"] << len(content["reversals"]) + len(roots)
        yield Condition("number of solutions", None if count is None else count - listed)
    known: list[Vector] = []
    scales = equations.scales([{**each["coordinates"], **each["multipliers"]} for each in found])
    sizes = dict(zip([*q, *reactions], np.concatenate([scales["q"], scales["lambda"]]), strict=True))
    for each in found:
        place = f"{each['name']}: "
        yield Condition(f"{place}names", [*each["coordinates"]] != q or [*each["multipliers"]] != reactions)
        position = np.array(list(each["coordinates"].values()))
        turning = np.isin(q, content["turns"])
        for other in known:
            apart = position - other
            apart[turning] -= 2 * np.pi * np.round(apart[turning] / (2 * np.pi))
            for e in content["reversals"]:
                if position[np.isin(q, e)] @ other[np.isin(q, e)] < 0:
                    apart = np.where(np.isin(q, e), position + other, apart)
            same = np.all(np.abs(apart) <= 10.0**-DIGITS * scales["q"])
            yield Condition(f"{place}another equilibrium", bool(same))
        known.append(position)
        point = {**at_rest, **each["coordinates"], **each["multipliers"]}
        here = equations.at(point)
        forces = sum(np.abs(here[f"equation_by_{group}"]) @ scales[group] for group in ("q", "lambda"))
        lengths = np.abs(here["constraint_by_q"]) @ scales["q"]
        yield Condition(f"{place}balance of forces", here["equation"], forces)
        yield Condition(f"{place}constraints", here["constraint"], lengths)
        yield from _conditions_on_stability(place, equations, here, point, each)
        terms = np.concatenate([forces, lengths])
        yield from _conditions_on_exact_values(place, equations_at_rest, each, sizes, terms)


def _conditions_on_orientations(
    equations: DescribedEquations, content: Mapping[str, Any], at_rest: Mapping[str, float]
) -> Iterator[Condition]:
    """Compare signs at the places found, and those that the initial state decides."""
    yield Condition("number of orientations", content.get("orientations", 0) != len(equations.orientations))
    scene = equations.motion.scene
    first = equations.orientation({**at_rest, **scene.initial_state})
    for each in content["found"]:
        here = equations.orientation({**at_rest, **each["coordinates"]})
        wrong = any(one not in (None, other) for one, other in zip(first, here, strict=True))
        yield Condition(f"{each['name']}: orientations", wrong)
        first = here


def _conditions_on_exact_values(
    place: str,
    equations_at_rest: Sequence[sp.Expr],
    each: Mapping[str, Any],
    sizes: Mapping[str, float],
    terms: Vector,
) -> Iterator[Condition]:
    """Put the exact values into the equations, to many digits.

    The sizes are those of the values and of the terms of the equations.
    """
    given = {**each["coordinates"], **each["multipliers"]}
    exact = {name: read_exact(text) for name, text in each["exact"].items()}
    yield Condition(f"{place}names of exact values", not given.keys() >= exact.keys())
    for name, value in exact.items():
        number = complex("nan") if value is None else complex(value.evalf())
        yield Condition(f"{place}exact value of {name}", number - given[name], sizes[name] + abs(given[name]))
    if exact and all(value in exact or not given[value] for value in given):
        with mp.workdps(EXACT_DIGITS):
            numbers = {name: mp.mpf(str(sp.re(value.evalf(EXACT_DIGITS)))) for name, value in exact.items()}
            values = {sp.Symbol(name, real=True): numbers.get(name, mp.zero) for name in given}
            left = Steps(equations_at_rest).real_at(values)
        size = 10.0 ** (2 * DIGITS - EXACT_DIGITS) * terms
        yield Condition(f"{place}equations of exact values", np.array(left, dtype=float), size)


def _conditions_on_turns(
    equations: DescribedEquations, content: Mapping[str, Any], at_rest: Mapping[str, float]
) -> Iterator[Condition]:
    q, reactions = (equations.names(group) for group in ("q", "lambda"))
    drawn = np.random.default_rng(1).normal(size=len(q) + len(reactions))
    point = {**at_rest, **dict(zip((*q, *reactions), map(float, drawn), strict=True))}
    for e in content["reversals"]:
        signs = np.where(np.isin(q, e), -1.0, 1.0)
        here, there = (equations.at({**point, **{name: sign * point[name] for name in e}}) for sign in (1.0, -1.0))
        yield Condition(f"signs of {e}", signs * there["equation"] - here["equation"], 1 + np.abs(here["equation"]))
        yield Condition(f"signs of {e}", there["constraint"] - here["constraint"], 1 + np.abs(here["constraint"]))
        inertia = here["equation_by_a"] @ np.where(signs < 0, [point[name] for name in q], 0.0)
        yield Condition(f"inertia along {e}", inertia, 1 + np.abs(here["equation_by_a"]).max())
    for name in content["turns"]:
        here, there = (equations.at({**point, name: point[name] + turn}) for turn in (0.0, 2 * np.pi))
        for row in ("equation", "constraint"):
            yield Condition(f"turn of {name}", there[row] - here[row], 1 + np.abs(here[row]))


def _conditions_on_stability(
    place: str,
    equations: DescribedEquations,
    here: Mapping[str, Matrix],
    point: Mapping[str, float],
    each: Mapping[str, Any],
) -> Iterator[Condition]:
    n = len(here["equation"])
    J, pushing = here["constraint_by_q"], here["equation_by_lambda"][:, equations.reacting]
    N = scipy.linalg.null_space(J, rcond=10.0**-DIGITS)
    W = scipy.linalg.null_space(pushing.T, rcond=10.0**-DIGITS) if pushing.size else np.eye(n)
    yield Condition(f"{place}number of eigenvalues", len(each["eigenvalues"]) != 2 * N.shape[1])
    M, D, K = (W.T @ here[f"equation_by_{group}"] @ N for group in ("a", "v", "q"))
    m = len(K)
    one, none = np.eye(m), np.zeros((m, m))
    A = np.block([[none, one], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
    truth = np.linalg.eigvals(A)
    size = np.max(np.abs(truth), initial=0.0)
    least = 0.0 if each["isolated"] else 1.0  # all may be rounding errors
    yield from _conditions_on_eigenvalues(place, A, _complex(each["eigenvalues"]), least)
    size = max(size, least)
    stiff, rounding = np.linalg.svd(K, compute_uv=False), _rounding_of_stiffness(equations, here, point, N)
    if each["isolated"]:
        yield Condition(f"{place}isolated", bool(m and stiff[-1] <= max(10.0**-DIGITS * stiff[0], rounding)))
    parts, clear = truth.real, 10.0**-DIGITS * size
    match each["stability"]:
        case "asymptotically stable":
            yield Condition(f"{place}asymptotic stability", bool(np.any(parts >= -clear)))
        case "unstable":
            yield Condition(f"{place}instability", not np.any(parts > clear))
        case "stable":
            symmetric = N.T @ here["equation_by_q"] @ N if len(N) == n else K
            positive = m == 0 or np.linalg.eigvalsh((symmetric + symmetric.T) / 2)[0] > rounding
            minimum = positive and equations.energy_change != "open"
            yield Condition(f"{place}stability", not (minimum or _swings(equations, truth, clear)))


def _swings(equations: DescribedEquations, eigenvalues: Vector, clear: float) -> bool:
    """Return True if a linear conservative system has simple imaginary eigenvalues."""
    apart = np.abs(eigenvalues[:, None] - eigenvalues) + np.diag(np.full(len(eigenvalues), np.inf))
    simple = bool(np.all(apart > 2 * clear) and np.all(np.abs(eigenvalues.real) <= clear))
    return simple and equations.energy_change == "conserved" and equations.linear


def _rounding_of_stiffness(
    equations: DescribedEquations, here: Mapping[str, Matrix], point: Mapping[str, float], N: Matrix
) -> float:
    """Return the stiffness that rounding errors of the forces make by the multipliers."""
    reactions = equations.names("lambda")
    loads = equations.at({**point, **dict.fromkeys(reactions, 0.0)})["equation"]
    error = 0.0
    for name, slope in zip(reactions, here["equation_by_lambda"].T, strict=True):
        change = equations.at({**point, name: point[name] + 1.0})["equation_by_q"] - here["equation_by_q"]
        step = np.finfo(float).eps * np.linalg.norm(loads) / (np.linalg.norm(slope) or 1.0)
        error += step * np.linalg.norm(N.T @ change @ N)
    return float(error)


def _of(found: Sequence[Mapping[str, Any]], key: str) -> list[Any]:
    return [each[key] for each in found]
