"""Quantities of a motion in heyoka's terms: what is kept, as expressions of t, the state and the parameters."""

from collections.abc import Mapping, Sequence
from typing import Any

from ..failures import Failure, HolonomError
from ..program.heyoka_function import heyoka_expressions, import_heyoka, zero_multipliers
from ..program.motion_problem import MotionProblem
from ..program.motion_program import Call, Expression, Name, Operation, Program, names_in

Known = Mapping[str, Any]


def require_known(problem: MotionProblem, quantities: Sequence[Expression]) -> None:
    """Refuse quantities that hold names which the motion does not have."""
    there = ("t", *problem.state, *solved_names(problem), *observed_names(problem), *problem.parameters, "energy")
    for quantity in quantities:
        if unknown := sorted(names_in(quantity) - set(there)):
            raise HolonomError(
                Failure.NOT_KEPT, detail=f"the motion has no {unknown[0]}; it has {', '.join(there)}, for each row"
            )


def observed_names(problem: MotionProblem) -> tuple[str, ...]:
    """Return controls where the scene observes them, and outputs of its own."""
    programs = (problem.controls, problem.outputs)
    return tuple(name for program in programs if program is not None for name in program.outputs)


def solved_names(problem: MotionProblem) -> tuple[str, ...]:
    """Accelerations, multipliers and, where the scene observes them, constraint forces."""
    accelerations = tuple(f"ddot({name})" for name in problem.coordinates)
    observed = "constraint_forces" in problem.observe
    forces = tuple(f"Lambda[{s}]" for s in range(1, len(problem.coordinates) + 1)) if observed else ()
    return (*accelerations, *problem.multipliers, *forces)


def along_motion(problem: MotionProblem, known: Known) -> dict[str, Any]:
    """Everything that quantities can be made of, from t, the state and the parameters."""
    inputs = {**known, **zero_multipliers(problem.multipliers, 0.0)}
    solved = {**known, **heyoka_expressions(problem.motion, inputs)}
    others = (problem.energy, problem.matrices, problem.controls, problem.outputs, problem.events)
    found = [heyoka_expressions(program, solved) for program in others if program is not None]
    return solved | {name: value for results in found for name, value in results.items()}


def expressions_of(quantities: Sequence[Expression], known: Known) -> list[Any]:
    """Quantities as heyoka's expressions, of the expressions that they are made of."""
    named = {f"kept[{place}]": quantity for place, quantity in enumerate(quantities)}
    program = Program(
        scene=None,
        solve=None,
        method="composed",
        redundant=(),
        operations=0,
        inputs=tuple(sorted(set().union(*map(names_in, quantities)))),
        assignments=tuple(named.items()),
        outputs={name: Name(name) for name in named},
    )
    zero = import_heyoka().expression(0.0)
    return [zero + found for found in heyoka_expressions(program, known).values()]


def constraint_forces(problem: MotionProblem) -> list[Expression]:
    """J^T lambda, of each coordinate that a constraint touches."""
    forces = []
    for s in range(1, len(problem.coordinates) + 1):
        terms = [
            Call(Operation.MULTIPLY, (Name(f"J[{beta},{s}]"), Name(name)))
            for beta, name in enumerate(problem.multipliers, start=1)
            if f"J[{beta},{s}]" in problem.matrices.outputs
        ]
        if terms:
            forces.append(Call(Operation.ADD, tuple(terms)))
    return forces


def other_forces(problem: MotionProblem) -> list[Expression]:
    """Return the components of h."""
    return [Name(f"h[{s}]") for s in range(1, len(problem.coordinates) + 1)]
