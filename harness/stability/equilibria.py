"""Equilibria for constant controls, and their stability.

At rest the equations of motion are r(q, lambda) = 0, f(q) = 0, where the gradients of f are independent. Newton's
method solves them from many random starting points. More solutions may exist, unless
`holonom.stability.real_solutions` counts as many. Stability follows from three theorems:

- If all forces have a potential, or are gyroscopic or linear and dissipative, q is stable if the second variation of
  V - T0 on the constraint manifold is positive definite: the energy has a strict minimum there, and never grows
  (Lagrange and Dirichlet; Merkin, Introduction to the Theory of Stability, chapters 3 and 6).
- It is asymptotically stable if all eigenvalues of the linearised motion have negative real parts, and unstable if one
  has a positive real part (Lyapunov; Merkin, chapter 4).
- If the equations of motion are linear and the energy is conserved, it is stable if all eigenvalues are simple and
  imaginary, also at a maximum of the energy: gyroscopic stabilization (Merkin, chapter 6).

Otherwise the stability is undecided.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ..failures import ErrorKind, HolonomError
from ..language import translatable
from ..program.motion_problem import DependsOn, MotionProblem, require_analytic, require_laws
from ..program.motion_program import names_used
from ..schema import PAIRS, NumberText
from ..shown import Shown
from ..simulation.constraints.directions import or_one
from ..simulation.evaluation import one_blas_thread
from ..simulation.matrices import Matrix, Vector, start_of
from ..simulation.nominal import nominal_of
from ..structs import Documented, computed, entry, with_attributes
from .equivalence import Equivalence
from .linear_equations import EnergyChange, LinearEquations, Point
from .linearization import Linearization, linearization_of, perturbed_eigenvalues, tangent_at
from .repetition import reversible, whole_turns
from .smoothness import is_smooth, with_limits
from .tangent import Tangent

if TYPE_CHECKING:
    from sympy import Expr

    from .real_solutions import RealSolutions

SPREADS = (0.5, 1.0, 2.0, 4.0, 8.0)  # of random starts, in terms of the coordinates' sizes
DISTANCES = 4.0 ** np.arange(12)  # in terms of nominal sizes, at which changes of the stiffness are looked for
CHANGED = 0.1  # relative change of the stiffness at the size of a coordinate
BATCH = 64  # coordinates along which it is looked for at once
ITERATIONS = 60
STEPS, CORRECTIONS = 16, 6  # along the constraints to a starting point, and onto them after each
HALVINGS = 40  # of such a step, for the place where an orientation changes
CONVERGED = 1e-11  # step of Newton's method in terms of the sizes
BALANCED = 1e-9  # forces and residuals left, in terms of the largest that was met
LONGEST_STEP = 2.0  # in terms of the sizes
DEPENDENT = 1e-12  # singular values of a step's equations, relative to the largest, that count as zero
ROUNDING = 1e-12  # of a size
NEARLY_SINGULAR = 1e-4  # singular values of the constraints, where Newton's method finds places to half the digits
SAME = 1e-6  # distance in terms of the sizes below which two solutions are one
UNRESOLVED = 4e-3  # the same if one is not isolated: forces of sixth order vanish to rounding errors nearer by
MULTIPLE = 1 / 8  # forces left near a multiple zero, relative to those at this distance
LEAST_STIFFNESS = 1e-7  # relative to the changes of all forces: what is smaller is not decided
UNCERTAIN = 16  # largest errors met, by which a place or a stiffness is uncertain
REPETITIONS = 16  # with other rounding errors each
PERTURBED = 1e-9  # relative error of A that eigenvalues are certain against, to first order
PERTURBED_FAMILY = 1e-6  # the same where Newton's method does not find the place to the last digits
NEARLY_DEFECTIVE = 1e6  # condition of an eigenvalue above which first order decides nothing
EULER_PARAMETERS = 4
PROBES = 5  # random states at which Euler parameters, and divisions by zero, are looked for


class Stability(StrEnum):
    """Verdicts on the stability of an equilibrium."""

    ASYMPTOTIC = translatable("asymptotically stable")
    STABLE = translatable("stable")
    UNSTABLE = translatable("unstable")
    UNDECIDED = translatable("undecided")


@with_attributes
@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A state at rest, with the linear system there."""

    name: str = entry("e1, e2, ...")
    coordinates: Mapping[str, float] = entry("Value of each coordinate, by its name.")
    multipliers: Mapping[str, float] = entry("Value of each multiplier, by its name.")
    stability: Stability = entry("By the second variation of V - T0, or by the eigenvalues.")
    isolated: bool = entry("Whether no others are next to it; false where that is not known.")
    linearization: Linearization
    exact: "Mapping[str, Expr]" = entry(
        "Exact values, if the equations are polynomial and small. CRootOf(f, k) is the k-th root of f.",
        dict,
        type="object",
        additionalProperties={"type": "string"},
    )

    @property
    @computed("Of A, real and imaginary parts, the slowest first.", "eigenvalues", **PAIRS)
    def _eigenvalues(self) -> Vector:
        return self.linearization.eigenvalues


@with_attributes
@dataclass(frozen=True, repr=False, eq=False)
class Equilibria(Documented, Shown):
    """Equilibria that were found: all of them if `complete` is True.

    Examples
    --------
    >>> import holonom
    >>> found = holonom.load("examples/pendulum.mac").equilibria(u=2)
    >>> [(each.coordinates["y"], str(each.stability)) for each in found]
    [(-2.0, 'stable'), (2.0, 'unstable')]
    >>> found.complete
    True
    """

    scene: str = entry("Name that the scene is assigned to.")
    controls: Mapping[str, float] = entry("Values of the controls.")
    rational: Mapping[str, NumberText] = entry(
        "Exact values of the controls that are known to be rational numbers. If others exist, count belongs to their "
        "values in controls, and exact values are left out."
    )
    starts: int = entry("Random starts of Newton's method.", minimum=1)
    found: tuple[Equilibrium, ...] = entry(
        "Those found, of each family that is not isolated one; there may be others unless complete is true."
    )
    more: int = entry("Further solutions of the families of those that are not isolated.", minimum=0)
    singular: int = entry(
        "Starts that led to singular configurations, or where signs change, which are not classified.", minimum=0
    )
    turns: tuple[str, ...] = entry("Coordinates in the equations that whole turns do not change.")
    reversals: tuple[tuple[str, ...], ...] = entry("Euler parameters of each body; both signs are one orientation.")
    count: int | None = entry(
        "Number of real solutions up to turns and signs, with the initial state's orientations, by a Groebner basis "
        "and Hermite's form; null if the equations are not polynomial, too large, or have infinitely many complex "
        "solutions, or if redundant constraints may leave out solutions.",
        minimum=0,
    )

    regular: bool = entry(
        "Whether the constraints are known to have independent gradients wherever they hold; elsewhere, as at cusps, "
        "nothing is looked for."
    )
    orientations: int = entry(
        "Number of expressions whose signs no motion changes; those found have the signs of the initial state.",
        0,
        minimum=0,
    )

    @property
    @computed("Whether those found are all, up to whole turns and signs of Euler parameters.")
    def complete(self) -> bool:
        """True if these are all equilibria, up to turns and signs."""
        return self.regular and len(self.found) == self.count and all(each.isolated for each in self.found)

    def __getitem__(self, name: str) -> Equilibrium:
        """Return the equilibrium of a name, or raise `HolonomError`."""
        for each in self.found:
            if each.name == name:
                return each
        raise HolonomError(ErrorKind.NO_SUCH_EQUILIBRIUM, detail=name)

    def __len__(self) -> int:
        return len(self.found)

    def __iter__(self) -> Iterator[Equilibrium]:
        return iter(self.found)


@one_blas_thread()
def find_equilibria(
    problem: MotionProblem,
    equations: LinearEquations,
    controls: Mapping[str, float],
    starts: int,
    seed: int,
    near: Iterable[Equilibrium] = (),
) -> Equilibria:
    """Search for equilibria.

    Parameters
    ----------
    problem : MotionProblem
        A motion of the scene. The initial states have its nominal sizes.
    equations : LinearEquations
        Of the same scene.
    controls : mapping of str to float
        Constant values. Those missing are of the law at the first time.
    starts : int
        Random starts.
    seed : int
        Of their random numbers.
    near : iterable of Equilibrium
        Further starts.

    Returns
    -------
    Equilibria

    Raises
    ------
    HolonomError
        The equations contain the time, a control has no value, forces jump with the sign of a velocity, a mass is
        negative, or an orientation is zero at a place where the constraints hold.
    """
    reacting = tuple(sign for sign in problem.signs if sign.by is DependsOn.REACTION)
    require_analytic(replace(problem, signs=reacting, tables=()))
    require_laws(problem)
    if equations.changes_with_time:
        raise HolonomError(ErrorKind.NEVER_AT_REST)
    values = _constant_controls(problem, equations, controls)
    search = _Search(problem, equations, list(values.values()))
    search.require_smooth_at_rest()
    same = search.equivalence(np.random.default_rng(seed))
    rational = _rational(problem, equations, controls)
    turns, *reversals = (tuple(equations.coordinates[k] for k in places) for places in (same.turns, *same.reversals))
    turns = tuple(name for name in turns if name in names_used(equations.program))
    solutions = _all_solutions(problem, equations, values | rational, turns, search.orientation.tolist())
    given = [[each.coordinates[name] for name in equations.coordinates] for each in near]
    given += [] if solutions is None else solutions.approximate(equations.coordinates)
    points = search.starts(starts, np.random.default_rng(seed), given)
    found, *left_out = search.equilibria(points, same)
    names = turns, tuple(reversals)
    first = problem.scene, values, {u: str(x) for u, x in rational.items()}, starts
    if solutions is None:
        return Equilibria(*first, found, *left_out, *names, None, False, search.orientation.size)
    if rational.keys() == values.keys():
        found = tuple(replace(each, exact=solutions.exact({**each.coordinates, **each.multipliers})) for each in found)
    count = solutions.count >> len(reversals)
    return Equilibria(*first, found, *left_out, *names, count, solutions.regular, search.orientation.size)


def _all_solutions(
    problem: MotionProblem,
    equations: LinearEquations,
    controls: Mapping[str, float | Fraction],
    turns: Sequence[str],
    orientation: Sequence[int],
) -> "RealSolutions | None":
    from .real_solutions import solve_exactly

    numbers = [Fraction(str(x)) for x in controls.values()]
    return solve_exactly(equations, problem.independent, numbers, turns, orientation)


def _rational(problem: MotionProblem, equations: LinearEquations, given: Mapping[str, float]) -> dict[str, Fraction]:
    """Return the controls whose values are known to be rational.

    Given numbers are those that are written.
    """
    from .real_solutions import rational_controls

    law = {} if given.keys() >= set(equations.controls) else rational_controls(equations, problem.start["t"])
    known = law | {u: Fraction(str(x)) for u, x in given.items()}
    return {u: known[u] for u in equations.controls if u in known}


def _constant_controls(
    problem: MotionProblem, equations: LinearEquations, given: Mapping[str, float]
) -> dict[str, float]:
    for name in given:
        if name not in equations.controls:
            raise HolonomError(ErrorKind.NOT_A_CONTROL, detail=name)
    if given.keys() >= set(equations.controls):
        return {name: float(given[name]) for name in equations.controls}
    law = equations.controls_at(float(problem.start["t"]))[: len(equations.controls)]
    return {name: float(given.get(name, value)) for name, value in zip(equations.controls, law, strict=True)}


class _Search:
    """Newton's method for r = 0, f = 0, in units of the coordinates' sizes."""

    def __init__(self, problem: MotionProblem, equations: LinearEquations, controls: Sequence[float]) -> None:
        self._problem, self._given, self._independent = problem, equations, list(problem.independent)
        self._n = len(equations.coordinates)
        self._t, state = start_of(problem)
        self._first = state[: self._n]
        self._controls = np.concatenate([controls, np.zeros(2 * len(controls))])
        self._nominal = nominal_of(problem)
        self._equations = with_limits(equations, self._somewhere_at_rest(), self._nominal.state)
        self._sizes = self._distances(self._nominal.coordinates)
        self.orientation = np.nan_to_num(self._orientation(self._first)).astype(int)
        for zero in np.flatnonzero(self.orientation == 0)[:1]:
            raise HolonomError(ErrorKind.ORIENTATION_CHANGES, detail=str(zero + 1))

    def _somewhere_at_rest(self) -> list[Point]:
        random = np.random.default_rng(0)
        places = self._first + self._nominal.coordinates * random.normal(size=(PROBES, self._n))
        return [self._point(q, random.normal(size=len(self._given.multipliers))) for q in places]

    def _distances(self, nominal: Vector) -> Vector:
        """Return a distance for each coordinate at which the stiffness changes.

        It is counted from the initial state, and is the nominal size at least, which is small if the motion is slow or
        short. A linear system has no other.
        """
        sizes, unchanged = nominal.copy(), np.arange(self._n)
        for distance in DISTANCES:
            batches = np.array_split(unchanged, -(-len(unchanged) // BATCH) or 1)
            changing = np.concatenate([places[self._changes(places, distance * nominal[places])] for places in batches])
            sizes[changing] = distance * nominal[changing]
            unchanged = np.setdiff1d(unchanged, changing)
        return sizes

    def _changes(self, places: NDArray[np.intp], distances: Vector) -> NDArray[np.bool_]:
        """Return True for coordinates along which the stiffness changes at distances."""
        k = len(places)
        q = np.repeat(self._first[:, None], 2 * k + 1, axis=1)
        q[[*places, *places], np.arange(2 * k)] += np.concatenate([distances, -distances])
        changed = np.zeros(2 * k, dtype=bool)
        with np.errstate(all="ignore"):
            found = self._at(q, np.zeros((len(self._equations.multipliers), 2 * k + 1)))
            for name in ("equation_by_q", "constraint_by_q"):
                there, here = found[name][:, :, :-1], found[name][:, :, -1:]
                one, other, apart = (np.linalg.norm(each, axis=(0, 1)) for each in (here, there, there - here))
                changed |= apart > CHANGED * np.maximum(one, other)
        return changed[:k] | changed[k:]

    @cached_property
    def _start(self) -> Mapping[str, Matrix]:
        return self._at(self._first, np.zeros(len(self._equations.multipliers)))

    @cached_property
    def _gradients(self) -> Vector:
        """Lengths of the constraints' gradients at the initial time."""
        return np.linalg.norm(self._start["constraint_by_q"] * self._sizes, axis=1)

    @cached_property
    def _rank(self) -> int:
        """Return the rank of the constraints' Jacobian.

        If the redundant constraints are not known, it is the rank at the initial time.
        """
        if self._problem.obstruction is None:
            return len(self._independent)
        return self._tangent(self._start, self._first).rank

    def equivalence(self, random: np.random.Generator) -> Equivalence:
        """Return the changes of coordinates that leave a state as it is."""
        bodies = self._normalised(random)
        return Equivalence(whole_turns(self._equations), [e for e in bodies if reversible(self._equations, e)])

    def _normalised(self, random: np.random.Generator) -> list[list[int]]:
        """Return the places of Euler parameters.

        At random states, they have a constraint e . e = 1, and no inertia along e.
        """
        states = [self._first + self._sizes * random.normal(size=self._n) for _ in range(PROBES)]
        multipliers = random.normal(size=len(self._equations.multipliers))
        found = [self._all_constraints(q, multipliers) for q in states]
        slopes = np.array([here["constraint_by_q"] for here in found])  # by state, constraint and coordinate
        places = [np.flatnonzero(slopes[:, beta].any(axis=0)) for beta in range(slopes.shape[1])]
        return [
            e.tolist()
            for beta, e in enumerate(places)
            if len(e) == EULER_PARAMETERS
            and all(
                np.all(slope[beta, e] == 2 * q[e]) and _vanishes(here["equation_by_a"][:, e], q[e])
                for slope, q, here in zip(slopes, states, found, strict=True)
            )
        ]

    def starts(self, count: int, random: np.random.Generator, given: Sequence[Sequence[float]]) -> Matrix:
        """Return starting points, shape (n, k).

        They are the scene's own, random ones around zero and, on the constraints, around it, and the given ones.
        """
        spreads = np.resize(SPREADS, count - 1) * self._sizes[:, None]
        points = spreads * random.normal(size=(self._n, count - 1))
        points[:, 1::2] = self._along_constraints(points[:, 1::2])
        return np.column_stack([self._first, points, *given])

    def _along_constraints(self, ways: Matrix) -> Matrix:
        """Return the ends of k ways along the constraints, shape (n, k).

        They begin at the initial state, go straight ahead and keep its orientations. One ends early where Newton's
        method does not lead from a step back to the constraints.
        """
        sizes, q = self._sizes[:, None], np.repeat(self._first[:, None], ways.shape[1], axis=1)
        ways = self._tangential(q, ways / sizes)
        lengths = np.linalg.norm(ways, axis=0)
        for _ in range(STEPS):
            ways = self._tangential(q, ways)
            ways *= lengths / or_one(np.linalg.norm(ways, axis=0))
            moved, on_them = self._onto_constraints(q + sizes * ways / STEPS)
            oriented = self._is_oriented(moved)
            for k in np.flatnonzero(on_them & ~oriented)[:1]:
                self._require_lasting_orientation(q[:, [k]], moved[:, [k]])
            q = np.where(on_them & oriented, moved, q)
        return q

    def _onto_constraints(self, q: Matrix) -> tuple[Matrix, NDArray[np.bool_]]:
        """Return k places, brought onto the constraints, and whether they are there."""
        with np.errstate(all="ignore"):
            for _ in range(CORRECTIONS):
                J, residuals = self._scaled_constraints(q)
                change = np.matvec(np.linalg.pinv(J, rcond=DEPENDENT), residuals).T
                q = q - self._sizes[:, None] * change
        return q, np.max(np.abs(change), axis=0, initial=0.0) <= SAME

    def _require_lasting_orientation(self, one: Vector, other: Vector) -> None:
        """Reject an orientation that changes between two places on the constraints.

        The interval between them is halved. Where Newton's method leads elsewhere, nothing is known.
        """
        for _ in range(HALVINGS):
            middle, on_them = self._onto_constraints((one + other) / 2)
            if not on_them:
                return
            one, other = (middle, other) if self._is_oriented(middle) else (one, middle)
        if np.max(np.abs(one - other) / self._sizes[:, None]) <= SAME:
            changed = np.flatnonzero(self._orientation(other)[:, 0] != self.orientation)[0]
            raise HolonomError(ErrorKind.ORIENTATION_CHANGES, detail=str(changed + 1))

    def _tangential(self, q: Matrix, ways: Matrix) -> Matrix:
        """Return the parts of k ways along the constraints, all in terms of sizes."""
        J, _ = self._scaled_constraints(q)
        across = np.matvec(np.linalg.pinv(J, rcond=DEPENDENT), np.matvec(J, ways.T))
        return ways - across.T

    def _scaled_constraints(self, q: Matrix) -> tuple[Matrix, Matrix]:
        """Return J, in the coordinates' sizes, and f at k places.

        Their shapes are (k, g, n) and (k, g). Where they have no value, J is zero and f is nan.
        """
        here = self._at(q, np.zeros((len(self._equations.multipliers), q.shape[1])))
        J, residuals = (np.moveaxis(here[name], -1, 0) for name in ("constraint_by_q", "constraint"))
        known = np.isfinite(J).all(axis=(1, 2)) & np.isfinite(residuals).all(axis=1)
        return np.where(known[:, None, None], J * self._sizes, 0.0), np.where(known[:, None], residuals, np.nan)

    def equilibria(self, starts: Matrix, same: Equivalence) -> tuple[tuple[Equilibrium, ...], int, int]:
        """Return the equilibria that Newton's method finds, and the number left out.

        Those left out are further ones of families, and singular ones.

        Solutions that are not isolated, with the same multipliers and stiffnesses, count as one family.
        """
        known: list[_Solution] = []
        more, places = self._collect(starts, same, known)
        alternatives: dict[tuple[int, ...], list[Vector]] = {tuple(self._independent): []}
        for q in places:
            alternatives.setdefault(self._most_independent(q), []).append(q)
        singular = len(alternatives.pop(tuple(self._independent)))
        for chosen, near in alternatives.items():
            further, places = self._by(chosen)._collect(np.column_stack(near), same, known)
            more, singular = more + further, singular + len(places)
        known.sort(key=lambda each: tuple(np.round(each.q / self._sizes, 6)))
        return tuple(self._equilibrium(f"e{k}", each) for k, each in enumerate(known, start=1)), more, singular

    def _collect(self, starts: Matrix, same: Equivalence, known: "list[_Solution]") -> tuple[int, list[Vector]]:
        """Add the equilibria found from the starts.

        Return the number of further ones of families, and singular ones.
        """
        more, singular = 0, []
        for q, multipliers in filter(self._satisfies_all_constraints, self._solved(starts)):
            if not self._is_oriented(q):
                continue
            q = self._zeroed(same.chosen(q))
            if any(self._close(q, other.q, same) for other in known):
                continue
            known_multipliers = np.abs(multipliers) > self._uncertainty(q, multipliers, self._rough(q, multipliers))
            multipliers = np.where(known_multipliers, multipliers, 0.0)
            stiffness = self._stiffness(q, multipliers) if self._is_smooth(q) else None
            if stiffness is None:
                singular.append(q)
                continue
            found = _Solution(self._problem, q, multipliers, *stiffness)
            if not found.isolated and not self._is_zero_nearby(found):
                continue
            if (place := self._unresolved(found, known, same)) is not None:
                known[place] = found if known[place].isolated else known[place]
                continue
            if any(found.same_family(other) for other in known):
                more += 1
            else:
                known.append(found)
        return more, singular

    def _is_oriented(self, q: Matrix) -> NDArray[np.bool_]:
        """Return True for places with the signs of the initial state."""
        return np.all(self.orientation == self._orientation(q).T, axis=-1)

    def _orientation(self, q: Vector) -> Vector:
        """Return the signs that no motion changes, nan where one has no value."""
        return np.sign(self._equations.orientation(self._point(q, np.zeros(len(self._equations.multipliers)))))

    def require_smooth_at_rest(self) -> None:
        """Reject forces that jump with the sign of a velocity, as dry friction does."""
        switching = [sign for sign in self._problem.signs if sign.by is not DependsOn.CONFIGURATION]
        if switching and not self._is_smooth(self._first):
            raise HolonomError(ErrorKind.NOT_ANALYTIC, self._problem.scene, switching[0].of)

    def _is_smooth(self, q: Vector) -> bool:
        point = self._point(q, np.zeros(len(self._equations.multipliers)))
        return is_smooth(self._given, point, self._nominal.state)

    def _most_independent(self, q: Vector) -> tuple[int, ...]:
        """Return the most independent constraints at a place, if some are redundant."""
        if len(self._independent) == len(self._equations.multipliers) or self._equations.servo:
            return tuple(self._independent)
        J = self._all_constraints(q, np.zeros(len(self._equations.multipliers)))["constraint_by_q"] * self._sizes
        order = scipy.linalg.qr((J / or_one(np.linalg.norm(J, axis=1))[:, None]).T, mode="r", pivoting=True)[1]
        return tuple(sorted(map(int, order[: len(self._independent)])))

    def _by(self, independent: Sequence[int]) -> "_Search":
        """Return the search by other independent constraints.

        The motion program, which solves for other multipliers, is not evaluated.
        """
        multipliers = self._problem.multipliers
        others = tuple(each for beta, each in enumerate(multipliers) if beta not in independent)
        problem = replace(self._problem, motion=replace(self._problem.motion, redundant=others))
        return _Search(problem, self._given, self._controls[: len(self._equations.controls)])

    def _satisfies_all_constraints(self, solution: tuple[Vector, Vector]) -> bool:
        """Return True if all constraints hold.

        Near the initial state some follow from the others. Elsewhere they may not.
        """
        here = self._all_constraints(*solution)
        changes = np.maximum(self._first_changes, np.abs(here["constraint_by_q"]) @ self._sizes)
        return bool(np.all(np.abs(here["constraint"]) <= SAME * or_one(changes)))

    @cached_property
    def _first_changes(self) -> Vector:
        """Changes of all constraints within the nominal sizes at the initial time."""
        here = self._all_constraints(self._first, np.zeros(len(self._equations.multipliers)))
        return np.abs(here["constraint_by_q"]) @ self._sizes

    def _all_constraints(self, q: Vector, multipliers: Vector) -> Mapping[str, Matrix]:
        return self._equations.at(self._point(q, multipliers), range(len(multipliers)))

    def _equilibrium(self, name: str, found: "_Solution") -> Equilibrium:
        point = self._point(found.q, found.multipliers)
        here, tangent = tangent_at(found.problem, self._given, point)
        linear = linearization_of(found.problem, self._given, point, None, here, tangent)
        return Equilibrium(
            name,
            dict(zip(self._equations.coordinates, map(float, found.q), strict=True)),
            dict(zip(self._equations.multipliers, map(float, found.multipliers), strict=True)),
            _stability(found, linear.A, _norm_of_terms(here["equation_by_v"], tangent.basis), self._equations),
            found.isolated,
            linear,
        )

    def _stiffness(self, q: Vector, multipliers: Vector) -> tuple[Matrix, float, float] | None:
        """Return the change of the forces along the manifold, its bound and its error.

        Its shape is (m, m). None in a singular configuration, or where the forces or their changes have no value.

        For forces with a potential it is the second variation.
        """
        here = self._with_limits_at(q, multipliers)
        if not all(np.isfinite(each).all() for name, each in here.items() if not name.startswith("output")):
            return None
        try:
            tangent = self._tangent(here, q)
        except HolonomError as error:
            if error.kind is ErrorKind.MASS_INDEFINITE:
                raise
            return None
        gradients = np.linalg.norm(here["constraint_by_q"] * self._sizes, axis=1)
        shrunk = np.any(gradients < NEARLY_SINGULAR * self._gradients)
        if shrunk or tangent.rank < self._rank or tangent.least < NEARLY_SINGULAR:
            return None
        changes = here["equation_by_q"]
        stiffness = tangent.basis.T @ changes @ tangent.basis
        bound = _norm_of_terms(changes, tangent.basis)
        return stiffness, bound, self._error(q, multipliers, tangent, stiffness)

    def _tangent(self, here: Mapping[str, Matrix], q: Vector) -> Tangent:
        mass = here["equation_by_a"]
        point = self._point(q, np.zeros(len(self._equations.multipliers)))
        return Tangent(mass, here["constraint_by_q"], self._equations.masses_near(point, mass))

    def _with_limits_at(self, q: Vector, multipliers: Vector) -> Mapping[str, Matrix]:
        point, equations = self._point(q, multipliers), self._equations
        if equations is not self._given:
            equations = with_limits(self._given, [point], self._nominal.state)
        return equations.at(point, self._independent)

    def _error(self, q: Vector, multipliers: Vector, tangent: Tangent, stiffness: Matrix) -> float:
        """Return the error of the stiffness.

        It is the change within the uncertainty of the place, and rounding errors.

        By Kantorovich's theorem a solution is near if the stiffness changes little within Newton's step. At a multiple
        solution, also one by rounding errors, it changes more than it is.
        """
        if not stiffness.size:
            return 0.0
        basis = tangent.basis
        rows, values, columns = np.linalg.svd(stiffness)
        directions = basis @ columns.T
        lengths = np.max(np.abs(directions) / self._sizes_at(q)[:, None], axis=0)
        rough = self._rough(q, multipliers)
        changes = np.moveaxis(rough["equation_by_q"], -1, 0)
        off = np.einsum("kij,jk->ik", changes, tangent.shortest(rough["constraint"]))
        forces = np.max(np.abs(rows.T @ basis.T @ (rough["equation"] - off)), axis=1)
        steps = np.minimum(UNCERTAIN * forces / or_one(values), UNRESOLVED / lengths)
        moved = np.concatenate([directions * steps, -directions * steps], axis=1)
        straight = basis.T @ self._near(q, multipliers, moved, "equation_by_q") @ basis
        far = np.tile(steps * lengths > BALANCED, 2)  # where the manifold may be curved
        curved = [self._stiffness_beside(q + step, multipliers, tangent) for step in moved[:, far].T]
        both = ([*straight, *curved], basis.T @ changes @ basis)
        moving, rounding = (max(np.linalg.norm(each - stiffness, 2) for each in some) for some in both)
        moved = multipliers[:, None] + np.diag(self._uncertainty(q, multipliers, rough))
        reacting = self._at(np.repeat(q[:, None], len(moved), axis=1), moved)["equation_by_q"]
        changed = np.linalg.norm(basis.T @ np.moveaxis(reacting, -1, 0) @ basis - stiffness, 2, axis=(1, 2))
        return float(moving + UNCERTAIN * rounding + changed.sum())

    def _rough(self, q: Vector, multipliers: Vector) -> Mapping[str, Matrix]:
        """Return arrays of the equations with random rounding errors."""
        many = (np.repeat(each[:, None], REPETITIONS, axis=1) for each in (q, multipliers))
        return self._equations.at(self._point(*many), self._independent, np.random.default_rng(0))

    def _uncertainty(self, q: Vector, multipliers: Vector, rough: Mapping[str, Matrix]) -> Vector:
        """Return the errors of the multipliers, by a Newton step.

        That of a multiplier that is rounding alone is as large as it is.
        """
        J, found = self._at(q, multipliers)["constraint_by_q"] * self._sizes, np.zeros_like(multipliers)
        if np.isfinite(J).all() and np.isfinite(rough["equation"]).all():
            steps, *_ = np.linalg.lstsq(J.T, self._sizes[:, None] * rough["equation"])
            found[self._independent] = UNCERTAIN * np.max(np.abs(steps), axis=1)
        return found

    def _stiffness_beside(self, q: Vector, multipliers: Vector, tangent: Tangent) -> Matrix:
        """Return the stiffness on the manifold near a place, infinite where there is none."""
        q = q - tangent.shortest(self._near(q, multipliers, np.zeros((len(q), 1)), "constraint").T)[:, 0]
        here, multipliers = self._at(q, multipliers), multipliers.copy()
        J, unbalanced = here["constraint_by_q"], here["equation"]
        try:
            multipliers[self._independent] += np.linalg.lstsq((J * self._sizes).T, self._sizes * unbalanced)[0]
            basis = self._tangent(here, q).next_to(tangent.basis).basis
            return basis.T @ self._at(q, multipliers)["equation_by_q"] @ basis
        except (HolonomError, ValueError):  # of matrices that are singular, or no numbers
            return np.full([tangent.basis.shape[1]] * 2, np.inf)

    def _is_zero_nearby(self, found: "_Solution") -> bool:
        """Return True if forces in directions without stiffness vanish nearby.

        Newton's method does not see these directions. Far away, forces may be small and nowhere zero. Near a multiple
        zero they are much smaller than at a distance.
        """
        here = self._at(found.q, found.multipliers)
        basis = self._tangent(here, found.q).basis
        rows, values, columns = np.linalg.svd(found.stiffness)
        flat = values <= found.least
        directions, pushed = basis @ columns.T[:, flat], basis @ rows[:, flat]
        directions *= UNRESOLVED / np.max(np.abs(directions) / self._sizes_at(found.q)[:, None], axis=0)
        moved = np.concatenate([np.zeros_like(directions), directions, -directions], axis=1)
        forces = np.abs(self._near(found.q, found.multipliers, moved, "equation") @ pushed).reshape(3, flat.sum(), -1)
        left, *apart = np.diagonal(forces, axis1=1, axis2=2)
        met = np.abs(here["equation_by_q"]) @ (np.abs(found.q) + self._sizes)
        rounding = UNCERTAIN * np.finfo(float).eps * np.abs(pushed).T @ met
        return bool(np.all(left <= np.maximum(MULTIPLE * np.max(apart, axis=0), rounding)))

    def _near(self, q: Vector, multipliers: Vector, moved: Matrix, name: str) -> Matrix:
        """Return an array of the equations at k places near q, shape (k, ...).

        It is zero where it has no value.
        """
        with np.errstate(all="ignore"):
            found = self._at(q[:, None] + moved, np.outer(multipliers, np.ones(moved.shape[1])))[name]
        return np.nan_to_num(np.moveaxis(found, -1, 0), nan=0.0, posinf=0.0, neginf=0.0)

    def _solved(self, q: Matrix) -> Iterator[tuple[Vector, Vector]]:
        """Return solutions by Newton's method from k starting points, shape (n, k).

        They have the order of the starting points.
        """
        multipliers = self._balancing(q)
        left, solved = np.arange(q.shape[1]), np.zeros(q.shape[1], dtype=bool)
        with np.errstate(all="ignore"):
            for _ in range(ITERATIONS):
                steps, size, unbalanced = self._newton(q[:, left], multipliers[:, left])
                q[:, left] += steps[: self._n]
                multipliers[np.ix_(self._independent, left)] += steps[self._n :]
                solved[left] = (size <= CONVERGED) & (unbalanced <= BALANCED)
                left = left[~solved[left] & np.isfinite(size)]
                if not left.size:
                    break
        for place in np.flatnonzero(solved):
            yield self._zeroed(q[:, place]), multipliers[:, place]

    def _balancing(self, q: Matrix) -> Matrix:
        """Return multipliers for k points, shape (g, k).

        At half of the points they balance the forces best, at the others they are zero.

        Newton's method goes to stable equilibria from the former, to others from the latter.
        """
        multipliers = np.zeros((len(self._equations.multipliers), q.shape[1]))
        with np.errstate(all="ignore"):
            here = self._at(q, multipliers)
        J = self._sizes * np.moveaxis(here["constraint_by_q"], -1, 0)
        forces = self._sizes * here["equation"].T
        for k in np.flatnonzero(np.arange(q.shape[1]) % 4 < 2):
            if np.isfinite(J[k]).all() and np.isfinite(forces[k]).all():
                multipliers[self._independent, k] = np.linalg.lstsq(J[k].T, forces[k], rcond=None)[0]
        return multipliers

    def _newton(self, q: Matrix, multipliers: Matrix) -> tuple[Matrix, Vector, Vector]:
        """Return Newton steps of k points, shape (n + g, k), their sizes and residuals.

        Sizes are in units of nominal sizes.
        """
        here, k = self._at(q, multipliers), q.shape[1]
        J, K = (np.moveaxis(here[name], -1, 0) for name in ("constraint_by_q", "equation_by_q"))
        g, n = J.shape[1], self._n
        rows = or_one(np.linalg.norm(J * self._sizes, axis=2))
        unit = or_one(np.max(self._sizes * np.linalg.norm(K * self._sizes, axis=2), axis=1, initial=0.0))[:, None]
        weights = np.concatenate([self._sizes / unit, 1 / rows], axis=1)
        scale = np.concatenate([np.broadcast_to(self._sizes, (k, n)), unit / rows], axis=1)
        matrix = np.block([[K, -np.swapaxes(J, 1, 2)], [J, np.zeros((k, g, g))]])
        matrix = weights[:, :, None] * matrix * scale[:, None, :]
        out_of_balance = weights * np.concatenate([here["equation"], here["constraint"]]).T
        finite = np.isfinite(matrix).all(axis=(1, 2)) & np.isfinite([*out_of_balance.T, *unit.T]).all(axis=0)
        step = np.full((k, n + g), np.nan)
        inverse = np.linalg.pinv(matrix[finite], rcond=DEPENDENT)
        step[finite] = -np.einsum("kij,kj->ki", inverse, out_of_balance[finite])
        size = np.max(np.abs(step[:, :n]), axis=1, initial=0.0)
        step *= scale * np.minimum(1.0, LONGEST_STEP / or_one(size))[:, None]
        return step.T, np.where(finite, size, np.nan), np.max(np.abs(out_of_balance), axis=1, initial=0.0)

    def _zeroed(self, q: Vector) -> Vector:
        """Set entries at the level of rounding errors to zero."""
        return np.where(np.abs(q) <= ROUNDING * self._sizes, 0.0, q)

    def _unresolved(self, found: "_Solution", known: Sequence["_Solution"], same: Equivalence) -> int | None:
        """Return the index of a known solution nearby, if one of both is not isolated."""
        for place, other in enumerate(known):
            if not (found.isolated and other.isolated) and self._close(found.q, other.q, same, UNRESOLVED):
                return place
        return None

    def _close(self, one: Vector, other: Vector, same: Equivalence, distance: float = SAME) -> bool:
        return bool(np.all(np.abs(same.apart(one, other)) <= distance * self._sizes_at(one, other)))

    def _sizes_at(self, *places: Vector) -> Vector:
        return np.max(np.abs([self._sizes, *places]), axis=0)

    def _at(self, q: Vector, multipliers: Vector) -> Mapping[str, Matrix]:
        return self._equations.at(self._point(q, multipliers), self._independent)

    def _point(self, q: Vector, multipliers: Vector) -> Point:
        zeros = np.zeros_like(q)
        controls = np.repeat(self._controls[:, None], q[0].size, axis=1).reshape(len(self._controls), *q.shape[1:])
        return Point(self._t, np.concatenate([q, zeros]), zeros, multipliers, controls)


class _Solution(NamedTuple):
    problem: MotionProblem  # with the independent constraints whose multipliers are given
    q: Vector
    multipliers: Vector
    stiffness: Matrix
    bound: float  # of the stiffness: that of the changes of all forces, which may cancel along the manifold
    error: float  # of the stiffness, by the uncertainty of the place

    @property
    def least(self) -> float:
        """Stiffness that counts as positive."""
        return max(LEAST_STIFFNESS * self.bound, self.error)

    @property
    def _principal(self) -> Vector:
        return np.linalg.svd(self.stiffness, compute_uv=False)

    @property
    def _invariants(self) -> Vector:
        return np.concatenate([self._principal, np.linalg.eigvalsh((self.stiffness + self.stiffness.T) / 2)])

    @property
    def isolated(self) -> bool:
        return bool(self._principal.min(initial=np.inf) > self.least)

    def same_family(self, other: "_Solution") -> bool:
        """Return True if neither is isolated and multipliers and stiffnesses agree.

        The stiffnesses are the principal ones, and those of the symmetric part with their signs.
        """
        apart = np.max(np.abs(self._invariants - other._invariants), initial=0.0)
        alike = _same(self.multipliers, other.multipliers) and apart <= SAME * max(self.bound, other.bound)
        return bool(alike and not self.isolated and not other.isolated)


def _vanishes(matrix: Matrix, vector: Vector) -> bool:
    """Return True if the product is zero to rounding errors."""
    return bool(np.all(np.abs(matrix @ vector) <= ROUNDING * np.abs(matrix) @ np.abs(vector)))


def _same(one: Vector, other: Vector) -> bool:
    return bool(np.all(np.abs(one - other) <= SAME * np.max(np.abs([one, other]), initial=0.0)))


def _norm_of_terms(matrix: Matrix, basis: Matrix) -> float:
    """Return the norm that a matrix has along a basis if no terms cancel."""
    terms = np.abs(basis).T @ np.abs(matrix) @ np.abs(basis)
    return float(np.linalg.norm(terms, 2)) if terms.size else 0.0


def _stability(found: _Solution, A: Matrix, damping: float, equations: LinearEquations) -> Stability:
    """Decide the stability by the eigenvalues of A or the second variation.

    The damping is that of all forces, which may cancel along the manifold.
    """
    perturbed = PERTURBED if found.isolated else PERTURBED_FAMILY
    m, entries = len(found.stiffness), np.zeros_like(A)
    entries[m:, :m], entries[m:, m:] = found.error, perturbed * damping
    parts, certain = certain_distances(A, perturbed, np.real, entries)
    if len(A) and np.all(certain & (parts < 0)):
        return Stability.ASYMPTOTIC
    minimum = np.all(np.linalg.eigvalsh((found.stiffness + found.stiffness.T) / 2) > found.least)
    if minimum and equations.energy is not EnergyChange.OPEN:
        return Stability.STABLE
    if equations.energy is EnergyChange.CONSERVED and equations.linear and _swings(A, entries):
        return Stability.STABLE
    return Stability.UNSTABLE if np.any(certain & (parts > 0)) else Stability.UNDECIDED


def _swings(A: Matrix, entries: Matrix) -> bool:
    """Return True if a linear conservative system has simple imaginary eigenvalues.

    They are symmetric about the imaginary axis. One that may lie on it lies on it, if there is no other nearby.
    """
    values, moved, conditions = perturbed_eigenvalues(A, PERTURBED, entries)
    apart = np.abs(values[:, None] - values) + np.diag(np.full(len(values), np.inf))
    simple = np.all(apart > 2 * (moved[:, None] + moved)) and np.all(conditions < NEARLY_DEFECTIVE)
    return bool(simple and np.all(np.abs(values.real) <= moved))


def certain_distances(
    A: Matrix, error: float, distance: Callable[[Vector], Vector], entries: Matrix | float = 0.0
) -> tuple[Vector, np.ndarray]:
    """Return signed distances of eigenvalues, and True for those with certain signs.

    They are distances from a line or a circle. The sign is certain if it holds under the errors of A.

    Parameters
    ----------
    A : ndarray, shape (s, s)
    error : float
        Relative.
    distance : callable
        Of the eigenvalues, complex, shape (s,). With a slope of at most one.
    entries : float or ndarray, shape (s, s)
        Further errors of the entries of A, absolute.

    Returns
    -------
    distances : ndarray, shape (s,)
    certain : ndarray of bool, shape (s,)
    """
    values, moved, conditions = perturbed_eigenvalues(A, error, entries)
    distances = distance(values)
    return distances, (np.abs(distances) > moved) & (conditions < NEARLY_DEFECTIVE)
