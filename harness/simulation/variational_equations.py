"""Variational equations of a motion, with the equations of the motion itself.

With the state x = (q, dot q), dx/dt = F(t, x, p) and X = dx/dp,

    dX/dt = F_x X + F_p.

They are linear, so each column of X may be integrated in a unit of its own, with F_p in the same unit. State and time
are integrated in units near their nominal sizes.
"""

from collections.abc import Sequence

import numpy as np

from ..language import translatable
from ..program.differentiation import along, derivative_name, differentiated, solution_differentiated
from ..program.heyoka_function import heyoka_expressions, import_heyoka
from ..program.motion_problem import MotionProblem
from ..program.motion_program import Name, Program
from ..program.rewriting import computing
from .constraints.directions import or_one
from .constraints.factorization import factored_constraints
from .constraints.stabilization import Equations
from .engines.scaled_time import in_unit, units_near
from .evaluation import Numbers
from .initial_tangents import ConstraintVariation
from .inputs import Inputs, heyoka_inputs
from .matrices import MotionMatrices, start_of
from .nominal import Nominal
from .variation import Variation, no_sensitivity, size_of

PROBES = 3  # random states near the initial one, at which a parameter may have an effect
NO_MOVE = 1e-6  # of the state, by a direction of nominal size: smaller derivatives may be rounding errors of it
GROWTH = 1024  # digits of derivatives are lost in proportion to it, and parts of a motion halved by its logarithm


class VariationalEquations:
    """The equations of a motion and of its derivatives.

    Parameters
    ----------
    problem : MotionProblem
        Without signs.
    directions : sequence of str
        Parameters, by their `size_of`. Coordinates and velocities, for their initial values.
    matrices : MotionMatrices
        Of the same motion.

    Raises
    ------
    HolonomError
        No motion program solves the equations, or it contains the value of a direction.
    """

    def __init__(self, problem: MotionProblem, directions: Sequence[str], matrices: MotionMatrices) -> None:
        if problem.obstruction is not None:
            raise no_sensitivity(problem.obstruction)
        if closed := [name for name in directions if name not in (*problem.parameters, *problem.state)]:
            raise no_sensitivity(translatable("the equations are made for one value of %(name)s", name=closed[0]))
        self.problem, self.directions, self.kind = problem, tuple(directions), ("variational", *directions)
        self._matrices, self.inputs = matrices, Inputs(problem)
        self.units = Nominal(*map(units_near, matrices.nominal))
        self.constraints = ConstraintVariation(problem, self.directions)
        parameters = [name for name in self.directions if name in problem.parameters]
        self._seeds = {name: derivative_name(name, name) for name in parameters}
        self._sizes = np.array([float(size_of(problem, name)) for name in parameters])
        self._places = [self.directions.index(name) for name in parameters]
        least = {name: 1 / size for name, size in zip(problem.state, self.units.state, strict=True)}
        least |= self._moved_by_one([name for name in parameters if not problem.values.get(name)])
        self._least = np.array([least.get(name, 1.0) for name in self.directions])
        self.program = problem.once(self.kind, problem.motion, self._differentiated)

    def _moved_by_one(self, names: Sequence[str]) -> dict[str, float]:
        """Return velocities, in `units`, that a parameter of one makes in a unit of time.

        Parameters of value zero do not show their size. Those without an effect at some states are left out.
        """
        if not names:
            return {}
        problem, units, (t, state) = self.problem, self.units, start_of(self.problem)
        drawn = np.random.default_rng(0).uniform(-1, 1, (len(state) + 1, PROBES))
        times, states = t + units.time * np.abs(drawn[0]), state[:, None] + units.state[:, None] * drawn[1:]
        rates = Variation(problem, problem.motion, problem.accelerations, names)
        moves = rates(times, states, np.zeros((len(state), len(names), len(times))))
        moves = np.abs(moves) * (units.time / units.velocities)[:, None, None]
        found = np.max(np.where(np.isfinite(moves), moves, 0.0), axis=(0, 2))
        return {name: float(move) for name, move in zip(names, found, strict=True) if move > 0}

    def _differentiated(self) -> Program:
        """Return the accelerations and their derivatives, in the fewest operations."""
        own = {name: {name: Name(seed)} for name, seed in self._seeds.items()}
        problem, seeds = self.problem, along(self.problem.state, self.directions) | own
        plain = differentiated(computing(problem.motion, problem.accelerations), seeds)
        if problem.response is None:
            return plain
        solved = solution_differentiated(problem.response, problem.matrices, seeds)
        return min(plain, computing(solved, plain.outputs), key=lambda each: each.operations)

    def equations(self) -> Equations:
        """Return heyoka's equations of the state and its derivatives.

        Returns
        -------
        list of (expression, expression)
            Variable and time derivative: the state, then each row of X, all in `units`.
        """
        heyoka, problem, n = import_heyoka(), self.problem, len(self.problem.coordinates)
        sizes = dict(zip(problem.state, map(float, self.units.state), strict=True))
        given, count = heyoka_inputs(problem), len(problem.open_inputs)
        seeds = {name: heyoka.par[count + place] for place, name in enumerate(self._seeds.values())}
        sizes |= {derivative_name(name, k): sizes[name] for name in problem.state for k in self.directions}
        variables = {name: given.get(name, heyoka.expression(name)) for name in sizes}
        moving = {name: sizes[name] * variable for name, variable in variables.items()}
        found = heyoka_expressions(self.program, given | moving | seeds)
        rates = [moving[name] for name in problem.state[n:]] + [found[name] for name in problem.accelerations]
        rates += [moving[derivative_name(v, k)] for v in problem.state[n:] for k in self.directions]
        rates += [found[derivative_name(name, k)] for name in problem.accelerations for k in self.directions]
        scaled = [(variables[name], rate / sizes[name]) for name, rate in zip(variables, rates, strict=True)]
        return in_unit(scaled, float(self.units.time))

    def values(self, t: float, units: Numbers) -> Numbers:
        """Return heyoka's parameters from a time on.

        Parameters
        ----------
        t : float
            The time.
        units : ndarray, shape (p,)
            Unit of each column of X, in terms of that of each row.

        Returns
        -------
        ndarray
            Open inputs, then derivatives of the parameters by themselves.
        """
        return np.concatenate([self.inputs.open_values(t, "right"), self._sizes / units[self._places]])

    def columns(self, state: Numbers, moves: Numbers) -> Numbers:
        """Return units in which derivatives are smaller than the state.

        Then the state decides about steps. They may grow by `GROWTH` until they are as large.

        Parameters
        ----------
        state : ndarray, shape (2n,)
            Coordinates, then velocities, in `units`.
        moves : ndarray, shape (2n, p)
            X, its rows in `units`.

        Returns
        -------
        ndarray, shape (p,)
            Powers of two, not below those of the directions.
        """
        ratio = GROWTH * np.max(np.abs(moves), axis=0) / largest(state)
        return 2.0 ** np.ceil(np.log2(np.maximum(ratio, self._least)))

    def defect(self, t: float, state: Numbers, moves: Numbers) -> float:
        """Return the relative defect of X in the constraints' derivatives.

        It is relative to their terms. Redundant constraints are among them: X leaves these where others that the
        program solves become dependent.

        Parameters
        ----------
        t : float
            Time of the state.
        state : ndarray, shape (2n,)
            Coordinates, then velocities.
        moves : ndarray, shape (2n, p)
            X.

        Returns
        -------
        float
        """
        if not self.problem.multipliers:
            return 0.0
        jacobian, sizes = np.abs(self._matrices(t, state).jacobian), self.units.state[:, None]
        least = NO_MOVE * largest(state / self.units.state)
        farthest = np.maximum(least, np.max(np.abs(moves) / sizes, axis=0))
        moving = np.split(sizes * farthest, 2)  # if all values move as far as one does
        missed = np.abs(self.constraints(t, state, moves))
        return float(np.max(missed / or_one(jacobian @ np.array(moving) + missed), initial=0.0))

    def corrected(self, t: float, state: Numbers, moves: Numbers) -> Numbers:
        """Return the nearest derivatives in the mass metric that satisfy the constraints.

        Parameters
        ----------
        t : float
            Time of the state.
        state : ndarray, shape (2n,)
            Coordinates, then velocities.
        moves : ndarray, shape (2n, p)
            X.

        Returns
        -------
        ndarray, shape (2n, p)
        """
        n, moves = len(self.problem.coordinates), moves.copy()
        if not self.problem.multipliers:
            return moves
        here = self._matrices.independent(t, state)
        factors, independent = factored_constraints(here.mass, here.jacobian), list(self.problem.independent)
        for half in (0, 1):
            missed = self.constraints(t, state, moves)[half][independent]
            moves[half * n :][:n] += np.array([factors.correction(column) for column in missed.T]).T
        return moves


def largest(*states: Numbers) -> float:
    """Return the size of states that derivatives in their units are compared with.

    Parameters
    ----------
    *states : ndarray, shape (2n,)
        Coordinates, then velocities, in units near their sizes.

    Returns
    -------
    float
        Not below one.
    """
    return max(1.0, *(float(np.max(np.abs(state))) for state in states))
