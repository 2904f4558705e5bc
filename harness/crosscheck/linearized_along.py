"""Verdicts on documents of `linearize-along`.

At each time, the matrices have to be those of a linear system about the state there (`linearized`). Between the times,
the equations of motion are integrated with their variational equations, dq and dv in all coordinates, by SciPy. The
motion has to go through the states, and the deviations of the first time have to become C Phi.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

import numpy as np
import scipy.linalg
from scipy.integrate import solve_ivp

from ..simulation.matrices import Matrix, Vector
from .linearized import DIGITS, Condition, DescribedEquations, conditions_on_rates, conditions_on_shapes

TOLERANCE = 1e-11  # of a step of SciPy
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
    for k, (t, point) in enumerate(zip(times, points, strict=True)):
        here = {name: content[name][k] for name in AT_EACH_TIME}
        here |= {name: {rate: each[k] for rate, each in content[name].items()} for name in RATES}
        here |= {"at": t, "point": point}
        yield from conditions_on_rates(equations, names | here)
    n = len(q)
    size = len(content["A"][0])
    yield from conditions_on_shapes(content, {"transition": (count, size, size)})
    C = np.array(content["C"]).reshape(count, len(content["outputs"]), size)
    transition = np.array(content["transition"]).reshape(count, size, size)
    deviations = C @ transition
    motion = _Motion(equations)
    if equations.switches or not motion.determines(points[0]):
        if size:
            yield Condition("transition", None)
    else:
        states = np.array([[point[name] for name in (*q, *v)] for point in points])
        state, moved = states[0], deviations[0][: 2 * n]
        yield Condition("transition at the first time", transition[0] - np.eye(transition.shape[-1]))
        for k, span in enumerate(pairwise(times), start=1):
            state, moved = motion.followed(span, state, moved)
            size = 1 + np.max(np.abs(states[k]), initial=0.0)
            yield Condition(f"state at t = {span[1]:g}", state - states[k], size)
            size = np.linalg.norm(moved) + np.linalg.norm(deviations[k][: 2 * n])
            yield Condition(f"transition at t = {span[1]:g}", moved - deviations[k][: 2 * n], 1 + size)
    if content["floquet"] is not None:
        yield from _conditions_on_period(equations, content)
    if content["free"] is not None:
        rows = [content["outputs"].index(name) for name in reactions if name in content["outputs"]]
        yield from _conditions_on_free_deviations(content["free"], deviations[:, rows], C[:, rows])


class _Motion:
    """The motion of a described scene and its deviations, in double precision."""

    def __init__(self, equations: DescribedEquations) -> None:
        self._equations = equations
        self._n = len(equations.names("q"))
        reactions = len(equations.names("lambda"))
        self._unknown = [*equations.reacting, *range(len(equations.multipliers), reactions)]

    def followed(self, span: tuple[float, float], state: Vector, moved: Matrix) -> tuple[Vector, Matrix]:
        """Return the state and its deviations at the end of a time span."""
        start = np.concatenate([state, moved.ravel()])
        end = solve_ivp(self._rates, span, start, "DOP853", rtol=TOLERANCE, atol=TOLERANCE).y[:, -1]
        return end[: len(state)], end[len(state) :].reshape(moved.shape)

    def determines(self, point: Mapping[str, float]) -> bool:
        """Return True if the constraints with second derivatives fix the motion."""
        open_directions = scipy.linalg.null_space(self._matrix(self._equations.at(point)))
        return bool(np.linalg.norm(open_directions[: self._n]) < 10.0**-DIGITS)

    def _rates(self, t: float, values: Vector) -> Vector:
        n, equations = self._n, self._equations
        state, moved = values[: 2 * n], values[2 * n :].reshape(2 * n, -1)
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
        return np.concatenate([state[n:], solved[:n], v.ravel(), self._solved(here, *missed)[:n].ravel()])

    def _solved(self, here: Mapping[str, Matrix], equation: Matrix, acceleration: Matrix) -> Matrix:
        return np.linalg.lstsq(self._matrix(here), -np.vstack([equation, acceleration]), rcond=None)[0]

    def _matrix(self, here: Mapping[str, Matrix]) -> Matrix:
        rows = "equation", "acceleration"
        return np.block([[here[f"{row}_by_a"], here[f"{row}_by_lambda"][:, self._unknown]] for row in rows])


def _conditions_on_period(equations: DescribedEquations, content: Mapping[str, Any]) -> Iterator[Condition]:
    floquet, points = content["floquet"], content["points"]
    first, last = (
        np.array([each[name] for group in "qv" for name in equations.names(group)]) for each in (points[0], points[-1])
    )
    yield Condition("period", floquet["period"] - (content["times"][-1] - content["times"][0]), floquet["period"])
    yield Condition("state after the period", last - first, 1 + np.max(np.abs(first), initial=0.0))
    bases = [np.array(content["basis"][k]) for k in (0, -1)]
    turned = bases[0].T @ equations.at(points[0])["mass"] @ bases[1]
    monodromy = scipy.linalg.block_diag(turned, turned) @ np.array(content["transition"][-1])
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


def _conditions_on_free_deviations(free: Mapping[str, Any], responses: Matrix, rows: Matrix) -> Iterator[Condition]:
    sizes = np.array([np.linalg.norm(each, 2) for each in responses])
    yield Condition("sizes of the multipliers of deviations", sizes - free["sizes"], 1 + sizes)
    basis = np.array(free["basis"]).reshape(responses.shape[-1], -1)
    yield Condition("number of deviations that stay free", basis.shape[1] != free["staying"])
    yield Condition("basis of deviations that stay free", basis.T @ basis - np.eye(basis.shape[1]))
    for response, row in zip(responses, rows, strict=True):
        yield Condition(
            "deviations that stay free", response @ basis, 1 + np.linalg.norm(row) + np.linalg.norm(response)
        )
