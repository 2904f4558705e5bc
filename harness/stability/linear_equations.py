"""Linearised equations of a scene, by `maxima/stability/linearization.mac`.

With r_s the left side of Lagrange's equations less the right one, deviations satisfy

    A da + D dv + K dq + E du + ... - J^T dlambda = 0,        J dq + U du = 0,

and the first and second time derivatives of the latter.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..described import SystemTitle
from ..documents import ask
from ..failures import ErrorKind, HolonomError
from ..formats import Document, read
from ..program.motion_program import Expression, Name, Operation, Program, calls_of, names_used
from ..program.numpy_function import NumpyFunction
from ..program.request import Request
from ..program.rewriting import computing, with_factors
from ..program.table import Table
from ..program.table_numbers import TimeFunction
from ..schema import Names
from ..simulation.constraints.directions import cholesky
from ..simulation.matrices import INDEXED, Matrix, Vector
from ..simulation.nominal import beside
from ..source import Source
from ..structs import entry

ROWS = ("equation", "constraint", "rate", "acceleration", "output")  # r, f, Df, DDf, outputs
GROUPS = ("q", "v", "a", "u", "du", "ddu")
FACTORS = 61  # different rounding errors at one point
SIGNED = (Operation.SIGN, Operation.ABS)


class EnergyChange(StrEnum):
    """Changes of the energy by forces."""

    CONSERVED = "conserved"
    DISSIPATED = "dissipated"
    OPEN = "open"


@dataclass(frozen=True)
class LinearEquations:
    """The linearised equations of a scene."""

    system: SystemTitle = entry("The system.")
    scene: str = entry("Name that the scene is assigned to.")
    title: str = entry("Title of the scene.")
    coordinates: Names = entry("The n coordinates.")
    multipliers: Names = entry("The g multipliers, one for each constraint.")
    controls: Names = entry("The controls with a law.")
    found: Names = entry(
        "Controls in forces that servo-constraints find. They follow those with a law among the inputs."
    )
    drives: int = entry(
        "Number of controls in constraints that servo-constraints find. They are the last coordinates, and their "
        "drives the last controls.",
        minimum=0,
    )
    servo: int = entry(
        "Number of servo-constraints, the last of the constraints. Their multipliers are zero.", minimum=0
    )
    tables: tuple[Table, ...] = entry("Tables of the law, as of a motion problem.")
    energy: EnergyChange = entry("Change of the energy by forces while the controls are at rest.")
    law: Program | None = entry(
        "Program of t and the tables' inputs: u, dot(u), ddot(u) of the controls with a law; null if one has none."
    )
    program: Program = entry(
        "Program of (t, q, dot q, ddot q, lambda, u, dot u, ddot u): equation[s], constraint[b], rate[b], "
        "acceleration[b], their gradients equation_by_q[s,k] and so on by q, v, a, u, du and ddu, and "
        "A_rate[s,k]; what is absent is zero."
    )
    outputs: tuple[str, ...] = entry("Observed quantities with names of their own.")
    orientations: Program | None = entry(
        "Program of t, q and the controls with a law: orientation[k], whose signs no motion changes; null without any.",
        None,
    )

    @cached_property
    def _evaluate(self) -> NumpyFunction:
        return NumpyFunction(self.program)

    @cached_property
    def _evaluate_roughly(self) -> NumpyFunction:
        return NumpyFunction(with_factors(self.program, [f"factor[{k}]" for k in range(FACTORS)]))

    @cached_property
    def signed_functions(self) -> tuple[list[Expression], NumpyFunction]:
        """Functions whose sign or size the program contains, and their values."""
        functions = list(
            dict.fromkeys(call.arguments[0] for call in calls_of(self.program) if call.operation in SIGNED)
        )
        return functions, self.evaluating(functions)

    def evaluating(self, functions: Iterable[Expression]) -> NumpyFunction:
        """Return the values of functions that the program contains.

        Parameters
        ----------
        functions : iterable of Expression

        Returns
        -------
        NumpyFunction
            Of the inputs of the program.
        """
        named = {f"function[{place}]": each for place, each in enumerate(functions)}
        assignments, outputs = (*self.program.assignments, *named.items()), {name: Name(name) for name in named}
        return NumpyFunction(replace(self.program, assignments=assignments, outputs=outputs))

    def rows(self, point: "Point") -> Vector:
        """Return the values of the program.

        Parameters
        ----------
        point : Point
            Or several of them, with a last axis more, which the result then has.

        Returns
        -------
        ndarray, shape (outputs,)
        """
        return self._evaluate(self.inputs(point))

    @cached_property
    def _orientations(self) -> NumpyFunction:
        return NumpyFunction(self.orientations)

    @cached_property
    def _places(self) -> list[tuple[str, tuple[int, ...]]]:
        """Array and index of each output."""
        parts = (INDEXED.fullmatch(name).groups() for name in self._evaluate.outputs)
        return [(array, tuple(int(place) - 1 for place in places if place)) for array, *places in parts]

    @cached_property
    def _law(self) -> TimeFunction:
        rates = [f"{dots}({u})" if dots else u for dots in ("", "dot", "ddot") for u in self.controls]
        return TimeFunction(replace(self.law, outputs={name: self.law.outputs[name] for name in rates}), self.tables)

    @property
    def changes_with_time(self) -> bool:
        """True if the equations of motion contain the time, except through controls."""
        rows = {name for name in self.program.outputs if not name.startswith("output")}
        return "t" in names_used(computing(self.program, rows))

    @property
    def linear(self) -> bool:
        """True if the gradients are known to be constant for constant controls."""
        gradients = {name for name in self.program.outputs if "_by_" in name and not name.startswith("output")}
        moving = {*self.program.inputs[: 1 + 3 * len(self.coordinates)], *self.multipliers}
        return names_used(computing(self.program, gradients)).isdisjoint(moving)

    def controls_at(self, t: float) -> Vector:
        """Return u, dot u and ddot u under the law.

        Parameters
        ----------
        t : float
            Time, in the scene's unit.

        Returns
        -------
        ndarray, shape (3r,)
            All u, then all dot u, then all ddot u, empty without controls.

        Raises
        ------
        HolonomError
            A control has no law.
        """
        if not self.controls:
            return np.empty(0)
        if self.law is None:
            raise HolonomError(ErrorKind.NO_LAW)
        return self._law(np.asarray(t))

    def at(
        self, point: "Point", independent: Sequence[int], random: np.random.Generator | None = None
    ) -> Mapping[str, Matrix]:
        """Evaluate the equations and their gradients.

        Parameters
        ----------
        point : Point
            Or k of them, with a last axis more, which all results then have.
        independent : sequence of int
            The constraints that are looked at, g of them, counted from 0.
        random : Generator or None
            If given, rounding errors are random, others at each point.

        Returns
        -------
        mapping of str to ndarray
            ``equation``, shape (n,), ``constraint``, ``rate`` and ``acceleration``, shape (g,): r, f, Df, DDf. Their
            gradients ``equation_by_q``, and so on by q, v, a, u, du, ddu. ``A_rate``, shape (n, n). ``output``, the
            scene's own, with its gradients, also by the multipliers that are looked at. ``reactions``, shape (n, f):
            the forces of the constraints, those of multipliers, found controls and drives of one.
            ``output_by_forces``, shape (outputs, f).
        """
        n, g, r = len(self.coordinates), len(self.multipliers), len(self.controls)
        pushing = len(self.found) + self.drives
        sizes = dict(zip(GROUPS, (n, n, n, *[r + pushing] * 3), strict=True))
        points = point.state.shape[1:]
        own = len(self.outputs)
        found = {"A_rate": np.zeros((n, n, *points)), "output_by_multipliers": np.zeros((own, g, *points))}
        for row, size in zip(ROWS, (n, g, g, g, own), strict=True):
            found[row] = np.zeros((size, *points))
            found |= {f"{row}_by_{group}": np.zeros((size, columns, *points)) for group, columns in sizes.items()}
        if random is None:
            values = self.rows(point)
        else:
            errors = np.finfo(float).eps * random.uniform(-1, 1, (FACTORS, *points))
            values = self._evaluate_roughly([*self.inputs(point), *(1 + errors)])
        for (array, place), value in zip(self._places, values, strict=True):
            found[array][place] = value
        of_motion = ("equation", "A_rate", "output")
        found = {name: each if name.startswith(of_motion) else each[list(independent)] for name, each in found.items()}
        natural = self.natural(independent)
        reactions = np.swapaxes(found["constraint_by_q"][:natural], 0, 1), -found["equation_by_u"][:, r:]
        own_by_multipliers = found.pop("output_by_multipliers")[:, list(independent[:natural])]
        own_by_forces = own_by_multipliers, found["output_by_u"][:, r:]
        cut = {f"{row}_by_{rate}": found[f"{row}_by_{rate}"][:, :r] for row in ROWS for rate in GROUPS[3:]}
        return found | cut | {
            "reactions": np.concatenate(reactions, axis=1), "output_by_forces": np.concatenate(own_by_forces, axis=1)
        }  # fmt: skip

    def masses_near(self, point: "Point", mass: Matrix) -> Vector:
        """Return the diagonal of the mass matrix near a point, where it is singular there.

        The mass of a body's e0 vanishes where the body has not turned, and that of e1 after half a turn.

        Parameters
        ----------
        point : Point
        mass : ndarray, shape (n, n)
            The mass matrix there.

        Returns
        -------
        ndarray, shape (n,)
            May contain nan.
        """
        if cholesky(mass) is not None:
            return mass.diagonal()
        return self.at(point._replace(state=beside(point.state)), [])["equation_by_a"].diagonal()

    def orientation(self, point: "Point") -> Vector:
        """Return the expressions whose signs no motion changes.

        Parameters
        ----------
        point : Point
            Or several of them, with a last axis more, which the result then has.

        Returns
        -------
        ndarray, shape (k,)
        """
        if self.orientations is None:
            return np.empty((0, *point.state.shape[1:]))
        n, r = len(self.coordinates), len(self.controls)
        return self._orientations([point.t, *point.state[:n], *point.controls[:r]])

    def natural(self, independent: Sequence[int]) -> int:
        """Return the number of constraints with reactions.

        Parameters
        ----------
        independent : sequence of int
            Constraints that are looked at, in order.

        Returns
        -------
        int
        """
        return sum(beta < len(self.multipliers) - self.servo for beta in independent)

    def inputs(self, point: "Point") -> list[float | Vector]:
        """Return the inputs of the program.

        Parameters
        ----------
        point : Point
            Or several of them, with a last axis more.

        Returns
        -------
        list of float or ndarray
            One for each input.
        """
        parts = point[1:5]
        if len(point.found):
            rates, none = np.split(point.controls, 3), np.zeros_like(point.found)
            parts = *point[1:4], rates[0], point.found, rates[1], none, rates[2], none
        return [point.t, *np.concatenate(parts)]


class Point(NamedTuple):
    """Inputs of the linearised equations."""

    t: float
    state: Vector  # shape (2n,)
    accelerations: Vector  # shape (n,)
    multipliers: Vector  # shape (g,), those of all constraints
    controls: Vector  # shape (3r,): u, dot u, ddot u
    found: Vector = np.empty(0)  # forces of found controls and drives


def linear_equations(source: Source, request: Request) -> LinearEquations:
    """Derive the linearised equations of a scene by Maxima.

    Parameters
    ----------
    source : Source
        Scene file.
    request : Request
        Scene and numbers for its parameters.

    Returns
    -------
    LinearEquations

    Raises
    ------
    HolonomError
        As `holonom.documents.ask`, or a parameter has no value.
    """
    text = ask(Document.LINEARIZATION, source, request.scene, settings=request.settings)
    return read(Document.LINEARIZATION, text, LinearEquations)
