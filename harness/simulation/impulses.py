"""Derivatives of the state behind an impulse.

The momenta p = dL/d dot(q) change along the constraints' gradients alone, and the new velocities v satisfy the
constraints:

    p+(q, v) - p-(q, dot q) = J^T Lambda,    J v + f_t = 0.

Differentiated, with A = dp+/dv,

    A dv - J^T dLambda = dp- - dp+ + dJ^T Lambda,    J dv + d(J v + f_t) = 0,

where the differentials on the right are those at constant v.
"""

from collections.abc import Sequence

import numpy as np

from .constraints.factorization import factored_constraints
from .evaluation import Numbers
from .mode import Mode
from .variation import Variation


def moves_behind_impulse(
    before: Mode, after: Mode, directions: Sequence[str], t: float, states: tuple[Numbers, Numbers], moves: Numbers
) -> Numbers:
    """Return the derivatives of the state behind an impulse at a given time.

    Parameters
    ----------
    before, after : Mode
        Modes on both sides.
    directions : sequence of str
        Parameters, names of the state, and ``t``.
    t : float
        Time of the impulse.
    states : (ndarray, ndarray), each of shape (2n,)
        States before and behind it.
    moves : ndarray, shape (2n, p)
        Derivatives of the state before it.

    Returns
    -------
    ndarray, shape (2n, p)
    """
    n, (old, new), problem, times = len(moves) // 2, states, after.problem, np.array([t])
    at_constant_velocity = np.concatenate([moves[:n], np.zeros_like(moves[n:])])

    def momenta(mode: Mode, state: Numbers, moves: Numbers) -> tuple[Numbers, Numbers]:
        program = mode.momentum_program
        variation = Variation(mode.whole, program, tuple(program.outputs), directions)
        return mode.momenta_at(t, state), variation(times, state[:, None], moves[:, :, None])[:, :, 0]

    before_it, change_before = momenta(before, old, moves)
    behind_it, change_behind = momenta(after, new, at_constant_velocity)
    here, independent = after.matrices.independent(t, new), list(problem.independent)
    factors = factored_constraints(here.mass, here.jacobian)
    _, impulses = factors.unknowns(before_it - behind_it, np.zeros(len(independent)))
    rows = [f"residual_rate[{beta + 1}]" for beta in independent]
    slopes = {
        f"J[{beta + 1},{s + 1}]": (s, impulse)
        for beta, impulse in zip(independent, impulses, strict=True)
        for s in range(n)
    }
    slopes = {name: place for name, place in slopes.items() if name in problem.matrices.outputs}
    variation = Variation(problem, problem.matrices, (*rows, *slopes), directions)
    missed, turned = np.split(variation(times, new[:, None], at_constant_velocity[:, :, None])[:, :, 0], [len(rows)])
    right = change_before - change_behind
    for row, (s, impulse) in zip(turned, slopes.values(), strict=True):
        right[s] += impulse * row
    velocities = [factors.accelerations(*column) for column in zip(right.T, missed.T, strict=True)]
    return np.concatenate([moves[:n], np.array(velocities).T])
