"""Linearisation along a whole motion.

The basis N of the tangent space moves along by

    N' = H N,      H = R - N N^T A'/2,      J R = -J',    N^T A R = 0,

for which N^T A N = 1, and turns N as little as the mass metric allows. H depends on the space alone, not on the basis.
The deviations x' = A(t) x have the state-transition matrix Phi(t), x(t) = Phi(t) x(t0). Both equations are linear.
Collocation at nine equidistant nodes of a block solves them, of order ten (Hairer, Norsett & Wanner, Solving Ordinary
Differential Equations I, section II.7). The error is estimated by every second node, of order six, by functions of
the time between them, and by the motion there.

If the motion and its equations have the period T, the eigenvalues of Phi(T) are the characteristic multipliers: the
motion is asymptotically stable if all lie inside the unit circle, and unstable if one lies outside (Floquet; Lyapunov;
Merkin, Introduction to the Theory of Stability, chapter 7). Otherwise its stability is undecided.

Of a free motion, C_lambda Phi are the multipliers of small initial deviations to first order: the variational equation
of the multipliers. Its kernel over all times are the deviations that stay free.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import scipy.linalg
from numpy.polynomial import legendre

from ..failures import ErrorKind, HolonomError
from ..program.differentiation import derivative_name
from ..program.motion_problem import MotionProblem, require_analytic
from ..schema import MATRIX, PAIRS, VECTOR, lists_of
from ..shown import Shown
from ..simulation.constraints.directions import or_one
from ..simulation.evaluation import one_blas_thread
from ..simulation.matrices import Matrix, Vector
from ..simulation.nominal import nominal_of
from ..simulation.request import SimulationRequest
from ..simulation.result import Simulation
from ..structs import Documented, computed, entry, with_attributes
from .equilibria import Stability, certain_distances
from .linear_equations import LinearEquations, Point
from .linearization import (
    RATES,
    Linearization,
    by_rates,
    linearization_of,
    linearize,
    motion_at,
    require_between_switchings,
    simulated,
    tangent_at,
)
from .repetition import equations_repeat
from .request import AlongRequest
from .resolution import unresolved, unresolved_motion
from .tangent import Tangent

NODES = 8  # steps of a block, whose nodes a polynomial of this degree goes through
PARTS = 7  # of a step between nodes, at whose ends the motion is compared with polynomials
ALIASED = 1e-3  # relative error of gradients of the equations, beyond all discretisation errors
BLOCKS = (2, 4, 8, 16, 32, 64, 128, 256, 512, 1024)
FINEST = 8  # intervals of a motion with switchings, at least, in whose nodes the basis is computed
COARSE = 1e-11  # second tolerance of a step, by which the error of derivatives is estimated
CLOSE = 1e-8  # relative error of Phi that is good enough; with all nodes it is far less
RETURNED = 1e-8  # of the sizes: differences of two states that are the same
VANISHING = 1e-9  # multipliers relative to the terms that they are the sum of
MATRICES = lists_of(MATRIX)
POINTS = lists_of({"type": "object", "additionalProperties": {"type": "number"}})
PERTURBED = 1e-7  # relative error of Phi against which characteristic multipliers are certain


@with_attributes
@dataclass(frozen=True, eq=False)
class Floquet:
    """Characteristic multipliers of a periodic motion."""

    period: float = entry("Last time less the first.")
    multipliers: Vector = entry(
        "Eigenvalues of the monodromy matrix, complex, in JSON real and imaginary parts, shape (2m,), largest first.",
        **PAIRS,
    )
    stability: Stability = entry(
        "Of the motion, by Lyapunov's theorem. Undecided if a multiplier lies on the unit circle, as one always does "
        "if neither the equations nor the controls contain the time."
    )

    @property
    def exponents(self) -> Vector:
        """Characteristic exponents, log(multiplier)/period, shape (2m,)."""
        return np.log(self.multipliers) / self.period


@with_attributes
@dataclass(frozen=True, eq=False)
class FreeDeviations:
    """Small deviations from a free motion, to first order."""

    staying: int = entry("Dimension of the initial deviations that stay free to first order, at most 2m.", minimum=0)
    sizes: Vector = entry(
        "The longest vector of multipliers of all initial deviations of length one, at each time, shape (k,).", **VECTOR
    )
    basis: Matrix = entry("Of the initial deviations that stay free, orthonormal, shape (2m, staying).", **MATRIX)
    stability: Stability | None = entry("Of the multipliers of deviations; null if the motion is not periodic.")


def _at_each(name: str, text: str, key: str = "", **rules: Any) -> property:
    """Return the entry of what the linear systems have at each time."""
    return property(computed(text, key or name, **rules)(lambda motion: [getattr(each, name) for each in motion.at]))


def _by_rates(name: str, text: str) -> property:
    """Return the entry of matrices at each time by time derivatives of controls."""
    stacked = lambda motion: {rate: [getattr(each, name)[rate] for each in motion.at] for rate in RATES}  # noqa: E731
    return property(computed(text, name, **by_rates(MATRICES))(stacked))


def _shared(name: str, text: str) -> property:
    """Return the entry of names that the linear systems share."""
    rules = {"type": "array", "items": {"type": "string"}, "uniqueItems": True}
    return property(computed(text, name, **rules)(lambda motion: getattr(motion.at[0], name)))


@with_attributes
@dataclass(frozen=True, repr=False, eq=False)
class LinearizedMotion(Documented, Shown):
    """A linear system along a motion.

    x' = A(t) x + B_u(t) du + B_du(t) du' + B_ddu(t) du''. ``at`` has the linear system at each of k times, with a basis
    that moves along continuously.

    Examples
    --------
    >>> import holonom
    >>> along = holonom.load("examples/pendulum.mac").linearize_along(until=1, samples=3)
    >>> along.times.tolist(), along.A.shape
    ([0.0, 0.5, 1.0], (3, 2, 2))
    """

    scene: str = entry("Name that the scene is assigned to.")
    at: tuple[Linearization, ...]
    transition: Matrix = entry(
        "Phi at each time, shape (k, 2m, 2m): x(t) = Phi(t) x(t0) without deviations of controls. Jumps at switchings.",
        **MATRICES,
    )
    error: float = entry("Estimated relative error of Phi at the last time, an upper bound in most cases.", minimum=0)
    floquet: Floquet | None = entry("Null unless the state returns and the equations are known to repeat for ever.")
    free: FreeDeviations | None = entry(
        "Null if the motion is not free, has no constraints, switches, or follows a table."
    )

    _coordinates = _shared("coordinates", "The n coordinates.")
    _controls = _shared("controls", "The r controls, whose deviations are inputs.")
    _outputs = _shared("outputs", "Quantities whose deviations C and D give.")
    _points = _at_each("point", "Values of all names in the equations at each time.", "points", **POINTS)
    _basis = _at_each("basis", "N at each time, n rows of m numbers; it moves along with the motion.", **MATRICES)
    _B = _by_rates("B", "What u, du/dt and ddu/dt2 add to dx/dt at each time.")
    _C = _at_each("C", "Outputs by x at each time.", **MATRICES)
    _D = _by_rates("D", "Outputs by u, du/dt and ddu/dt2 at each time.")

    def __len__(self) -> int:
        return len(self.at)

    def __getitem__(self, k: int) -> Linearization:
        """Return the linear system at the k-th time."""
        return self.at[k]

    @property
    @computed("The k times.", **VECTOR)
    def times(self) -> Vector:
        """Times, shape (k,)."""
        return np.array([each.at for each in self.at])

    @property
    @computed("Of x = (xi, eta) at each time, 2m rows.", **MATRICES)
    def A(self) -> Matrix:
        """The matrices A, shape (k, 2m, 2m)."""
        return np.array([each.A for each in self.at])

    @property
    def growth(self) -> Vector:
        """The longest deviation of all with initial length one, shape (k,)."""
        return np.array([np.linalg.norm(each, 2) for each in self.transition])

    def response(self, output: str) -> Matrix:
        """Return the deviations of an output, by the initial deviations.

        Parameters
        ----------
        output : str
            A coordinate, velocity, multiplier or output of the scene.

        Returns
        -------
        ndarray, shape (k, 2m)

        Raises
        ------
        ValueError
            There is no such output.
        """
        return np.array([each.output_row(output) @ phi for each, phi in zip(self.at, self.transition, strict=True)])


@one_blas_thread()
def linearize_along(problem: MotionProblem, equations: LinearEquations, request: AlongRequest) -> LinearizedMotion:
    """Linearise along a motion.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    equations : LinearEquations
        Of the same scene.
    request : AlongRequest
        Its end, and the number of times.

    Returns
    -------
    LinearizedMotion

    Raises
    ------
    HolonomError
        The motion is not analytic or cannot be continued so far. The constraints are singular on the way. The
        deviations change too fast for the error to be small.
    """
    require_analytic(replace(problem, tables=(), signs=()))
    intervals = request.samples - 1
    if problem.signs or (problem.tables and not problem.servo.constraints):
        return _through_switchings(problem, equations, request)
    for blocks in BLOCKS:
        nodes = _Nodes(problem, equations, request, NODES * intervals * -(-blocks // intervals))
        if nodes.error <= CLOSE:
            break
    else:
        raise HolonomError(ErrorKind.NOT_LINEARIZED_ALONG, detail=f"{nodes.error:.2g}")
    stride = (len(nodes.points) - 1) // intervals
    shown = slice(None, None, stride)
    floquet = _floquet(problem, nodes)
    return LinearizedMotion(
        problem.scene,
        tuple(nodes.linear[shown]),
        nodes.transition[shown],
        nodes.error,
        floquet,
        _free(problem, nodes, floquet, shown),
    )


class _Node(NamedTuple):
    point: Point
    here: Mapping[str, Matrix]
    tangent: Tangent

    @property
    def turning(self) -> Matrix:
        """H of N' = H N, shape (n, n)."""
        rate, N = self.here["rate_by_q"], self.tangent.basis
        R = self.tangent.shortest(-rate)
        return R - N @ (N.T @ self.here["A_rate"]) / 2

    def is_free(self, nominal: Vector, independent: Sequence[int]) -> bool:
        """Return True if the multipliers vanish.

        They are small relative to those that accelerations of nominal sizes need.
        """
        accelerations = np.maximum(np.abs(self.point.accelerations), nominal)
        forces = np.abs(self.here["equation_by_a"]) @ accelerations
        sizes = self.tangent.sizes_of_multipliers(forces, np.zeros(len(independent)))
        return bool(np.all(np.abs(self.point.multipliers[independent]) <= VANISHING * sizes))

    def reaction_deviations(self, linear: Linearization) -> tuple[Matrix, Matrix]:
        """Return the derivatives of the multipliers, and the sizes of their terms.

        Both have the shape (g, 2m).
        """
        n, g = len(linear.coordinates), len(self.here["constraint"])
        q, v = linear.C[:n], linear.C[n : 2 * n]
        force, constrained = (
            np.abs(self.here[f"{row}_by_q"]) @ np.abs(q) + np.abs(self.here[f"{row}_by_v"]) @ np.abs(v)
            for row in ("equation", "acceleration")
        )
        return linear.C[2 * n : 2 * n + g], self.tangent.sizes_of_multipliers(force, constrained)


def _through_switchings(problem: MotionProblem, equations: LinearEquations, request: AlongRequest) -> LinearizedMotion:
    """Linearise along a motion with signs or tables, by its sensitivities."""
    if problem.servo.constraints:
        raise HolonomError(ErrorKind.NO_LAW, problem.scene)
    nodes = _SwitchedNodes(problem, equations, request)
    error = nodes.error
    if error > CLOSE:
        raise HolonomError(ErrorKind.NOT_LINEARIZED_ALONG, detail=f"{error:.2g}")
    floquet = _floquet(problem, nodes)
    return LinearizedMotion(problem.scene, tuple(nodes.linear), nodes.transition, error, floquet, None)


class _Nodes:
    """A motion at equidistant nodes in blocks, with bases that move along."""

    def __init__(self, problem: MotionProblem, equations: LinearEquations, request: AlongRequest, steps: int) -> None:
        self._problem, self._equations = problem, equations
        coordinates_alone = replace(problem, observe=("trajectory",), outputs=None, controls=None)
        motion = simulated(coordinates_alone, SimulationRequest(until=request.until, samples=PARTS * steps + 1))
        self._between = np.array([*motion.coordinates.values(), *motion.velocities.values()])
        self._all_times = np.asarray(motion.times, dtype=float)
        self.times, self._states = self._all_times[::PARTS], self._between[:, ::PARTS]

    @cached_property
    def points(self) -> list[Point]:
        """The motion at each node."""
        at = zip(self.times, self._states.T, strict=True)
        return [motion_at(self._problem, self._equations, t, state) for t, state in at]

    @cached_property
    def nodes(self) -> list[_Node]:
        """The nodes, with a basis that moves along."""
        nodes = [_Node(point, *tangent_at(self._problem, self._equations, point)) for point in self.points]
        bases = _propagated(np.array([node.turning for node in nodes]), self.duration, nodes[0].tangent.basis)
        return [node._replace(tangent=node.tangent.next_to(basis)) for node, basis in zip(nodes, bases, strict=True)]

    @cached_property
    def linear(self) -> list[Linearization]:
        """The linear system at each node."""
        return [
            linearization_of(self._problem, self._equations, node.point, float(t), node.here, node.tangent)
            for t, node in zip(self.times, self.nodes, strict=True)
        ]

    @property
    def duration(self) -> float:
        return float(self.times[-1] - self.times[0])

    @cached_property
    def transition(self) -> Matrix:
        """Phi at the nodes, shape (k, 2m, 2m)."""
        return self._transition(1)

    @cached_property
    def error(self) -> float:
        """Relative difference of Phi at the end if every second node is left out.

        Or of functions of the time, or gradients of the equations, from polynomials through the nodes, if those are
        not resolved.
        """
        missed = unresolved(self._equations, self.times, NODES)
        if missed <= CLOSE:
            motion = self._problem, self._equations, self._all_times, self._between
            aliased = unresolved_motion(*motion, NODES, PARTS)
            missed = aliased if aliased > ALIASED else missed
        return missed if missed > CLOSE else max(missed, self._apart(self._transition(2)[-1]))

    @cached_property
    def lengths(self) -> Vector:
        """Factors to the state in the basis, shape (2m,).

        With them, velocities are in the nominal unit of time.
        """
        return np.repeat([1.0, float(nominal_of(self._problem).time)], self.transition.shape[1] // 2)

    @property
    def balanced(self) -> Matrix:
        """Phi of the state in these lengths, shape (k, 2m, 2m)."""
        return self.lengths[:, None] * self.transition / self.lengths

    def _apart(self, coarse: Matrix) -> float:
        """Return the relative distance of Phi at the end from another one."""
        here, there = self.balanced[-1], self.lengths[:, None] * coarse / self.lengths
        return float(np.linalg.norm(there - here) / or_one(np.linalg.norm(here)))

    def _transition(self, stride: int) -> Matrix:
        rates = np.array([each.A for each in self.linear[::stride]])
        return _propagated(rates, self.duration, np.eye(rates.shape[1]), NODES // stride)

    def repeats(self) -> bool:
        """Return True if the state returns and the equations repeat."""
        first, last = self.points[0], self.points[-1]
        nominal = nominal_of(self._problem)
        if np.any(
            np.abs(last.state - first.state) > RETURNED * np.concatenate([nominal.coordinates, nominal.velocities])
        ):
            return False
        return equations_repeat(self._equations, self.duration)


class _SwitchedNodes(_Nodes):
    """A motion through switchings, with its derivatives by initial values.

    The basis depends on the state alone, so it moves along continuously. The derivatives jump with the switchings
    (`holonom.simulation.sensitivities`), and X(t) X(t0)^-1 is Phi, with X the derivatives in the basis.
    """

    def __init__(self, problem: MotionProblem, equations: LinearEquations, request: AlongRequest) -> None:
        self._problem, self._equations = problem, equations
        leading = linearize(problem, equations).leading
        self._directions = *leading, *(f"dot({q})" for q in leading)
        intervals = request.samples - 1
        stride = NODES * -(-FINEST // intervals)
        motion = self._derived(request.until, stride * intervals + 1, None)
        states = np.array([*motion.coordinates.values(), *motion.velocities.values()])
        self.times = np.asarray(motion.times, dtype=float)
        bases = self._bases(states)[::stride]
        self.times, self._states = self.times[::stride], states[:, ::stride]
        for t, state in zip(self.times, self._states.T, strict=True):
            require_between_switchings(problem, t, state)
        nodes = [_Node(point, *tangent_at(problem, equations, point)) for point in self.points]
        self.nodes = [
            node._replace(tangent=node.tangent.next_to(basis)) for node, basis in zip(nodes, bases, strict=True)
        ]
        self.transition = self._transitions(motion, stride)
        self.error = self._apart(self._transitions(self._derived(request.until, len(self.times), COARSE), 1)[-1])

    def _derived(self, until: Fraction | None, samples: int, tol: float | None) -> Simulation:
        alone = replace(self._problem, observe=("trajectory",), outputs=None, controls=None)
        asked = SimulationRequest(until=until, samples=samples, sensitivities=self._directions, tol=tol)
        return simulated(alone, asked)

    def _bases(self, states: Matrix) -> Matrix:
        none = np.zeros(len(self._equations.coordinates)), np.zeros(len(self._equations.multipliers))
        nodes = []
        for t, state in zip(self.times, states.T, strict=True):
            point = Point(t, state, *none, self._equations.controls_at(t))
            nodes.append(_Node(point, *tangent_at(self._problem, self._equations, point)))
        return _propagated(np.array([node.turning for node in nodes]), self.duration, nodes[0].tangent.basis)

    def _transitions(self, motion: Simulation, stride: int) -> Matrix:
        names = [[derivative_name(name, k) for k in self._directions] for name in self._problem.state]
        moves = np.array([[motion.sensitivities[each][::stride] for each in row] for row in names])
        found = np.array([
            scipy.linalg.block_diag(*[node.tangent.basis.T @ node.here["equation_by_a"]] * 2) @ moves[:, :, k]
            for k, node in enumerate(self.nodes)
        ])  # fmt: skip
        return found @ np.linalg.inv(found[0])


def _propagated(rates: Matrix, duration: float, start: Matrix, nodes: int = NODES) -> Matrix:
    """Return the solution of X' = G(t) X at equidistant nodes.

    Parameters
    ----------
    rates : ndarray, shape (k, s, s)
        G at the nodes, k - 1 a multiple of the nodes of a block.
    duration : float
        Time from the first to the last node.
    start : ndarray, shape (s, p)
        X at the first node.
    nodes : int
        Steps of a block.

    Returns
    -------
    ndarray, shape (k, s, p)
    """
    size, blocks = len(start), (len(rates) - 1) // nodes
    weights = _collocation(nodes) * duration / max(blocks, 1)
    solution = np.empty((len(rates), *start.shape))
    solution[0] = start
    for first in range(0, blocks * nodes, nodes):
        block = np.einsum("jk,kab->jakb", weights, rates[first : first + nodes + 1])
        matrix = np.eye(nodes * size) - block[:, :, 1:].reshape(nodes * size, nodes * size)
        right = np.tile(solution[first], (nodes, 1)) + (block[:, :, 0] @ solution[first]).reshape(
            nodes * size, start.shape[1]
        )
        solution[first + 1 : first + nodes + 1] = np.linalg.solve(matrix, right).reshape(nodes, *start.shape)
    return solution


def _collocation(nodes: int) -> Matrix:
    """Return integrals from 0 to c_j of Lagrange's polynomials at equidistant nodes.

    The polynomial k is 1 at c_k = k/nodes and 0 at the others. Shape (nodes, nodes + 1).
    """
    places = np.linspace(-1, 1, nodes + 1)
    polynomials = np.linalg.inv(legendre.legvander(places, nodes))
    return legendre.legval(places[1:], legendre.legint(polynomials, lbnd=-1)).T / 2


def _floquet(problem: MotionProblem, nodes: _Nodes) -> Floquet | None:
    if not nodes.duration or not nodes.repeats():
        return None
    monodromy = _monodromy(nodes)
    values = np.linalg.eigvals(monodromy).astype(complex)
    return Floquet(nodes.duration, values[np.argsort(-np.abs(values), kind="stable")], _stability_of(monodromy))


def _monodromy(nodes: _Nodes) -> Matrix:
    """Return Phi(T) in the basis at the initial time."""
    first, last = nodes.linear[0], nodes.linear[-1]
    turned = first.basis.T @ first.mass @ last.basis
    return scipy.linalg.block_diag(turned, turned) @ nodes.transition[-1]


def _stability_of(monodromy: Matrix) -> Stability:
    """Decide by Lyapunov's theorem on multipliers of certain place."""
    outside, certain = certain_distances(monodromy, PERTURBED, lambda values: np.abs(values) - 1)
    if np.any(certain & (outside > 0)):
        return Stability.UNSTABLE
    return Stability.ASYMPTOTIC if np.all(certain & (outside < 0)) else Stability.UNDECIDED


def _free(problem: MotionProblem, nodes: _Nodes, floquet: Floquet | None, shown: slice) -> FreeDeviations | None:
    if not len(nodes.nodes[0].here["constraint"]) or problem.servo.constraints:
        return None
    accelerations, independent = nominal_of(problem).accelerations, list(problem.independent)
    if not all(node.is_free(accelerations, independent) for node in nodes.nodes):
        return None
    parts = [node.reaction_deviations(linear) for node, linear in zip(nodes.nodes, nodes.linear, strict=True)]
    rows = [np.where(np.abs(C) > VANISHING * terms, C, 0.0) for C, terms in parts]
    responses = np.array([C @ phi for C, phi in zip(rows, nodes.transition, strict=True)])
    lengths = nodes.lengths
    grown = np.linalg.norm(nodes.balanced, axis=(1, 2))[:, None]
    scales = or_one(grown * np.array([np.linalg.norm(terms / lengths, axis=1) for _, terms in parts]))
    stacked = (responses / lengths / scales[:, :, None]).reshape(-1, len(lengths))
    _, values, right = np.linalg.svd(stacked, full_matrices=True)
    rank = int(np.count_nonzero(values > VANISHING * np.sqrt(len(stacked))))
    stability = None
    if floquet is not None:
        moving = right[:rank]
        monodromy = lengths[:, None] * _monodromy(nodes) / lengths
        stability = _stability_of(moving @ monodromy @ moving.T) if rank else Stability.STABLE
    sizes = np.array([np.linalg.norm(each, 2) for each in responses[shown]])
    return FreeDeviations(right.shape[0] - rank, sizes, _orthonormal(right[rank:].T, lengths), stability)


def _orthonormal(basis: Matrix, lengths: Vector) -> Matrix:
    """Return an orthonormal basis of vectors in these lengths, shape (2m, s).

    Those without velocities come apart first: the unit of time may be so small or large that they would be lost.
    """
    if not basis.size:
        return basis
    _, _, turned = np.linalg.svd(basis[len(basis) // 2 :])
    graded = basis @ turned.T
    return np.linalg.qr((graded if lengths[-1] < 1 else graded[:, ::-1]) / lengths[:, None])[0]
