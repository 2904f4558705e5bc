"""Modes that end or begin at a branch point, as contacts with a force of Hertz do.

Engines take ever shorter steps before a branch point, and do not reach it. The rest of the time is so short that the
accelerations are constant to rounding. Behind it, rounding or the projection onto the constraints may leave the state
on the other side, where the force is not real.
"""

from typing import TYPE_CHECKING, Any

import numpy as np

from .engines.engine import Step
from .evaluation import Numbers, as_floats
from .events import Values
from .nominal import Nominal

if TYPE_CHECKING:
    from .mode import Mode

REST = 1e-8  # of the time span: how long before a branch point engines give up
CONSTANT = 1e-13  # of the nominal velocities: changes of the velocities that rounding hides
DOUBLINGS = 10  # of the least time


def last_step(mode: "Mode", until: Any, span: float, nominal: Nominal) -> Step | None:
    """Return the step from the time of the engine to a switching surface close to it.

    Parameters
    ----------
    mode : Mode
        The mode, whose engine gave up.
    until : number
        Last time that is requested.
    span : float
        The time span of the motion.
    nominal : Nominal
        Nominal sizes of the state.

    Returns
    -------
    Step or None
        None if none is close, or the accelerations change until then.
    """
    t, state = mode.engine.time, mode.engine.state.copy()
    changes = _accelerations(mode, t, state)

    def states(times: Numbers) -> Numbers:
        since = times - t
        velocities, accelerations = state[n:, None], changes[:, None]
        moved = state[:n, None] + since * (velocities + since * accelerations / 2)
        return np.concatenate([moved, velocities + since * accelerations])

    n = len(changes)
    step = Step(t, min(until, t + REST * span), states, mode=mode)
    crossing = mode.switching_functions.first_crossing(step, {})
    if crossing is None:
        return None
    half = (crossing.t - t) / 2
    later = _accelerations(mode, t + half, states(np.array([t + half]))[:, 0])
    lost = np.abs(later - changes) * float(crossing.t - t)
    return step if (lost <= CONSTANT * nominal.velocities).all() else None


def real_state(functions: Values, mode: "Mode", t: Any, state: Numbers, least: Any) -> Numbers:
    """Return a state in which functions are real, moved within the tolerance.

    Parameters
    ----------
    functions : callable
        Takes times, shape (k,), and states, shape (2n, k), to values of the functions.
    mode : Mode
        The mode in which the state was reached.
    t : number
        Time of the state.
    state : ndarray, shape (2n,)
        Coordinates, then velocities.
    least : number
        Least time along the motion that counts.

    Returns
    -------
    ndarray, shape (2n,)
        `state` itself if no such state is found.
    """
    later, rates = 0 * least, np.concatenate([state[len(state) // 2 :], np.nan_to_num(_accelerations(mode, t, state))])

    def is_real(later: Any) -> bool:
        return bool(np.isfinite(as_floats(functions(np.array([t]), (state + later * rates)[:, None]))).all())

    for doubling in range(DOUBLINGS):
        if is_real(later) and is_real(later - least):
            return state + later * rates
        later = least * 2**doubling
    return state


def _accelerations(mode: "Mode", t: Any, state: Numbers) -> Numbers:
    return as_floats(mode.engine.solutions(np.array([t]), state[:, None]).accelerations[:, 0])
