"""States of a motion at which a program is compared with the equations of motion.

Some states are random with values up to two, others are near the initial state of the scene. Mass matrix, forces and
constraints that Maxima wrote are compared with the description along random accelerations and multipliers, in which
they are linear. If they agree, they form the bordered system, which is solved here.
"""

from __future__ import annotations

import random
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

from mpmath import mp

from ..program.motion_problem import MotionProblem
from .described_motion import DescribedMotion
from .irregular_point import IrregularPoint
from .program_values import Values, run, symbols_of_tables, with_signs
from .ranks import solved
from .taylor import Polynomial, Taylor

STATE, SECOND = Taylor(0), Taylor(2)
INDEXED = re.compile(r"(\w+)\[(\d+)(?:,(\d+))?\]")
NEWTON_STEPS = 30
SPARE = 6  # digits to which residuals need not vanish
NEAR = mp.mpf(1) / 8  # how far from the initial state a state near it is, in terms of its own size


class ComparedValue(NamedTuple):
    """A number in a program's result, and the expected number."""

    quantity: str
    given: mp.mpf
    true: mp.mpf
    size: mp.mpf  # sum of the sizes of the terms that both are made of


class Bordered(NamedTuple):
    """The system A a - J^T lambda = h, J a = -c, without redundant constraints."""

    rows: list[dict[int, mp.mpf]]  # of n + g unknowns
    right: list[mp.mpf]
    n: int
    left_out: frozenset[int]

    def solution(self, right: Sequence[mp.mpf]) -> list[mp.mpf]:
        """Return accelerations and multipliers, zero for redundant constraints.

        Parameters
        ----------
        right : sequence of mpf
            Right side, n + g numbers.

        Returns
        -------
        list of mpf
            n + g numbers.
        """
        rows = list(self.rows)
        for beta in self.left_out:
            rows[self.n + beta] = {self.n + beta: mp.one}
        holding = [mp.zero if i - self.n in self.left_out else x for i, x in enumerate(right)]
        return solved(rows, holding)

    def compared(self, what: Sequence[str], x: Sequence[mp.mpf], right: Sequence[mp.mpf]) -> Iterator[ComparedValue]:
        """Check that numbers solve the equations.

        Parameters
        ----------
        what : sequence of str
            Name of each equation, for messages.
        x : sequence of mpf
            Accelerations and multipliers.
        right : sequence of mpf
            Right side, n + g numbers.

        Yields
        ------
        ComparedValue
            Of one equation.
        """
        for i, (row, side) in enumerate(zip(self.rows, right, strict=True)):
            if i - self.n not in self.left_out:
                terms = [entry * x[k] for k, entry in row.items()]
                yield ComparedValue(what[i], mp.fsum(terms), side, mp.fsum(map(abs, terms)) + abs(side))


class States:
    """Random states of one scene."""

    def __init__(self, motion: DescribedMotion, problem: MotionProblem, seed: str) -> None:
        self.motion, self.problem, self._seed = motion, problem, seed
        self.start = {name: mp.mpf(text) for name, text in problem.start.items()}

    @cached_property
    def span(self) -> tuple[mp.mpf, mp.mpf]:
        """First and last time."""
        first = self.start["t"]
        span = self.problem.time_span
        last = mp.mpf(span[1]) if span else first + 2
        if self.problem.law_span is not None:
            last = min(last, mp.mpf(self.problem.law_span[1]))
        return first, last

    def state(self, attempt: int) -> Values:
        """Return a state: the time, coordinates and velocities.

        Parameters
        ----------
        attempt : int
            Number of the state. Even ones are near the initial state.

        Returns
        -------
        Values
            ``t``, ``q`` and ``dot(q)`` of each coordinate.
        """
        draw = random.Random(f"{self._seed} {attempt}")
        first, last = self.span

        def between(low: mp.mpf, high: mp.mpf) -> mp.mpf:
            return low + (high - low) * mp.mpf(draw.randrange(1, 2**40)) / 2**40

        state = {"t": (between(first, last), mp.one)}
        for q in self.problem.coordinates:
            for name in (q, f"dot({q})"):
                value = between(mp.mpf(-2 if attempt % 4 == 1 else 0), mp.mpf(2))
                if attempt % 2 == 0 and name in self.start:
                    value = self.start[name] + NEAR * (value - 1) * (abs(self.start[name]) or 1)
                state[name] = (value,)
        return state

    def holding(self, state: Values) -> Values:
        """Return the state moved onto the constraints, if servo-constraints need it.

        Their conditions agree there.

        Parameters
        ----------
        state : Values
            Result of `state`.

        Returns
        -------
        Values

        Raises
        ------
        IrregularPoint
            Newton's method does not converge.
        """
        if not self.problem.servo.constraints:
            return state
        names = [(q, f"dot({q})") for q in self.problem.coordinates]
        for _ in range(NEWTON_STEPS):
            computed = run(self.problem.matrices, self.inputs(state, [mp.zero] * len(self.problem.multipliers)))
            system = bordered(computed, len(names), self.problem.multipliers, ())
            left = [_residuals(system, computed, which) for which in ("residual", "residual_rate")]
            if max(abs(x) for each in left for x in each) <= mp.mpf(10) ** (SPARE - mp.dps):
                return state
            moves = [system.solution([*[mp.zero] * len(names), *each]) for each in left]
            for pair, *move in zip(names, *moves, strict=False):
                state = state | {name: (state[name][0] + by,) for name, by in zip(pair, move, strict=True)}
        raise IrregularPoint

    def inputs(self, state: Values, multipliers: Sequence[mp.mpf]) -> Values:
        """Return the inputs of programs at a state.

        Parameters
        ----------
        state : Values
            Result of `state`.
        multipliers : sequence of mpf
            Value of each multiplier.

        Returns
        -------
        Values
            Value of each input: of the state, multipliers, tables and signs.
        """
        known = {name: value[:1] for name, value in state.items()}
        known |= {name: (x,) for name, x in zip(self.problem.multipliers, multipliers, strict=True)}
        known |= symbols_of_tables(self.problem, state["t"][0])
        return with_signs(self.problem, known)

    def curve(self, state: Values, accelerations: Mapping[str, mp.mpf], controls: Values) -> Values:
        """Return the curve through a state with these accelerations.

        Parameters
        ----------
        state : Values
            Result of `state`.
        accelerations : mapping of str to mpf
            Acceleration of each coordinate.
        controls : Values
            Polynomial of each control.

        Returns
        -------
        Values
            Polynomials of the time, coordinates, controls and parameters.
        """
        found = self.motion.parameters() | controls | {"t": state["t"]}
        for q in self.problem.coordinates:
            found[q] = (state[q][0], state[f"dot({q})"][0], accelerations[q] / 2)
        return found

    def random_numbers(self, attempt: int, count: int) -> list[mp.mpf]:
        """Return random numbers for accelerations and multipliers.

        Parameters
        ----------
        attempt : int
            Number of the state.
        count : int
            Number of random numbers.

        Returns
        -------
        list of mpf
            Numbers from -1 to 1, the same for the same arguments.
        """
        draw = random.Random(f"{self._seed} {attempt} {count}")
        return [mp.mpf(draw.randint(-(2**40), 2**40)) / 2**40 for _ in range(count)]

    def controls(self, state: Values, computed: Values) -> Values:
        """Return the controls along a motion.

        They follow the law of the description, or are those that the program found.

        Parameters
        ----------
        state : Values
            Result of `state`.
        computed : Values
            Values of the program, with the controls that it finds.

        Returns
        -------
        Values
            Polynomial of each control.
        """
        law = self.motion.law.at(Taylor(3), state["t"][0], self.motion.parameters())
        found = [name for name in self.motion.system.controls if name not in law and name in computed]
        return law | {name: computed[name] for name in found if name not in self.problem.coordinates}


# ---- values that programs compute ----


def values_of_law(controls: Values, computed: Values) -> Iterator[ComparedValue]:
    """Yield values of controls and their derivatives, as a program computes them.

    Parameters
    ----------
    controls : Values
        Polynomial of each control.
    computed : Values
        Values of the program.

    Yields
    ------
    ComparedValue
        Of a control or a derivative.
    """
    for name, x in controls.items():
        for place, what in enumerate((name, f"dot({name})", f"ddot({name})")):
            if what in computed:
                true = mp.factorial(place) * x[place] if place < len(x) else mp.zero
                yield ComparedValue(what, computed[what][0], true, abs(true))


def bordered(computed: Values, n: int, multipliers: Sequence[str], redundant: Sequence[str]) -> Bordered:
    """Return the bordered system from the outputs of the program of matrices.

    Parameters
    ----------
    computed : Values
        Outputs of the program of matrices.
    n : int
        Number of coordinates.
    multipliers : sequence of str
        Names of the multipliers.
    redundant : sequence of str
        Names of those of redundant constraints.

    Returns
    -------
    Bordered
    """
    rows: list[dict[int, mp.mpf]] = [{} for _ in range(n + len(multipliers))]
    right = [mp.zero] * len(rows)
    for name, x in computed.items():
        if (found := INDEXED.fullmatch(name)) is None:
            continue
        i, k = int(found[2]) - 1, int(found[3] or 1) - 1
        match found[1]:
            case "A":
                rows[i][k] = x[0]
            case "J":
                rows[n + i][k], rows[k][n + i] = x[0], -x[0]
            case "h":
                right[i] = x[0]
            case "c":
                right[n + i] = -x[0]
    left_out = frozenset(i for i, name in enumerate(multipliers) if name in redundant)
    return Bordered(rows, right, n, left_out)


def values_of_matrices(
    motion: DescribedMotion, system: Bordered, computed: Values, curve: Values, x: Sequence[mp.mpf]
) -> Iterator[ComparedValue]:
    """Check that the matrices, energy and power are those of the description.

    They are compared along accelerations and multipliers x. The time derivative of the energy is the power plus the
    work of the residuals of the equations of motion.

    Parameters
    ----------
    motion : DescribedMotion
        The description.
    system : Bordered
        Bordered system of the program.
    computed : Values
        Values of the programs of matrices and energy.
    curve : Values
        Curve through the state, with the accelerations x.
    x : sequence of mpf
        Accelerations and multipliers.

    Yields
    ------
    ComparedValue
        Of energy, power, an equation of motion or a constraint.
    """
    values, natural = motion.values(SECOND, curve), len(motion.constraints)
    multipliers = [(each,) for each in x[system.n : system.n + natural]]
    equations = motion.equations(SECOND, values, multipliers)
    energy = (*motion.energy(SECOND, values, curve), mp.zero)
    yield from _values_of_energy_and_residuals(motion, computed, values, energy)
    work = [curve[q][1] * each.value[0] for q, each in zip(motion.system.coordinates, equations, strict=True)]
    yield ComparedValue(
        "power", computed["power"][0], energy[1] - mp.fsum(work), abs(energy[1]) + mp.fsum(map(abs, work))
    )
    for s, equation in enumerate(equations):
        terms = [entry * x[k] for k, entry in system.rows[s].items()]
        given = mp.fsum(terms) - system.right[s]
        size = equation.size[0] + mp.fsum(map(abs, terms)) + abs(system.right[s])
        yield ComparedValue(f"equation of motion of {motion.system.coordinates[s]}", given, equation.value[0], size)
    places = [*motion.constraints, *motion.outputs]
    for beta, place in enumerate(places[: len(system.rows) - system.n]):
        f = (*values[place], mp.zero, mp.zero)
        terms = [entry * x[k] for k, entry in system.rows[system.n + beta].items()]
        right = system.right[system.n + beta]
        size = mp.fsum(map(abs, terms)) + abs(right)
        yield ComparedValue(f"second time derivative of constraint {beta + 1}", mp.fsum(terms) - right, 2 * f[2], size)


def values_along_motion(
    motion: DescribedMotion, system: Bordered, computed: Values, curve: Values, x: Sequence[mp.mpf]
) -> Iterator[ComparedValue]:
    """Check matrices, energy, power and residuals along a motion.

    Parameters
    ----------
    motion, system, computed, curve : DescribedMotion, Bordered, Values, Values
        As for `values_of_matrices`.
    x : sequence of mpf
        Accelerations and multipliers of the motion.

    Yields
    ------
    ComparedValue
    """
    values = motion.values(SECOND, curve)
    energy = (*motion.energy(SECOND, values, curve), mp.zero)
    yield from _values_of_energy_and_residuals(motion, computed, values, energy)
    yield ComparedValue("power", computed["power"][0], energy[1], abs(energy[1]))
    for place, (row, right) in enumerate(zip(system.rows, system.right, strict=True), 1):
        terms = [entry * x[k] for k, entry in row.items()]
        size = mp.fsum(map(abs, terms)) + abs(right)
        yield ComparedValue(f"row {place} of the equations", mp.fsum(terms) - right, mp.zero, size)


def _values_of_energy_and_residuals(
    motion: DescribedMotion, computed: Values, values: Sequence[Polynomial], energy: Polynomial
) -> Iterator[ComparedValue]:
    yield ComparedValue("energy", computed["energy"][0], energy[0], abs(energy[0]))
    for beta, place in enumerate([*motion.constraints, *motion.outputs], 1):
        f = (*values[place], mp.zero)
        for k, (name, what) in enumerate((("residual", ""), ("residual_rate", "derivative of "))):
            if f"{name}[{beta}]" in computed:
                yield ComparedValue(f"{what}constraint {beta}", computed[f"{name}[{beta}]"][0], f[k], abs(f[k]))


def values_of_solve(
    system: Bordered, solution: Sequence[mp.mpf], computed: Values, names: Sequence[str], servo: int
) -> Iterator[ComparedValue]:
    """Check that accelerations and multipliers solve the bordered system.

    Servo-constraints have no multipliers.

    Parameters
    ----------
    system : Bordered
        Bordered system of the program.
    solution : sequence of mpf
        Its solution, n + g numbers.
    computed : Values
        Values of the motion program.
    names : sequence of str
        Names of accelerations and multipliers in the program.
    servo : int
        Number of servo-constraints, the last ones.

    Yields
    ------
    ComparedValue
        Of one equation, or on a multiplier that must be zero.
    """
    x = [computed[name][0] for name in names]
    what = [
        f"{name}: the program gives {mp.nstr(a, 12)}, the bordered system {mp.nstr(b, 12)}; the equation of it"
        for name, a, b in zip(names, x, solution, strict=True)
    ]
    worst = max(range(len(x)), key=lambda i: abs(x[i] - solution[i]) / (abs(solution[i]) or 1))
    yield from system.compared([what[worst]] * len(x), x, system.right)
    for beta in range(len(names) - system.n):
        if beta in system.left_out or beta >= len(names) - system.n - servo:
            push = max((abs(row.get(system.n + beta, 0)) for row in system.rows[: system.n]), default=mp.zero)
            size = max(map(abs, system.right[: system.n]), default=mp.zero)
            yield ComparedValue(names[system.n + beta], push * x[system.n + beta], mp.zero, size)


def values_of_constraint_forces(system: Bordered, computed: Values, names: Sequence[str]) -> Iterator[ComparedValue]:
    """Check that constraint forces belong to the multipliers.

    Parameters
    ----------
    system : Bordered
        Bordered system of the program.
    computed : Values
        Values of the motion program.
    names : sequence of str
        Names of accelerations and multipliers in the program.

    Yields
    ------
    ComparedValue
        Of one observed constraint force.
    """
    for s in range(system.n):
        name = f"Lambda[{s + 1}]"
        if name in computed:
            terms = [-entry * computed[names[k]][0] for k, entry in system.rows[s].items() if k >= system.n]
            yield ComparedValue(name, computed[name][0], mp.fsum(terms), mp.fsum(map(abs, terms)))


def values_of_projection(system: Bordered, computed: Values, residuals: Values, which: str) -> Iterator[ComparedValue]:
    """Check that a correction is the least in the mass metric for the residuals.

    Parameters
    ----------
    system : Bordered
        Bordered system of the program.
    computed : Values
        Values of the projection program.
    residuals : Values
        Values of the program of matrices.
    which : str
        ``position`` or ``velocity``.

    Yields
    ------
    ComparedValue
        Of one equation.
    """
    residual = {"position": "residual", "velocity": "residual_rate"}[which]
    right = [mp.zero] * system.n + _residuals(system, residuals, residual)
    solution = system.solution(right)
    correction = [computed[f"{which}_correction[{s + 1}]"][0] for s in range(system.n)]
    what = [f"{which} correction"] * len(right)
    yield from system.compared(what, [*correction, *solution[system.n :]], right)


def _residuals(system: Bordered, computed: Values, which: str) -> list[mp.mpf]:
    """Return the residuals of the constraints, or of their derivatives."""
    return [-computed[f"{which}[{beta + 1}]"][0] for beta in range(len(system.rows) - system.n)]


def values_by_substitution(
    motion: DescribedMotion, curve: Values, multipliers: Sequence[mp.mpf], holding: Sequence[int]
) -> Iterator[ComparedValue]:
    """Check that the equations of motion hold along a curve through a state.

    Second derivatives of the constraints that hold are values, too.

    Parameters
    ----------
    motion : DescribedMotion
        The description.
    curve : Values
        Curve through the state.
    multipliers : sequence of mpf
        Value of each multiplier.
    holding : sequence of int
        Places on the tape of the constraints that hold.

    Yields
    ------
    ComparedValue
        Of an equation of motion or a constraint.
    """
    values = motion.values(SECOND, curve)
    for q, equation in zip(
        motion.system.coordinates, motion.equations(SECOND, values, [(x,) for x in multipliers]), strict=True
    ):
        yield ComparedValue(f"equation of motion of {q}", equation.value[0], mp.zero, equation.size[0])
    for beta, place in enumerate([*motion.constraints, *motion.outputs]):
        if place in holding:
            f = (*values[place], mp.zero, mp.zero)
            yield ComparedValue(f"second time derivative of constraint {beta + 1}", 2 * f[2], mp.zero, mp.zero)
