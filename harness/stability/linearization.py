"""Linearisation of a motion on the constraint manifold.

Deviations that the constraints allow are dq = N xi + P du, dv = N eta + R xi + S du + P du', with J N = 0, N^T A N = 1,
and P, R, S the solutions of

    J P = -U,        J R = -J' N,        J S = -(J' P + U')

that are orthogonal to N in the mass metric, where ' is the derivative along the motion. N moves with the motion so that
N^T A N' = -N^T A' N/2, as little as its lengths in the mass metric allow. Then xi = N^T A dq and eta = N^T A dv satisfy

    xi'  = eta + N^T A' N xi/2 + (R^T A P + N^T A' P) du,
    eta' = (N'^T A + N^T A') dv - N^T (D dv + K dq + E0 du + E1 du' + E2 du''),

with A, D, K, E of `holonom.stability.linear_equations` (beyond the paper, with independent coordinates in place of xi:
Peterson, Gede & Hubbard, Multibody System Dynamics 33 (2015) 143).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.linalg

from ..failures import ErrorKind, HolonomError
from ..language import translatable
from ..program.drawing import Drawing
from ..program.motion_problem import DependsOn, MotionProblem, Sign, require_analytic
from ..program.motion_program import names_used
from ..program.numpy_function import NumpyFunction
from ..program.rewriting import computing
from ..program.sign_pattern import drawing_with_values
from ..schema import MATRIX, PAIRS, VECTOR, Names, lists_of
from ..shown import Shown
from ..simulation.constraints.directions import or_one
from ..simulation.evaluation import one_blas_thread
from ..simulation.hybrid_motion import EventOutcome
from ..simulation.matrices import Matrix, Vector, start_of
from ..simulation.nominal import nominal_of
from ..simulation.request import FINAL_STATE_ALONE, SimulationRequest
from ..simulation.result import Simulation
from ..simulation.simulate import simulate
from ..structs import Documented, computed, entry, with_attributes
from .linear_equations import LinearEquations, Point
from .smoothness import ON_SURFACE, is_smooth, with_limits
from .tangent import Tangent

if TYPE_CHECKING:
    from ..figures.style import Picture

RATES = ("u", "du", "ddu")  # a control, its time derivative and its acceleration
AT_REST = 1e-9  # velocities and accelerations, in terms of their nominal sizes, that count as none
ROUNDED = 16 * np.finfo(float).eps  # rounding errors of A, relative
UNREACHED = (1e-9, 1e-12)  # relative to other directions of the state: those surely reached, and surely not


def by_rates(matrix: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the schema of matrices by controls and their time derivatives.

    Parameters
    ----------
    matrix : mapping
        Schema of one of them.

    Returns
    -------
    dict
    """
    texts = ("of the controls", "of the first derivatives of the controls", "of the second derivatives of the controls")
    properties = {rate: {"description": f"Matrix {text}.", **matrix} for rate, text in zip(RATES, texts, strict=True)}
    return {"type": "object", "properties": properties, "required": [*RATES], "additionalProperties": False}


@with_attributes
@dataclass(frozen=True, repr=False, eq=False)  # arrays have no one answer to ==
class Linearization(Documented, Shown):
    """A linear system x' = A x + B_u du + B_du du' + B_ddu du''.

    Its output is y = C x + D_u du + ..., and its state x = (xi, eta).

    Examples
    --------
    >>> import holonom
    >>> found = holonom.load("examples/pendulum.mac").linearize(equilibrium="e1")
    >>> found.leading, round(float(abs(found.eigenvalues[0])), 6)
    (('x',), 3.132092)
    """

    scene: str = entry("Name that the scene is assigned to.")
    at: float | None = entry("The time; null for an equilibrium.")
    at_rest: bool = entry(
        "Whether velocities, accelerations and derivatives of controls vanish there, and the equations do not contain "
        "the time; else A belongs to one time and to the coordinates xi, whose basis may change, and its eigenvalues "
        "do not decide about stability."
    )
    coordinates: Names = entry("The n coordinates.")
    leading: Names = entry("The m coordinates that the tangent coordinates belong to.")
    controls: Names = entry("The r controls, whose deviations are inputs.")
    outputs: Names = entry(
        "Names of the entries of y, whose deviations C and D give: coordinates, velocities, multipliers, controls that "
        "servo-constraints find, outputs of the scene."
    )
    point: Mapping[str, float] = entry(
        "Time, coordinates, velocities, accelerations, multipliers, and controls with their derivatives, by name."
    )
    mass: Matrix = entry("The mass matrix, shape (n, n).", **MATRIX)
    basis: Matrix = entry("N, shape (n, m): the coordinates deviate by N xi, N^T mass N = 1.", **MATRIX)
    A: Matrix = entry("Of x = (xi, eta), shape (2m, 2m).", **MATRIX)
    B: Mapping[str, Matrix] = entry(
        "Parts of dx/dt from u, du/dt and ddu/dt2, each of shape (2m, r).", **by_rates(MATRIX)
    )
    C: Matrix = entry("Outputs by x, shape (outputs, 2m).", **MATRIX)
    D: Mapping[str, Matrix] = entry("Outputs by u, du/dt and ddu/dt2, each of shape (outputs, r).", **by_rates(MATRIX))
    drawing: Drawing | None

    @cached_property
    def _modes(self) -> tuple[Vector, Matrix]:
        values, vectors = np.linalg.eig(self.A)
        order = np.lexsort((values.imag, -values.real, np.abs(values)))
        return values[order].astype(complex), vectors[:, order].astype(complex)

    @property
    @computed("Of A, real and imaginary parts, the slowest first.", **PAIRS)
    def eigenvalues(self) -> Vector:
        """Eigenvalues of A, shape (2m,), complex, the slowest first."""
        return self._modes[0]

    @property
    def eigenvalue_errors(self) -> Vector:
        """Rounding errors of the eigenvalues to expect, shape (2m,).

        They are the condition numbers of the eigenvalues times the rounding errors of A, at most those of a double
        eigenvalue, their square root.
        """
        values, moved, _ = perturbed_eigenvalues(self.A, ROUNDED)
        if not values.size:
            return moved
        nearest = np.argmin(np.abs(self.eigenvalues[:, None] - values), axis=1)
        return np.minimum(moved[nearest], np.sqrt(ROUNDED) * np.linalg.norm(self.A, 2))

    @property
    @computed(
        "Coordinates of the eigenvectors, n rows of 2m complex numbers; the largest of each is 1.", **lists_of(PAIRS)
    )
    def modes(self) -> Matrix:
        """Coordinates of the eigenvectors, shape (n, 2m), complex.

        The largest entry of each is 1.
        """
        shapes = self.basis @ self._modes[1][: self.basis.shape[1]]
        largest = np.argmax(np.abs(shapes), axis=0) if shapes.size else []
        peaks = shapes[largest, np.arange(shapes.shape[1])]
        return shapes / np.where(peaks == 0, 1.0, peaks)

    @property
    @computed("|eigenvalue|/(2 pi).", **VECTOR)
    def frequencies(self) -> Vector:
        """Undamped frequencies ``|eigenvalue|/(2 pi)``, shape (2m,).

        The unit is one period in the unit of time.
        """
        return np.abs(self.eigenvalues) / (2 * np.pi)

    @property
    @computed("-Re/|eigenvalue|.", **VECTOR)
    def damping(self) -> Vector:
        """Damping ratios, ``-Re/|eigenvalue|``, shape (2m,), zero for zero eigenvalues."""
        sizes = np.abs(self.eigenvalues)
        return -self.eigenvalues.real / np.where(sizes > 0, sizes, 1.0) + 0.0

    @property
    @computed("Kalman's, at most 2m; null where rounding does not determine it.", minimum=0)
    def controllable_rank(self) -> int | None:
        """Kalman's rank of controllability, at most 2m.

        None if rounding does not determine it.

        With z = x - (B_du + A B_ddu) du - B_ddu du' the controls enter by B_u + A B_du + A^2 B_ddu alone (Kailath,
        Linear Systems, chapter 2).
        """
        b_u, b_du, b_ddu = (self.B[rate] for rate in RATES)
        return _reachable(self.A, b_u + self.A @ (b_du + self.A @ b_ddu))

    @property
    @computed("Kalman's, by all outputs; null where rounding does not determine it.", "observable_rank", minimum=0)
    def _observable_rank(self) -> int | None:
        return self.observable_rank()

    def observable_rank(self, outputs: Sequence[str] | str | None = None) -> int | None:
        """Kalman's rank of observability, at most 2m.

        None if rounding does not determine it.

        Parameters
        ----------
        outputs : sequence of str, str or None
            Names of outputs, or one name, or None for all.

        Returns
        -------
        int or None

        Raises
        ------
        ValueError
            There is no such output.
        """
        return _reachable(self.A.T, self.C[self._rows(outputs)].T)

    def output_row(self, output: str) -> Vector:
        """Return the deviation of an output by the state.

        Parameters
        ----------
        output : str
            Its name.

        Returns
        -------
        ndarray, shape (2m,)

        Raises
        ------
        ValueError
            There is no such output.
        """
        return self.C[self._rows([output])[0]]

    def state_space(self, input: str = "u", outputs: Sequence[str] | str | None = None) -> tuple[Matrix, ...]:
        """Return A, B, C, D as `scipy.signal.StateSpace` and python-control take them.

        Parameters
        ----------
        input : str
            ``u``: the controls' deviations, if their time derivatives do not enter. ``ddot``: the controls'
            accelerations. Then u and du/dt are states, after xi and eta.
        outputs : sequence of str, str or None
            Names of outputs, or one name, or None for all.

        Returns
        -------
        A : ndarray, shape (s, s)
            s = 2m, or 2m + 2r with the input ``ddot``.
        B : ndarray, shape (s, r)
        C : ndarray, shape (p, s)
            A row for each of the p outputs.
        D : ndarray, shape (p, r)

        Raises
        ------
        ValueError
            The time derivatives of the controls enter, or there is no such input or output.
        """
        rows = self._rows(outputs)
        parts = [[self.B[rate], self.D[rate][rows]] for rate in RATES]
        if input == "u":
            if any(part.any() for pair in parts[1:] for part in pair):
                raise ValueError("the time derivatives of the controls enter; take the input 'ddot'")
            return self.A, parts[0][0], self.C[rows], parts[0][1]
        if input != "ddot":
            raise ValueError(f"unknown input {input!r}: expected 'u' or 'ddot'")
        (b_u, d_u), (b_du, d_du), (b_ddu, d_ddu) = parts
        r, size = len(self.controls), len(self.A)
        one, none = np.eye(r), np.zeros((r, r))
        a = np.block([[self.A, b_u, b_du], [np.zeros((r, size)), none, one], [np.zeros((r, size)), none, none]])
        return a, np.concatenate([b_ddu, none, one]), np.concatenate([self.C[rows], d_u, d_du], axis=1), d_ddu

    def plot(self) -> "Picture":
        """Return a figure of the eigenvalues and of the modes.

        The modes are on the drawing of the system, if it has one.

        Returns
        -------
        Picture

        Raises
        ------
        HolonomError
            Matplotlib is not installed.
        """
        from ..figures.modes import modes_figure
        from ..figures.style import Picture

        return Picture(modes_figure(self))

    def _rows(self, outputs: Sequence[str] | str | None) -> list[int]:
        wanted = self.outputs if outputs is None else [outputs] if isinstance(outputs, str) else outputs
        if unknown := [name for name in wanted if name not in self.outputs]:
            raise ValueError(f"unknown output {unknown[0]!r}: expected {', '.join(self.outputs)}")
        return [self.outputs.index(name) for name in wanted]


@one_blas_thread()
def linearize(problem: MotionProblem, equations: LinearEquations, at: Fraction | None = None) -> Linearization:
    """Linearise a motion at a given time.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    equations : LinearEquations
        Of the same scene.
    at : Fraction or None
        The time, or None for the initial time.

    Returns
    -------
    Linearization

    Raises
    ------
    HolonomError
        A sign changes there with an effect, or slides. A joint is released before. The motion has forces with
        multipliers, or cannot be continued so far. The constraints are singular there, or derivatives have no value.
    """
    require_analytic(replace(problem, signs=(), tables=(), ends=replace(problem.ends, released=())))
    t, state = state_at(problem, at)
    changing = changing_signs(problem, t, state)
    of_state = all(sign.by in (DependsOn.CONFIGURATION, DependsOn.VELOCITY) for sign in changing)
    point = motion_at(problem, equations, t, state)
    if changing and not (of_state and is_smooth(equations, point, nominal_of(problem).state)):
        raise HolonomError(ErrorKind.NOT_ANALYTIC, problem.scene, changing[0].of)
    with np.errstate(invalid="ignore"):
        found = linearization_of(problem, equations, point, t, *tangent_at(problem, equations, point))
    if not all(np.isfinite(each).all() for each in (found.C, *found.D.values())):
        raise HolonomError(ErrorKind.NO_DERIVATIVES, time=t)
    return found


def require_between_switchings(problem: MotionProblem, t: float, state: Vector) -> None:
    """Reject a state at which a sign changes, slides, or depends on a reaction.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    t : float
        Time, in the scene's unit.
    state : ndarray, shape (2n,)
        Coordinates, then velocities.

    Raises
    ------
    HolonomError
        It is not a state between switchings.
    """
    if changing := changing_signs(problem, t, state):
        raise HolonomError(ErrorKind.NOT_ANALYTIC, problem.scene, changing[0].of)


def changing_signs(problem: MotionProblem, t: float, state: Vector) -> list[Sign]:
    """Return the signs that change at a state, and those that depend on a reaction.

    A function counts as zero if it is small relative to its changes when time, coordinates and velocities move by
    nominal sizes.

    Parameters
    ----------
    problem, t, state : MotionProblem, float, ndarray of shape (2n,)
        As for `require_between_switchings`.

    Returns
    -------
    list of Sign
        Empty between switchings.
    """
    nominal, names = nominal_of(problem), ("t", *problem.state)
    points = np.array([t, *state])[:, None] + np.diag([0.0, nominal.time, *nominal.state])[1:]
    known = dict(zip(names, points, strict=True)) | {name: float(value) for name, value in problem.values.items()}
    changing = []
    for place, sign in enumerate(problem.signs, start=1):
        program = computing(problem.switching, {f"switch[{place}]"})
        if not names_used(program) & set(program.inputs) <= known.keys():
            changing.append(sign)
            continue
        here, *beside = NumpyFunction(program)([known.get(name, 0.0) for name in program.inputs])[0]
        if not abs(here) > ON_SURFACE * np.max(np.abs(np.subtract(beside, here))):
            changing.append(sign)
        known[sign.name] = np.sign(here)
    return changing


def tangent_at(
    problem: MotionProblem, equations: LinearEquations, point: Point
) -> tuple[Mapping[str, Matrix], Tangent]:
    """Evaluate the linearised equations, and choose a basis of the tangent space.

    Parameters
    ----------
    problem, equations : MotionProblem, LinearEquations
        As for `linearize`.
    point : Point
        State with accelerations, multipliers and controls, at which the equations of motion hold.

    Returns
    -------
    here : mapping of str to ndarray
        As `LinearEquations.at`.
    tangent : Tangent

    Raises
    ------
    HolonomError
        The constraints are singular there.
    """
    independent = problem.independent
    here = _evaluated(problem, equations, point, independent)
    tangent = _tangent(equations, here, point)
    if tangent.rank < len(independent) and problem.obstruction is None:
        raise HolonomError(ErrorKind.NOT_LINEARIZED, time=point.t)
    return here, tangent


def _evaluated(
    problem: MotionProblem, equations: LinearEquations, point: Point, independent: Sequence[int]
) -> Mapping[str, Matrix]:
    """Evaluate the linearised equations, by limits where a formula divides by zero."""
    here = equations.at(point, independent)
    if not all(np.isfinite(each).all() for each in here.values()):
        here = with_limits(equations, [point], nominal_of(problem).state).at(point, independent)
    if not all(np.isfinite(each).all() for name, each in here.items() if not name.startswith("output")):
        raise HolonomError(ErrorKind.NO_DERIVATIVES, time=point.t)
    return here


def _tangent(equations: LinearEquations, here: Mapping[str, Matrix], point: Point) -> Tangent:
    reactions, mass = here["reactions"] if equations.servo else None, here["equation_by_a"]
    return Tangent(mass, here["constraint_by_q"], equations.masses_near(point, mass), reactions)


def linearization_of(
    problem: MotionProblem,
    equations: LinearEquations,
    point: Point,
    at: float | None,
    here: Mapping[str, Matrix],
    tangent: Tangent,
) -> Linearization:
    """Return the linear system in a basis of the tangent space.

    Parameters
    ----------
    problem, equations, point : MotionProblem, LinearEquations, Point
        As for `tangent_at`.
    at : float or None
        The time at which a motion is there, or None for an equilibrium.
    here, tangent : mapping of str to ndarray, Tangent
        As of `tangent_at`.

    Returns
    -------
    Linearization
    """
    names, reacting = equations.coordinates, problem.independent[: equations.natural(problem.independent)]
    return Linearization(
        problem.scene,
        at,
        _is_at_rest(problem, equations, point),
        names,
        tuple(names[place] for place in tangent.leading),
        equations.controls,
        (*problem.state, *(equations.multipliers[beta] for beta in reacting), *equations.found, *equations.outputs),
        _named(equations, problem.state, point),
        here["equation_by_a"],
        tangent.basis,
        *_state_space(here, tangent, len(reacting) + len(equations.found)),
        _drawing(problem, equations, at),
    )


def _is_at_rest(problem: MotionProblem, equations: LinearEquations, point: Point) -> bool:
    nominal, velocities = nominal_of(problem), point.state[len(equations.coordinates) :]
    moving = np.abs([velocities, point.accelerations]) > AT_REST * np.array([nominal.velocities, nominal.accelerations])
    driven = point.controls[len(equations.controls) :]
    return not (moving.any() or driven.any() or equations.changes_with_time)


def _drawing(problem: MotionProblem, equations: LinearEquations, at: float | None) -> Drawing | None:
    if problem.drawing is None:
        return None
    drawing = drawing_with_values(problem)
    moved = at is None and names_used(drawing.program) & set(equations.controls)
    return None if moved else drawing


def _named(equations: LinearEquations, state: Sequence[str], point: Point) -> dict[str, float]:
    rates = [f"{dots}({u})" if dots else u for dots in ("", "dot", "ddot") for u in equations.controls]
    accelerations = [f"ddot({q})" for q in equations.coordinates]
    reacting = len(equations.multipliers) - equations.servo
    names = "t", *state, *accelerations, *equations.multipliers[:reacting], *rates, *equations.found
    point = point._replace(multipliers=point.multipliers[:reacting], found=point.found[: len(equations.found)])
    return dict(zip(names, map(float, [point.t, *np.concatenate(point[1:])]), strict=True))


def state_at(problem: MotionProblem, at: Fraction | None) -> tuple[float, Vector]:
    """Return the time, None for the initial time, and the state there.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    at : Fraction or None
        Time in the scene's unit, or None for the initial time.

    Returns
    -------
    t : float
    state : ndarray, shape (2n,)
        Coordinates, then velocities.

    Raises
    ------
    HolonomError
        The motion cannot be continued so far, ends before, releases a joint, or has errors too large for the tolerance.
    """
    start = start_of(problem)
    if at is None or at == start[0]:
        return start
    if at < start[0]:
        begin = translatable("it begins at t = %(start)s", start=f"{start[0]:.10g}")
        raise HolonomError(ErrorKind.NOT_REACHED, time=float(at), detail=begin)
    report = simulated(problem, SimulationRequest(until=at, samples=FINAL_STATE_ALONE)).report
    for each in report.switchings:
        if each.outcome is EventOutcome.JOINT_RELEASED:
            raise HolonomError(ErrorKind.NOT_ANALYTIC, problem.scene, detail=each.function)
    return float(report.t), np.array([*report.coordinates.values(), *report.velocities.values()])


def simulated(problem: MotionProblem, request: SimulationRequest) -> Simulation:
    """Integrate a motion to its last time.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    request : SimulationRequest
        Its end and samples.

    Returns
    -------
    Simulation

    Raises
    ------
    HolonomError
        The motion ends before the requested time, or has errors too large for the tolerance.
    """
    motion = simulate(problem, request)
    report = motion.report
    if report.ending is not None and request.until is not None and report.t < request.until:
        raise HolonomError(
            ErrorKind.NOT_REACHED,
            time=float(request.until),
            detail=translatable("it ends at t = %(end)s", end=f"{report.t:.10g}"),
        )
    if report.violations:
        raise HolonomError(ErrorKind.NOT_REACHED, time=float(report.t), detail=report.violations[0].reason)
    return motion


def motion_at(problem: MotionProblem, equations: LinearEquations, t: float, state: Vector) -> Point:
    """Return the state with accelerations and multipliers.

    Multipliers of dependent constraints are zero.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    equations : LinearEquations
        Of the same scene.
    t : float
        Time, in the scene's unit.
    state : ndarray, shape (2n,)
        Coordinates, then velocities.

    Returns
    -------
    Point

    Raises
    ------
    HolonomError
        A control has no law, or the mass matrix is singular along a free direction.
    """
    n, rows, multipliers = len(equations.coordinates), list(problem.independent), np.zeros(len(equations.multipliers))
    none = np.zeros(len(equations.found) + equations.drives)
    at_rest = Point(t, state, np.zeros(n), multipliers, equations.controls_at(t), none)
    here = _evaluated(problem, equations, at_rest, rows)
    tangent = _tangent(equations, here, at_rest)
    if not tangent.determined:
        raise HolonomError(ErrorKind.NOT_LINEARIZED, time=t)
    accelerations, forces = tangent.solve(-here["equation"][:, None], -here["acceleration"][:, None])
    reacting = rows[: equations.natural(rows)]
    multipliers[reacting], found = np.split(forces[:, 0], [len(reacting)])
    return at_rest._replace(accelerations=accelerations[:, 0], found=found)


def _state_space(
    here: Mapping[str, Matrix], tangent: Tangent, shown: int
) -> tuple[Matrix, dict[str, Matrix], Matrix, dict]:
    """Return A, B, C, D from deviations with columns for xi, eta, du, du' and du''.

    Of the forces of the constraints, C and D contain the first ones.
    """
    mass, mass_rate, U = here["equation_by_a"], here["A_rate"], here["constraint_by_u"]
    N, n, m, r = tangent.basis, *tangent.basis.shape, U.shape[1]

    P, R = tangent.shortest(-U), tangent.shortest(-here["rate_by_q"] @ N)
    S = tangent.shortest(-here["rate_by_q"] @ P - here["rate_by_u"])
    turned = N.T @ mass_rate @ N / 2
    q = np.block([N, np.zeros((n, m)), P, np.zeros((n, 2 * r))])
    v = np.block([R, N, S, P, np.zeros((n, r))])
    controls = np.eye(3 * r, 2 * m + 3 * r, 2 * m)
    unsolved = _by_deviations(here, "equation", q, v, controls)
    basis_rate = R - N @ turned
    xi_rate = np.block([turned, np.eye(m), R.T @ mass @ P + N.T @ mass_rate @ P, np.zeros((m, 2 * r))])
    accelerations, forces = tangent.solve(-unsolved, -_by_deviations(here, "acceleration", q, v, controls))
    eta_rate = (basis_rate.T @ mass + N.T @ mass_rate) @ v + N.T @ mass @ accelerations
    own = _by_deviations(here, "output", q, v, controls) + here["output_by_a"] @ accelerations
    own = own + here["output_by_forces"] @ forces
    rows, outputs = np.concatenate([xi_rate, eta_rate]), np.concatenate([q, v, forces[:shown], own])
    (A, *B), (C, *D) = (np.split(part, 2 * m + r * np.arange(3), axis=1) for part in (rows, outputs))
    return A, dict(zip(RATES, B, strict=True)), C, dict(zip(RATES, D, strict=True))


def _by_deviations(here: Mapping[str, Matrix], row: str, q: Matrix, v: Matrix, controls: Matrix) -> Matrix:
    """Return the change of an expression by the deviations.

    Those of accelerations and multipliers are left out.
    """
    by_controls = np.concatenate([here[f"{row}_by_{rate}"] for rate in RATES], axis=1)
    return here[f"{row}_by_q"] @ q + here[f"{row}_by_v"] @ v + by_controls @ controls


def _reachable(A: Matrix, B: Matrix) -> int | None:
    """Return the dimension of the span of B, A B, A^2 B, ...

    None if rounding does not determine it.
    """
    balanced, scale = _balanced(A)
    A, B = balanced / or_one(np.linalg.norm(balanced)), B / scale[:, None]
    fewest, most = (_dimension(A, B / or_one(np.linalg.norm(B, axis=0)), least) for least in UNREACHED)
    return fewest if fewest == most else None


def _balanced(A: Matrix) -> tuple[Matrix, Vector]:
    """Return D^-1 A D with rows as long as columns, and the diagonal of D."""
    with np.errstate(invalid="ignore"):  # SciPy casts large factors to integers that it does not use
        balanced, (scale, _) = scipy.linalg.matrix_balance(A, permute=False, separate=True)
    return balanced, scale


def _dimension(A: Matrix, B: Matrix, least: float) -> int:
    reached = np.zeros((len(A), 0))
    while B.shape[1] and reached.shape[1] < len(A):
        for _ in range(2):  # twice is enough (Parlett, The Symmetric Eigenvalue Problem, section 6.9)
            B = B - reached @ (reached.T @ B)
        left, values, _ = np.linalg.svd(B, full_matrices=False)
        new = left[:, values > least]
        reached, B = np.concatenate([reached, new], axis=1), A @ new
    return reached.shape[1]


def perturbed_eigenvalues(A: Matrix, error: float, entries: Matrix | float = 0.0) -> tuple[Vector, Vector, Vector]:
    """Return eigenvalues, their changes under errors of A, and their conditions.

    An eigenvalue moves by its condition number 1/|y^H x| times the perturbation, to first order (Golub & Van Loan,
    section 7.2).

    Parameters
    ----------
    A : ndarray, shape (s, s)
    error : float
        Relative.
    entries : float or ndarray, shape (s, s)
        Further errors of the entries of A, absolute.

    Returns
    -------
    values, changes, conditions : ndarray, shape (s,)
    """
    if not A.size:
        return np.empty(0), np.empty(0), np.empty(0)
    balanced, scale = _balanced(A)
    values, left, right = scipy.linalg.eig(balanced, left=True, right=True)
    with np.errstate(divide="ignore"):
        conditions = 1 / np.abs(np.einsum("ij,ij->j", left.conj(), right))
    moved = np.einsum("ij,ik,kj->j", np.abs(left), entries * np.outer(1 / scale, scale), np.abs(right))
    return values, (error * np.linalg.norm(balanced, 2) + moved) * conditions, conditions
