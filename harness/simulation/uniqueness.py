"""Outputs that are not unique, because of multipliers of redundant constraints.

Reactions of joints are among them. All multipliers lambda + mu with J^T mu = 0 give the same motion. An output is
unique if no mu changes it.
"""

import numpy as np

from ..program.motion_problem import MotionProblem
from ..program.precision import read_precision
from .constraints.directions import or_one
from .evaluation import as_floats, evaluation_once
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
