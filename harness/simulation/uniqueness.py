"""Outputs that are not unique: of redundant constraints, or of contacts.

Reactions of joints are among them. All multipliers lambda + mu with J^T mu = 0 give the same motion. An output is
unique if no mu changes it. Of contacts that stick together it is if the modes that agree have the same value.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..program.motion_problem import MotionProblem
from ..program.precision import Precision, read_precision
from ..program.sign_pattern import program_in
from .constraints.directions import or_one
from .evaluation import Numbers, as_floats, evaluation, evaluation_once
from .friction_modes import Solution
from .hard_cases import MotionState
from .inputs import Inputs
from .matrices import Vector

NO_FORCE = 1e-9  # of the largest singular value: constraint forces that count as none
UNCHANGED = 1e-9  # of the sum of its terms: a change of an output that counts as none
ROUNDING = 1e-12  # of the largest sum of terms, likewise


def undetermined_outputs(
    problem: MotionProblem, at: MotionState, accelerations: Vector, multipliers: Vector
) -> tuple[str, ...]:
    """Return the names of the outputs that are not unique at a state.

    Parameters
    ----------
    problem : MotionProblem
        Without signs.
    at : MotionState
        State of the motion, with its matrices.
    accelerations, multipliers : ndarray, shape (n,) and (g,)
        Accelerations and multipliers at the state.

    Returns
    -------
    tuple of str
    """
    if problem.outputs is None or not problem.dependent or not len(multipliers) or not at.here.finite:
        return ()
    weights = 1 / or_one(np.linalg.norm(at.here.jacobian, axis=1))
    _, sizes, right = np.linalg.svd(at.here.jacobian.T * weights)
    rank = np.count_nonzero(sizes > NO_FORCE * sizes.max(initial=0.0))
    free = weights[:, None] * right[rank:].T  # shape (g, k): the mu
    g = len(multipliers)
    steps = np.diag(weights) * (np.abs(multipliers / weights).max() or 1.0)
    points = multipliers[:, None] + np.concatenate([np.zeros((g, 1)), steps], axis=1)
    states = np.repeat(at.state[:, None], g + 1, axis=1)
    inputs = Inputs(problem)(
        np.full(g + 1, at.t), states, points, accelerations=np.repeat(accelerations[:, None], g + 1, axis=1)
    )
    values = as_floats(evaluation_once(problem, problem.outputs, read_precision("double"))(inputs))
    slopes = (values[:, 1:] - values[:, :1]) / np.diag(steps)
    changes, terms = np.abs(slopes @ free), np.abs(slopes) @ np.abs(free)
    changed = (changes > UNCHANGED * terms + ROUNDING * terms.max(initial=0.0)).any(axis=1)
    return tuple(name for name, by in zip(problem.outputs.outputs, changed, strict=True) if by)


def differing_outputs(
    problem: MotionProblem, modes: Sequence[Solution], precision: Precision, t: Any, state: Numbers
) -> tuple[str, ...]:
    """Return the names of quantities that depend on the mode of friction.

    Parameters
    ----------
    problem : MotionProblem
        With signs.
    modes : sequence of Solution
        The modes that agree.
    precision : Precision
        Numbers of the state.
    t : number
        Time of the state.
    state : ndarray, shape (2n,)
        Coordinates, then velocities.

    Returns
    -------
    tuple of str
    """
    found = [_outputs_in(problem, mode, precision, t, state) for mode in modes]
    values = np.array([list(each.values()) for each in found])
    differ = np.ptp(values, axis=0) > UNCHANGED * np.abs(values).max(axis=0)
    return tuple(name for name, differs in zip(found[0], differ, strict=True) if differs)


def accelerations_differ(
    problem: MotionProblem, modes: Sequence[Solution], precision: Precision, t: Any, state: Numbers, sizes: Vector
) -> bool:
    """Return True if an acceleration depends on the mode of friction.

    Parameters
    ----------
    problem, modes, precision, t, state
        As for `differing_outputs`.
    sizes : ndarray, shape (n,)
        Nominal sizes of the accelerations.

    Returns
    -------
    bool
    """
    solved = [_solved_in(problem, mode, precision, t, state) for mode in modes]
    values = np.array([[float(each[name]) for name in problem.accelerations] for each in solved])
    return bool(np.any(np.ptp(values, axis=0) > UNCHANGED * np.maximum(sizes, np.abs(values).max(axis=0))))


def _solved_in(problem: MotionProblem, mode: Solution, precision: Precision, t: Any, state: Numbers) -> dict[str, Any]:
    """Return accelerations and multipliers in one mode."""
    motion = program_in(problem, problem.motion, mode.pattern)
    values = evaluation(motion, precision)(Inputs(problem, precision)(t, state))
    return dict(zip(motion.outputs, values, strict=True))


def _outputs_in(
    problem: MotionProblem, mode: Solution, precision: Precision, t: Any, state: Numbers
) -> dict[str, float]:
    """Return multipliers, controls and outputs in one mode."""
    inputs, solved = Inputs(problem, precision), _solved_in(problem, mode, precision, t, state)
    found = {name: solved.get(name, 0.0) for name in problem.multipliers}
    multipliers = np.array(list(found.values()))
    accelerations = np.array([solved[name] for name in problem.accelerations])
    given = inputs(t, state), inputs(t, state, multipliers, accelerations=accelerations)
    for program, numbers in zip((problem.controls, problem.outputs), given, strict=True):
        if program is not None:
            values = evaluation(program_in(problem, program, mode.pattern), precision)(numbers)
            found |= dict(zip(program.outputs, as_floats(values), strict=True))
    return found
