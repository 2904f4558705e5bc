"""Output quantities of a motion as heyoka expressions of time, state, parameters."""

from collections.abc import Mapping, Sequence
from typing import Any

from ..language import translatable
from ..program.heyoka_function import heyoka_expressions, import_heyoka, zero_multipliers
from ..program.motion_problem import MotionProblem
from ..program.motion_program import Call, Expression, Name, Operation, Program, names_in
from ..program.rewriting import computing
from ..simulation.radicands import radicands
from .outputs import not_an_output

Known = Mapping[str, Any]


def require_known(problem: MotionProblem, quantities: Sequence[Expression]) -> None:
    """Reject quantities with names that the motion does not have.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    quantities : sequence of Expression
        Outputs to compute.

    Raises
    ------
    HolonomError
        A quantity contains a name that the motion does not have.
    """
    there = ("t", *problem.state, *solved_names(problem), *observed_names(problem), *problem.parameters, "energy")
    for quantity in quantities:
        if unknown := sorted(names_in(quantity) - set(there)):
            raise not_an_output(
                translatable(
                    "unknown quantity %(name)s: expected one of %(names)s", name=unknown[0], names=", ".join(there)
                )
            )


def observed_names(problem: MotionProblem) -> tuple[str, ...]:
    """Return controls where the scene observes them, and outputs of its own.

    Parameters
    ----------
    problem : MotionProblem
        The motion.

    Returns
    -------
    tuple of str
        Names of observed controls and of the scene's own outputs.
    """
    programs = (problem.controls, problem.outputs)
    return tuple(name for program in programs if program is not None for name in program.outputs)


def solved_names(problem: MotionProblem) -> tuple[str, ...]:
    """Return the accelerations, multipliers and, if observed, constraint forces.

    Parameters
    ----------
    problem : MotionProblem
        The motion.

    Returns
    -------
    tuple of str
        Names such as ``ddot(x)``, a multiplier, or ``Lambda[s]`` for the force on coordinate s.
    """
    observed = "constraint_forces" in problem.observe
    forces = tuple(f"Lambda[{s}]" for s in range(1, len(problem.coordinates) + 1)) if observed else ()
    return (*problem.accelerations, *problem.multipliers, *forces)


def along_motion(problem: MotionProblem, known: Known) -> dict[str, Any]:
    """Return heyoka expressions of everything that quantities can be made of.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    known : mapping of str to heyoka expression
        Expressions of t, the state and the parameters, by name.

    Returns
    -------
    dict of str to object
        Those of `known`, and accelerations, multipliers, energy, matrices, controls, outputs, events and arguments of
        roots, by name.
    """
    inputs = {**known, **zero_multipliers(problem.multipliers, 0.0)}
    solved = {**known, **heyoka_expressions(problem.motion, inputs)}
    others = (
        problem.energy,
        problem.matrices,
        problem.controls,
        problem.outputs,
        problem.ends.events,
        radicands_beyond_energy(problem),
    )
    found = [heyoka_expressions(program, solved) for program in others if program is not None]
    return solved | {name: value for results in found for name, value in results.items()}


def radicands_beyond_energy(problem: MotionProblem) -> Program | None:
    """Return the arguments of roots whose zeros the energy does not show.

    If the energy contains roots, they are those of the power of the other forces.

    Parameters
    ----------
    problem : MotionProblem
        The motion.

    Returns
    -------
    Program or None
        As `radicands` returns it.
    """
    energy, power = (computing(problem.energy, {name}) for name in ("energy", "power"))
    return radicands(problem, None if radicands(problem, energy) is None else power)


def expressions_of(quantities: Sequence[Expression], known: Known) -> list[Any]:
    """Return quantities as heyoka expressions.

    Parameters
    ----------
    quantities : sequence of Expression
        Quantities in the names of `known`.
    known : mapping of str to heyoka expression
        Expressions by name, as `along_motion` returns them.

    Returns
    -------
    list of heyoka expression
        One for each quantity.
    """
    zero = import_heyoka().expression(0.0)
    return [zero + found for found in heyoka_expressions(program_of(quantities), known).values()]


def program_of(quantities: Sequence[Expression]) -> Program:
    """Return a program of quantities.

    Parameters
    ----------
    quantities : sequence of Expression

    Returns
    -------
    Program
        One output for each quantity, in order.
    """
    named = {f"output[{place}]": quantity for place, quantity in enumerate(quantities)}
    return Program(
        scene=None,
        solve=None,
        method="composed",
        redundant=(),
        inputs=tuple(sorted(set().union(*map(names_in, quantities)))),
        assignments=tuple(named.items()),
        outputs={name: Name(name) for name in named},
    )


def forces_of(problem: MotionProblem) -> tuple[list[Expression], list[Expression]]:
    """Return the components of J^T lambda that a constraint has, and those of h.

    Parameters
    ----------
    problem : MotionProblem
        The motion.

    Returns
    -------
    reactions : list of Expression
        Sums of ``J[beta,s]`` times multipliers.
    others : list of Expression
        ``h[1]``, ..., ``h[n]``.
    """
    places, reactions = range(1, len(problem.coordinates) + 1), []
    for s in places:
        terms = [
            Call(Operation.MULTIPLY, (Name(f"J[{beta},{s}]"), Name(name)))
            for beta, name in enumerate(problem.multipliers, start=1)
            if f"J[{beta},{s}]" in problem.matrices.outputs
        ]
        if terms:
            reactions.append(Call(Operation.ADD, tuple(terms)))
    return reactions, [Name(f"h[{s}]") for s in places]
