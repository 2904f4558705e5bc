"""Verdicts on documents of `linearize-along`.

At each time, the matrices have to be those of a linear system about the state there (`linearized`). Between the times,
the equations of motion are integrated with their variational equations, dq and dv in all coordinates, by SciPy. The
motion has to go through the states, and the deviations of the first time have to become C Phi.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import scipy.linalg
from scipy.integrate import solve_ivp

from ..simulation.constraints.directions import or_one
from ..simulation.matrices import Matrix, Vector
from .linearized import DIGITS, Condition, DescribedEquations, conditions_on_rates, conditions_on_shapes

TOLERANCE = 1e-11  # of a step of SciPy
NEGLIGIBLE = 1e-6  # of the largest displacement in the mass metric
AT_EACH_TIME = "basis", "A", "C"
RATES = "B", "D"


def conditions_on_linearized_motion(equations: DescribedEquations, content: Mapping[str, Any]) -> Iterator[Condition]:
    """Yield the conditions on a document of `linearize-along`.

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
    times, points, count = content["times"], content["points"], len(content["times"])
    lists = [*(content[name] for name in AT_EACH_TIME), points, content["transition"]]
    lists += [each for name in RATES for each in content[name].values()]
    yield Condition("number of times", not count or any(len(each) != count for each in lists))
    yield Condition("order of the times", any(b <= a for a, b in pairwise(times)))
    names = {name: content[name] for name in ("coordinates", "controls", "outputs")}
    scales = equations.scales(points)
    for k, (t, point) in enumerate(zip(times, points, strict=True)):
        here = {name: content[name][k] for name in AT_EACH_TIME}
        here |= {name: {rate: each[k] for rate, each in content[name].items()} for name in RATES}
        here |= {"at": t, "point": point}
        yield from conditions_on_rates(equations, names | here, scales)
    size = len(content["A"][0])
    yield from conditions_on_shapes(content, {"transition": (count, size, size)})
    C = np.array(content["C"]).reshape(count, len(content["outputs"]), size)
    transition = np.array(content["transition"]).reshape(count, size, size)
    deviations = C @ transition
    motion = _Motion(equations, points, scales)
    if equations.switches or not motion.is_determined:
        if size:
            yield Condition("transition", None)
    else:
        yield Condition("transition at the first time", transition[0] - np.eye(size))
        states = np.array([[point[name] for name in (*q, *v)] for point in points]) / motion.units
        moved = deviations[:, : 2 * len(q)] / motion.units[:, None]
        moved = moved / or_one(np.linalg.norm(moved[0], axis=0))
        state, followed = states[0], moved[0]
        for k, span in enumerate(pairwise(times), start=1):
            state, followed = motion.followed(span, state, followed)
            size = 1 + np.max(np.abs(states[k]), initial=0.0)
            yield Condition(f"state at t = {span[1]:g}", state - states[k], size)
            size = 1 + np.linalg.norm(followed) + np.linalg.norm(moved[k])
            yield Condition(f"transition at t = {span[1]:g}", followed - moved[k], size)
    if content["floquet"] is not None:
        yield from _conditions_on_period(equations, content, motion.units)
    if content["free"] is not None:
        rows = [content["outputs"].index(name) for name in reactions if name in content["outputs"]]
        yield from _conditions_on_free_deviations(content["free"], deviations[:, rows], C[:, rows], motion.response)


class _Motion:
    """The motion of a described scene and its deviations, in units of their sizes."""

    def __init__(
        self, equations: DescribedEquations, points: Sequence[Mapping[str, float]], scales: Mapping[str, Vector]
    ) -> None:
        self._equations = equations
        self._n = len(equations.names("q"))
        solved = range(len(equations.multipliers), len(equations.names("lambda")))
        self._unknown = [*equations.reacting, *solved]
        here = [equations.quickly_at(point) for point in points]
        masses = np.sqrt(np.abs(here[0]["mass"].diagonal()))
        reached = np.max([[abs(point[name]) for name in equations.names("v")] for point in points], axis=0)
        q, v, a = (or_one(scales[group]) for group in "qva")
        self.units = np.concatenate([_not_negligible(each, masses) for each in (q, np.maximum(v, reached))])
        inertia = max(np.max(np.abs(each["equation_by_a"] * a), initial=0.0) for each in here)
        pushes = np.max([np.abs(each["equation_by_lambda"]).max(axis=0, initial=0.0) for each in here], axis=0)
        reactions = inertia / or_one(pushes)
        self._columns = np.concatenate([a, reactions[self._unknown]])
        length, span = np.max(q * masses, initial=0.0) or 1.0, equations.span
        self.response = np.max(reactions, initial=0.0) / length * max(1.0, span)
        open_directions = scipy.linalg.null_space(self._matrix(here[0])[0])
        self.is_determined = bool(np.linalg.norm(open_directions[: self._n]) < 10.0**-DIGITS)

    def followed(self, span: tuple[float, float], state: Vector, moved: Matrix) -> tuple[Vector, Matrix]:
        """Return the state and its deviations at the end of a time span."""
        start = np.concatenate([state, moved.ravel()])
        end = solve_ivp(self._rates, span, start, "DOP853", rtol=TOLERANCE, atol=TOLERANCE).y[:, -1]
        return end[: len(state)], end[len(state) :].reshape(moved.shape)

    def _rates(self, t: float, values: Vector) -> Vector:
        n, equations, units = self._n, self._equations, self.units[:, None]
        state, moved = values[: 2 * n] * self.units, values[2 * n :].reshape(2 * n, -1) * units
        reactions = equations.names("lambda")
        unknown = [*equations.names("a"), *(reactions[beta] for beta in self._unknown)]
        point = {
            "t": t,
            **equations.law(t),
            **equations.prescribed(t),
            **dict(zip((*equations.names("q"), *equations.names("v")), state, strict=True)),
        }
        here = equations.quickly_at({**point, **dict.fromkeys(unknown, 0.0)})
        solved = self._solved(here, here["equation"][:, None], here["acceleration"][:, None])[:, 0]
        here = equations.quickly_at({**point, **dict(zip(unknown, solved, strict=True))})
        q, v = moved[:n], moved[n:]
        missed = (here[f"{row}_by_q"] @ q + here[f"{row}_by_v"] @ v for row in ("equation", "acceleration"))
        change = np.concatenate([v, self._solved(here, *missed)[:n]]) / units
        return np.concatenate([state[n:] / self.units[:n], solved[:n] / self.units[n:], change.ravel()])

    def _solved(self, here: Mapping[str, Matrix], equation: Matrix, acceleration: Matrix) -> Matrix:
        matrix, rows = self._matrix(here)
        found = np.linalg.lstsq(matrix, -np.vstack([equation, acceleration]) / rows, rcond=None)[0]
        return self._columns[:, None] * found

    def _matrix(self, here: Mapping[str, Matrix]) -> tuple[Matrix, Matrix]:
        """Return the matrix for unknowns of size one, and sizes of its rows."""
        rows = "equation", "acceleration"
        matrix = np.block([[here[f"{row}_by_a"], here[f"{row}_by_lambda"][:, self._unknown]] for row in rows])
        matrix = matrix * self._columns
        sizes = or_one(np.linalg.norm(matrix, axis=1))[:, None]
        return matrix / sizes, sizes


def _not_negligible(sizes: Vector, masses: Vector) -> Vector:
    """Return sizes of displacements, those that are rounding increased.

    The masses are square roots of those in the kinetic energy, in whose metric small displacements are rounding.
    """
    least = NEGLIGIBLE * np.max(sizes * masses, initial=0.0) / or_one(masses)
    return np.where(masses > 0, np.maximum(sizes, least), sizes)


def _conditions_on_period(
    equations: DescribedEquations, content: Mapping[str, Any], units: Vector
) -> Iterator[Condition]:
    floquet, points = content["floquet"], content["points"]
    first, last = (
        np.array([each[name] for group in "qv" for name in equations.names(group)]) for each in (points[0], points[-1])
    )
    yield Condition("period", floquet["period"] - (content["times"][-1] - content["times"][0]), floquet["period"])
    yield Condition("state after the period", (last - first) / units, 1 + np.max(np.abs(first) / units, initial=0.0))
    bases = [np.array(content["basis"][k]) for k in (0, -1)]
    turned = bases[0].T @ equations.at(points[0])["mass"] @ bases[1]
    monodromy = scipy.linalg.block_diag(turned, turned) @ np.array(content["transition"][-1])
    times = np.repeat([1.0, floquet["period"]], len(turned))
    monodromy = monodromy * times[:, None] / times  # of xi and the period times eta
    values = np.array([complex(*pair) for pair in floquet["multipliers"]])
    yield Condition("number of multipliers", len(values) != len(monodromy))
    size, powers = np.linalg.norm(monodromy, 2) or 1.0, np.eye(len(monodromy))
    for k in range(1, len(monodromy) + 1):
        powers = powers @ monodromy / size
        yield Condition(
            f"sum of the multipliers to the power {k}", np.trace(powers) - np.sum((values / size) ** k), len(powers)
        )
    sizes = np.abs(values)
    yield Condition("order of the multipliers", bool(np.any(np.diff(sizes) > 10.0**-DIGITS * size)))
    match floquet["stability"]:
        case "asymptotically stable":
            yield Condition("asymptotic stability", bool(np.any(sizes >= 1)))
        case "unstable":
            yield Condition("instability", not np.any(sizes > 1))


def _conditions_on_free_deviations(
    free: Mapping[str, Any], responses: Matrix, rows: Matrix, least: float
) -> Iterator[Condition]:
    sizes = np.array([np.linalg.norm(each, 2) for each in responses])
    yield Condition("sizes of the multipliers of deviations", sizes - free["sizes"], least + sizes)
    basis = np.array(free["basis"]).reshape(responses.shape[-1], -1)
    yield Condition("number of deviations that stay free", basis.shape[1] != free["staying"])
    yield Condition("basis of deviations that stay free", basis.T @ basis - np.eye(basis.shape[1]))
    for response, row in zip(responses, rows, strict=True):
        size = least + np.linalg.norm(row) + np.linalg.norm(response)
        yield Condition("deviations that stay free", response @ basis, size)
