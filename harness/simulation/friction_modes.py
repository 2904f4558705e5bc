"""Modes of friction at a state, and which of them the accelerations agree with.

At a zero of a switching function its sign is 1, -1, or lets the motion slide. In each mode the amounts of friction
satisfy linear equations (`harness/program/friction.py`). A mode agrees if a sliding amount is at most as large as its
size, if drives lead to the side of the sign, and if multipliers have the signs that forces contain.

The accelerations are unique if one solution agrees. They remain so while the determinants of all modes are positive:
a piecewise linear map whose parts have determinants of one sign is proper, and its degree, the number of solutions, is
the same for all right sides and under continuous changes (Scholtes, Introduction to Piecewise Differentiable Equations,
chapter 2).

Switching surfaces that depend on each other have no unique amounts. If all zeros do, one acceleration decides. The
contacts stick unless all of them slip to the same side with accelerations to it.
"""

from collections.abc import Collection, Sequence
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np

from ..program.differentiation import derivative_name
from ..program.friction import (
    SLIDING,
    STUCK,
    Pattern,
    affine_terms,
    curved_forces,
    slides,
    sticking,
    unknown_amounts,
)
from ..program.motion_problem import DependsOn, MotionProblem
from ..program.motion_program import Program
from ..program.precision import Precision
from .evaluation import Numbers, as_floats, evaluation, zeros
from .matrices import Vector
from .zeros import ZERO

SAME = 1e-9  # of their sizes: a difference that rounding may make
DRAWN = 8  # points more than an affine function has numbers, at which forces are compared with one
SINGULAR = 1e12  # condition number of equations without a unique solution


class Solution(NamedTuple):
    """A mode that agrees with its solution."""

    pattern: Pattern
    drives: Vector  # of the zeros, then the amounts of the others
    amounts: Vector  # zero where they have no effect
    sizes: Vector  # of the largest terms of drives, then of the sizes of amounts
    used: float  # the largest share that a sliding amount has of its size

    def accelerates_as(self, other: "Solution") -> bool:
        """Return True if the drives are those of another solution.

        Parameters
        ----------
        other : Solution

        Returns
        -------
        bool
        """
        return _close(self.drives, other.drives, self.sizes[: len(self.drives)])

    def is_shared_as(self, other: "Solution") -> bool:
        """Return True if the amounts of friction are those of another solution.

        Parameters
        ----------
        other : Solution

        Returns
        -------
        bool
        """
        return _close(self.amounts, other.amounts, self.sizes[len(self.drives) :])


class Terms(NamedTuple):
    """Affine terms at k states.

    Each has shape (quantities, amounts + 1, k): slopes, then the constant.
    """

    drives: Numbers
    sizes: Numbers
    reactions: Numbers
    regular: Numbers  # shape (k,)


class FrictionModes:
    """All modes at zeros of switching functions.

    Parameters
    ----------
    problem : MotionProblem
        A motion with signs.
    pattern : Pattern
        The values of the other signs.
    zeros : collection of str
        Signs with drives whose switching functions vanish.
    precision : Precision
        Numbers of the inputs.
    dependent : bool
        True if the zeros depend on one of them.
    """

    def __init__(
        self,
        problem: MotionProblem,
        pattern: Pattern,
        zeros: Collection[str],
        precision: Precision,
        dependent: bool = False,
    ) -> None:
        self._places, self._pattern, self._precision = problem.places, pattern, precision
        self._zeros = [name for name in self._places if name in zeros]
        self.rough = [name for name in self._zeros if not slides(problem, name)]
        self._dependent = dependent
        self._reactions = [sign.name for sign in problem.signs if sign.by is DependsOn.REACTION]
        terms = self._affine_terms(problem)
        if terms is None:
            self.rough = list(self._zeros)
            terms = self._affine_terms(problem)
        self._outputs = list(terms.outputs)
        inputs = *(name for name in terms.inputs if name not in self._tried), *self._tried
        self._function = evaluation(replace(terms, inputs=inputs), precision)
        curved = curved_forces(problem, pattern, set(self._zeros) - set(self.rough))
        self._forces, self._curved = (None, []) if curved is None else (evaluation(curved[0], precision), curved[1])

    def _affine_terms(self, problem: MotionProblem) -> Program | None:
        """Return the program of the terms, and set the modes to try."""
        self._unknown = unknown_amounts(problem, set(self._zeros) - set(self.rough))
        free = [name for name in self._zeros if name not in self.rough]
        self._signs = [dict(zip(free, each, strict=True)) for each in product((1, -1, SLIDING), repeat=len(free))]
        tried = self._tried = [*self.rough, *self._reactions]
        self._branches = [dict(zip(tried, each, strict=True)) for each in product((1, -1), repeat=len(tried))]
        self._sides = {name: np.array([float(branch[name]) for branch in self._branches]) for name in tried}
        self._sides_as_inputs = list(map(self._precision.numbers, self._sides.values()))
        known = {name: sign for name, sign in self._pattern.items() if name not in tried}
        return affine_terms(problem, known, self._zeros, self._unknown)

    @property
    def count(self) -> int:
        """Number of guards."""
        return len(self._branches) * (4 if self._dependent else len(self._signs))

    def known(self, inputs: Numbers) -> bool:
        """Return True if the drives have values at a state.

        Parameters
        ----------
        inputs : ndarray, shape (inputs,)
            As for `agreeing`.

        Returns
        -------
        bool
        """
        return bool(np.isfinite(self._terms(inputs[:, None]).drives).all())

    def agreeing(self, inputs: Numbers) -> list[Solution]:
        """Return the modes that agree with their solutions at a state.

        Parameters
        ----------
        inputs : ndarray, shape (inputs,)
            Inputs of the motion's programs without signs.

        Returns
        -------
        list of Solution
            Modes with most sliding signs first. Those without a unique solution are left out: where the amounts are
            not unique, the ends of their ranges agree in other modes.
        """
        terms = self._terms(inputs[:, None])
        equations = [(signs, *self._equations(signs, terms)) for signs in self._signs]
        found = [
            self._solution(branch | signs, matrices[place], right[place], [each[..., place] for each in terms[:3]])
            for place, branch in enumerate(self._branches)
            for signs, matrices, right in equations
        ]
        agreeing = [solution for solution in found if solution is not None]
        nonlinear = self.nonlinear(inputs)
        agreeing = [each for each in agreeing if not any(each.pattern[name] == SLIDING for name in nonlinear)]
        return sorted(agreeing, key=lambda solution: -list(solution.pattern.values()).count(SLIDING))

    def nonlinear(self, inputs: Numbers) -> list[str]:
        """Return the signs whose amounts determine no forces at a state.

        Parameters
        ----------
        inputs : ndarray, shape (inputs,)
            As for `agreeing`.

        Returns
        -------
        list of str
            Those that cannot slide, and those in which forces are not affine.
        """
        return self.rough if not self._curved or self._are_forces_affine(inputs) else [*self.rough, *self._curved]

    def _are_forces_affine(self, inputs: Numbers) -> bool:
        """Return True if the forces at a state are affine in the signs of the zeros.

        Amounts between 1 and -1 are those of no force otherwise (Filippov).
        """
        count = len(self._curved)
        amounts = np.random.default_rng(0).uniform(-1.0, 1.0, size=(count, count + 1 + DRAWN))
        given = zeros(self._precision, len(inputs) + len(amounts), amounts.shape[1])
        given[: len(inputs)] = inputs[:, None]
        for row, each in zip(given[len(inputs) :], amounts, strict=True):
            row[...] = self._precision.numbers(each)
        forces = as_floats(self._forces(given)).T
        affine = np.column_stack([amounts.T, np.ones(amounts.shape[1])])
        fitted = affine @ np.linalg.lstsq(affine, forces)[0]
        return bool(np.all(np.abs(forces - fitted) <= SAME * np.max(np.abs(forces), axis=0)))

    def guards(self, inputs: Numbers) -> Numbers:
        """Return functions that are positive while the accelerations remain unique.

        Parameters
        ----------
        inputs : ndarray, shape (inputs, k)
            Inputs of the motion's programs without signs.

        Returns
        -------
        ndarray, shape (guards, k)
            The determinant of each mode. If the zeros depend on each other, those of slipping to both sides, and how
            far these modes are from agreeing.
        """
        terms = self._terms(inputs)
        if self._dependent:
            found = self._guards_of_slipping(terms)
        else:
            found = [terms.regular * np.linalg.det(self._equations(signs, terms)[0]) for signs in self._signs]
        return np.reshape(found, (self.count, -1))

    def _guards_of_slipping(self, terms: Terms) -> list[Vector]:
        """Return the guards of zeros that depend on each other."""
        along = terms.drives[:, self._unknown.index(self._zeros[0]), 0]
        count = len(terms.regular)
        sides = np.reshape([self._sides_of(name, count) for name in self._reactions], (-1, count))
        found = []
        for side in (1, -1):
            slipping = dict(zip(self._zeros, side * np.sign(along / along[0]).astype(int), strict=True))
            matrices, right = self._equations(slipping, terms)
            determinant = terms.regular * np.linalg.det(matrices)
            matrices = np.where(determinant[:, None, None] != 0, matrices, np.eye(len(self._unknown)))
            amounts = np.append(np.linalg.solve(matrices, right[..., None])[..., 0].T, np.ones((1, len(right))), axis=0)
            drive, against = terms.drives[0] * amounts, terms.reactions * amounts
            leads = -side * drive.sum(axis=0) / np.abs(drive).max(axis=0)
            wrong = (-sides * against.sum(axis=1) / np.abs(against).max(axis=1)).max(axis=0, initial=-1.0)
            found += [determinant, np.maximum(leads, wrong)]
        return found

    def shared(self, solutions: Sequence[Solution], inputs: Numbers) -> Pattern | None:
        """Return a pattern in which contacts stick together.

        Parameters
        ----------
        solutions : sequence of Solution
            Modes that agree, with the same accelerations and different amounts.
        inputs : ndarray, shape (inputs,)
            As for `agreeing`.

        Returns
        -------
        Pattern or None
            The mode that is farthest from its end. None if the zeros do not depend on one of them.
        """
        found = [each for each in solutions if SLIDING in each.pattern.values()]
        if not found or self.rough:
            return None
        slopes = self._terms(inputs[:, None]).drives[:, :-1, 0]
        products = slopes[:, :, None, None] * slopes
        if not _close(products, products.transpose(2, 1, 0, 3), np.abs(products)):
            return None
        best = min(found, key=lambda each: each.used)
        others = [name for name in self._zeros if best.pattern[name] != SLIDING]
        return best.pattern | {name: f"stuck {best.pattern[name]}" for name in others}

    def _terms(self, inputs: Numbers) -> Terms:
        """Return the terms at k states in each branch, one branch after the other."""
        rows, k = inputs.shape
        given = zeros(self._precision, rows + len(self._sides), len(self._branches), k)
        given[:rows] = inputs[:, None]
        for row, sides in zip(given[rows:], self._sides_as_inputs, strict=True):
            row[...] = sides[:, None]
        given = given.reshape(len(given), -1)
        values, k = dict(zip(self._outputs, as_floats(self._function(given)), strict=True)), given.shape[1]

        def affine(quantity: str, names: Sequence[str], constant: float) -> Numbers:
            outputs = [f"{quantity}[{self._places[name]}]" for name in names]
            slopes = [[values.get(derivative_name(each, y), np.zeros(k)) for y in self._unknown] for each in outputs]
            rows = [[*row, values.get(each, np.full(k, constant))] for row, each in zip(slopes, outputs, strict=True)]
            return np.reshape(rows, (len(names), len(self._unknown) + 1, k))

        return Terms(
            affine("drive", self._zeros, 0.0),
            affine("size", self._unknown, 1.0),
            affine("reaction", self._reactions, 0.0),
            values.get("regular", np.ones(k)),
        )

    def _equations(self, signs: Pattern, terms: Terms) -> tuple[Numbers, Numbers]:
        """Return the equations of the amounts.

        Coefficients have shape (k, amounts, amounts), right sides (k, amounts).
        """
        rows = []
        for place, name in enumerate(self._unknown):
            if signs.get(name) == SLIDING:
                drive = terms.drives[self._zeros.index(name)]
                rows.append([*-drive[:-1], drive[-1]])
            else:
                known = self._sides_of(name, len(terms.regular)) if name in self._sides else self._pattern.get(name)
                size = signs.get(name, known) * terms.sizes[place]
                own = np.arange(len(self._unknown))[:, None] == place
                rows.append([*(own - size[:-1]), size[-1]])
        equations = np.moveaxis(np.reshape(rows, (len(rows), len(rows) + 1, len(terms.regular))), -1, 0)
        return equations[:, :, :-1], equations[:, :, -1]

    def _sides_of(self, name: str, count: int) -> Vector:
        """Return the sign of each branch, at all of its states."""
        return np.repeat(self._sides[name], count // len(self._branches))

    def _solution(self, chosen: Pattern, matrix: Numbers, right: Vector, terms: Sequence[Numbers]) -> Solution | None:
        if not _is_regular(matrix):
            return None
        amounts = np.linalg.solve(matrix, right)
        mode = {name: (self._pattern | chosen)[name] for name in self._places}
        (drives, of_drives), (limits, of_limits), (reactions, of_reactions) = (
            _values_and_sizes(each, amounts) for each in terms
        )
        slide = np.array([mode[name] == SLIDING for name in self._unknown], dtype=bool)
        signs = np.array([0 if mode[name] == SLIDING else mode[name] for name in self._zeros])
        sides = np.array([mode[name] for name in self._reactions])
        if (
            (signs * drives < -ZERO * of_drives).any()
            or (np.abs(amounts) > np.abs(limits) + ZERO * of_limits)[slide].any()
            or (np.abs(limits) <= ZERO * of_limits)[slide].any()
            or (sides * reactions < -ZERO * of_reactions).any()
        ):
            return None
        reach = np.concatenate([np.abs(each[:, :-1]) for each in terms]).max(axis=0, initial=0.0)
        used = np.max(np.abs(amounts / limits), where=slide, initial=0.0)
        amounts, others = np.where(reach > 0, amounts, 0.0), [name not in self._zeros for name in self._unknown]
        found = np.concatenate([drives, amounts[others]])
        return Solution(mode, found, amounts, np.concatenate([of_drives, of_limits[others], of_limits]), used)


def modes_that_may_agree(problem: MotionProblem, pattern: Pattern, precision: Precision) -> FrictionModes | None:
    """Return the modes of the signs that slide.

    Parameters
    ----------
    problem, pattern, precision
        As for `FrictionModes`.

    Returns
    -------
    FrictionModes or None
        None if at most one sign slides and no force contains multipliers: the amount is unique where it is finite.
    """
    zeros = sticking(pattern)
    if not problem.reacting and len(zeros) <= 1:
        return None
    dependent = bool(STUCK.keys() & set(pattern.values()))
    return FrictionModes(problem, pattern, zeros, precision, dependent)


def _values_and_sizes(terms: Numbers, amounts: Vector) -> tuple[Vector, Vector]:
    """Return affine values, shape (quantities,), and the sizes of their largest terms."""
    products = terms * np.append(amounts, 1.0)
    return products.sum(axis=1), np.abs(products).max(axis=1, initial=0.0)


def _close(numbers: Vector, others: Vector, sizes: Vector) -> bool:
    return bool((np.abs(numbers - others) <= SAME * sizes).all())


def _is_regular(matrix: Numbers) -> bool:
    """Return True if equations have one solution, in any units."""
    if not np.isfinite(matrix).all():
        return False
    scaled = matrix / np.abs(matrix).max(axis=1, initial=0.0, keepdims=True)
    scaled /= np.abs(scaled).max(axis=0, initial=0.0)
    return bool(np.isfinite(scaled).all() and (not len(scaled) or np.linalg.cond(scaled) < SINGULAR))
