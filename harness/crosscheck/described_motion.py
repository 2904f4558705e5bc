"""The equations of motion of a described scene, evaluated along a curve.

A curve is a Taylor polynomial in the time for each coordinate. Along it

    d/dt dL/d dot(q_s) - dL/dq_s - Q_s - lambda_beta df_beta/dq_s        and        f_beta

are polynomials in the time, too: on a motion they vanish. No matrix is made, and no symbolic differentiation is
needed.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import NamedTuple

from mpmath import mp

from ..description import DescribedScene, Description
from ..expression.trees import Tree, converted
from .law import DATA_DIGITS, Law, Spline, number
from .tape import Tape
from .taylor import Polynomial, Taylor

Curve = Mapping[str, Polynomial]


@dataclass(frozen=True)
class Residual:
    """A residual as a polynomial in the time, with the sum of the sizes of its terms."""

    value: Polynomial
    size: Polynomial


class DescribedMotion:
    """The description of one scene, or of its system if `scene` is None."""

    def __init__(self, description: Description, scene: DescribedScene | None) -> None:
        system = self.system = description.system
        self.description, self.scene = description, scene
        effects = None if scene is None else scene.effects
        tape = self.tape = Tape()

        def called(parts: Sequence) -> list:
            return [part for part in parts if effects is None or part.effect in effects]

        self._kinetic = [tape.place(part.tree) for part in called(system.kinetic_energy)]
        self._potential = [tape.place(part.tree) for part in called(system.potential_energy)]
        zeros = [name for name, (value,) in self.parameters().items() if not value]
        self._forces = [
            [tape.place(_without_zeros(part.trees[s], zeros, system.multipliers)) for part in called(system.forces)]
            for s in range(len(system.coordinates))
        ]
        self.constraints = [tape.place(tree) for tree in system.constraint_trees]
        self.outputs = [] if scene is None else [tape.place(tree) for tree in _plain(scene.servo_trees)]
        self.ended: frozenset[str] = frozenset()  # multipliers of constraints that have ended

    def after(self, k: int) -> DescribedMotion:
        """Return the motion after the k-th release of the scene, counted from 0.

        Parameters
        ----------
        k : int
            Place of the release in the scene.

        Returns
        -------
        DescribedMotion
            The motion without the constraints that end.
        """
        found, scene, ended = copy(self), self.scene, self.scene.released[k].multipliers
        remaining = [beta for beta, name in enumerate(self.system.multipliers) if name not in ended]
        found.scene = replace(scene, released=scene.released[:k] + scene.released[k + 1 :])
        names, trees = self.system.multipliers, self.system.constraint_trees
        found.system = replace(
            self.system,
            multipliers=tuple(names[beta] for beta in remaining),
            constraint_trees=tuple(trees[beta] for beta in remaining),
        )
        found.constraints = [self.constraints[beta] for beta in remaining]
        found.ended = self.ended | set(ended)
        return found

    @cached_property
    def moved(self) -> tuple[str, ...]:
        """Controls of servo-constraints that occur in constraints, as coordinates.

        Servo-constraints determine them.
        """
        if self.scene is None or not self.scene.servo_trees:
            return ()
        return tuple(u for u in self._standing_in(self.constraints) if u not in self.freed)

    @cached_property
    def freed(self) -> tuple[str, ...]:
        """Controls that prescribed reactions determine, as coordinates of the state."""
        if self.scene is None or not self.scene.prescribed_reactions:
            return ()
        if not self.scene.servo_trees:
            return tuple(u for u in self.system.controls if u not in self.scene.control_law)
        places = zip(self.system.multipliers, self.constraints, strict=True)
        return self._standing_in([place for name, place in places if name in self.scene.prescribed_reactions])

    @property
    def reacting(self) -> tuple[str, ...]:
        """Multipliers in the forces."""
        needed = self._needed_for_forces
        return tuple(name for name in self.system.multipliers if self.tape.names.get(name) in needed)

    @cached_property
    def _needed_for_forces(self) -> set[int]:
        return self.tape.needed_for([place for parts in self._forces for place in parts])

    def _standing_in(self, places: Sequence[int]) -> tuple[str, ...]:
        """Return controls without a law that occur in expressions."""
        needed = self.tape.needed_for(places)
        free = (u for u in self.system.controls if u not in self.scene.control_law)
        return tuple(u for u in free if self.tape.names.get(u) in needed)

    @cached_property
    def span(self) -> tuple[mp.mpf, mp.mpf] | None:
        """First and last time of the scene, or None if it states none."""
        if self.scene is None or self.scene.span_trees is None:
            return None
        with mp.workdps(DATA_DIGITS):
            first, last = map(number, self.scene.span_trees)
        return first, last

    @property
    def first_time(self) -> mp.mpf:
        """Beginning of the time span, or zero."""
        return self.span[0] if self.span else mp.zero

    @cached_property
    def splines(self) -> list[Spline]:
        """Tables of the scene as splines."""
        return [Spline(table) for table in self.description.tables]

    @cached_property
    def law(self) -> Law:
        """Control law of the scene."""
        return Law({} if self.scene is None else self.scene.control_law.trees, self.splines)

    @cached_property
    def reactions(self) -> Law:
        """Prescribed reactions of the scene."""
        return Law({} if self.scene is None else self.scene.prescribed_reactions.trees, self.splines)

    def parameters(self) -> dict[str, Polynomial]:
        """Return the values of parameters and switches.

        Returns
        -------
        dict of str to Polynomial
            Constant polynomials by name. A switch is 1 or 0.
        """
        trees = {} if self.scene is None else self.scene.parameter_values.trees
        called = self.system.switches if self.scene is None else self.scene.effects
        switches = {name: (mp.mpf(name in called),) for name in self.system.switches}
        return {name: (number(tree),) for name, tree in trees.items()} | switches

    def all_parameters(self) -> dict[str, Polynomial]:
        """Return values of all parameters, any number for those without a value.

        A motion that the record follows does not depend on these.

        Returns
        -------
        dict of str to Polynomial
            As `parameters`.
        """
        return {name: (mp.sqrt(place),) for place, name in enumerate(self.system.parameters, 2)} | self.parameters()

    def number_of(self, tree: Tree) -> mp.mpf:
        """Return the value of an expression of parameters alone.

        Parameters
        ----------
        tree : Tree
            Expression of parameters.

        Returns
        -------
        mpf
        """
        return Law({"": tree}, ()).at(Taylor(0), mp.zero, self.parameters())[""][0]

    def values(self, taylor: Taylor, curve: Curve, needed: Container[int] | None = None) -> list[Polynomial]:
        """Return values of T, V, Q, f and their parts along a curve.

        Parameters
        ----------
        taylor : Taylor
            Arithmetic up to the order of the polynomials.
        curve : Curve
            Polynomial of each coordinate, control, parameter and the time.
        needed : container of int or None
            Places of the tape to evaluate, or None for all.

        Returns
        -------
        list of Polynomial
            Polynomial at each place of the tape, empty if it is not needed.

        Raises
        ------
        IrregularPoint
            As `Tape.values`.
        """
        return self.tape.values(taylor, self.with_derivatives(taylor, curve), needed)

    def with_derivatives(self, taylor: Taylor, curve: Curve) -> dict[str, Polynomial]:
        """Return a curve with the time derivatives of its coordinates and controls.

        Parameters
        ----------
        taylor : Taylor
            Arithmetic up to the order of the polynomials.
        curve : Curve
            Polynomial of each quantity.

        Returns
        -------
        dict of str to Polynomial
            The curve, ``dot(q)`` of each of its coordinates and controls, and zero multipliers of ended constraints.
        """
        names = (*self.system.coordinates, *self.system.controls)
        rates = {f"dot({name})": taylor.rate(curve[name]) for name in names if name in curve}
        return {**dict.fromkeys(self.ended, (mp.zero,)), **rates, **curve}

    def equations(
        self, taylor: Taylor, values: Sequence[Polynomial], multipliers: Sequence[Polynomial]
    ) -> list[Residual]:
        """Return the residuals of Lagrange's equations along the curve of the values.

        Parameters
        ----------
        taylor : Taylor
            Arithmetic up to the order of the polynomials.
        values : sequence of Polynomial
            Result of `values` along the curve.
        multipliers : sequence of Polynomial
            Polynomial of each multiplier.

        Returns
        -------
        list of Residual
            One for each coordinate.
        """
        lagrangian = self._gradient_of_lagrangian(taylor, values)
        reactions = self.constraint_forces(taylor, values, multipliers)
        sizes = self.tape.sizes(taylor, values, self._needed_for_forces)
        found = []
        for s, q in enumerate(self.system.coordinates):
            inertia = taylor.rate(lagrangian.get(f"dot({q})", (mp.zero,)))
            forces = [values[place] for place in self._forces[s]]
            terms = [lagrangian.get(q, (mp.zero,)), *forces, reactions.get(q, (mp.zero,))]
            value = taylor.add(inertia, *(taylor.scale(-1, term) for term in terms))
            size = taylor.add(*map(_sizes, (inertia, *terms)), *(sizes[place] for place in self._forces[s]))
            found.append(Residual(value, size))
        return found

    def constraint_forces(
        self, taylor: Taylor, values: Sequence[Polynomial], multipliers: Sequence[Polynomial]
    ) -> dict[str, Polynomial]:
        """Return the gradient of lambda_beta f_beta, by the name of the coordinate.

        Parameters
        ----------
        taylor : Taylor
            Arithmetic up to the order of the polynomials.
        values : sequence of Polynomial
            Result of `values` along the curve.
        multipliers : sequence of Polynomial
            Polynomial of each multiplier.

        Returns
        -------
        dict of str to Polynomial
        """
        seeds = dict.fromkeys(self.constraints, (mp.zero,))
        for place, multiplier in zip(self.constraints, multipliers, strict=True):
            seeds[place] = taylor.add(seeds[place], multiplier)
        return self.tape.gradient(taylor, values, seeds)

    def momenta(self, taylor: Taylor, values: Sequence[Polynomial]) -> dict[str, Polynomial]:
        """Return the gradient of the kinetic energy, by the name of the velocity.

        Parameters
        ----------
        taylor : Taylor
            Arithmetic up to the order of the polynomials.
        values : sequence of Polynomial
            Result of `values` along the curve.

        Returns
        -------
        dict of str to Polynomial
        """
        seeds: dict[int, Polynomial] = {}
        for place in self._kinetic:
            seeds[place] = taylor.add(seeds.get(place, (mp.zero,)), (mp.one,))
        return self.tape.gradient(taylor, values, seeds)

    def energy(self, taylor: Taylor, values: Sequence[Polynomial], curve: Curve) -> Polynomial:
        """Return the energy function dot(q_s) dL/d dot(q_s) - L along the curve.

        Parameters
        ----------
        taylor : Taylor
            Arithmetic up to the order of the polynomials.
        values : sequence of Polynomial
            Result of `values` along the curve.
        curve : Curve

        Returns
        -------
        Polynomial
        """
        lagrangian = self._gradient_of_lagrangian(taylor, values)
        rates = self.with_derivatives(taylor, curve)
        parts = [
            taylor.multiply(rates[rate], lagrangian[rate]) for rate in self.system.velocities if rate in lagrangian
        ]
        parts += [taylor.scale(-1, values[place]) for place in self._kinetic]
        return taylor.add((mp.zero,), *parts, *(values[place] for place in self._potential))

    def _gradient_of_lagrangian(self, taylor: Taylor, values: Sequence[Polynomial]) -> dict[str, Polynomial]:
        seeds: dict[int, Polynomial] = {}
        for place, sign in (*((each, 1) for each in self._kinetic), *((each, -1) for each in self._potential)):
            seeds[place] = taylor.add(seeds.get(place, (mp.zero,)), (mp.mpf(sign),))
        return self.tape.gradient(taylor, values, seeds)


def _sizes(x: Polynomial) -> Polynomial:
    return tuple(map(abs, x))


class _Part(NamedTuple):
    """A part of a force."""

    tree: Tree
    vanishes: bool
    reacts: bool


def _without_zeros(tree: Tree, zeros: Container[str], multipliers: Container[str]) -> Tree:
    """Return a force without the products of multipliers and parameters that are zero."""

    def whole(head: str, *parts: _Part) -> _Part:
        zero, reacts = [part.vanishes for part in parts], any(part.reacts for part in parts)
        vanishes = any(zero) if head == "Multiply" else head in ("Add", "Negate") and all(zero)
        return _Part(0 if vanishes and reacts else [head, *(part.tree for part in parts)], vanishes, reacts)

    def expanded(part: Tree) -> tuple[Callable[..., _Part], list[Tree]]:
        match part:
            case [str(head), *arguments]:
                return partial(whole, head), arguments
            case _:
                return lambda: _Part(part, part in zeros, part in multipliers), []

    return converted(tree, expanded).tree


def _plain(trees: Sequence) -> list:
    return [tree for tree in trees if "Table" not in str(tree)]
