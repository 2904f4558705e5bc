"""Whether a step of DOP853 was as long as its stability allows: the sign of a stiff motion.

Two stages of the method fall on the end of the step. How much the rates differ between them, beside the states,
estimates the stiffness (Hairer, Norsett & Wanner, Solving Ordinary Differential Equations II, section IV.2).
"""

import numpy as np
from scipy.integrate import DOP853

BOUNDARY = 6.1  # of DOP853's stability on the negative real axis
STEPS = 15  # at the boundary, one after the other, before a motion counts as stiff


class StiffnessWatch:
    """Counts the steps at the boundary of stability."""

    def __init__(self) -> None:
        self._found = 0

    def stiff(self, solver: DOP853) -> bool:
        """Look at the step just taken: whether so many steps met the boundary that the motion is stiff."""
        self._found = self._found + 1 if at_boundary(solver) else 0
        return self._found >= STEPS


def at_boundary(solver: DOP853) -> bool:
    """Whether the last step was as long as the method's stability allows."""
    step, last = solver.t - solver.t_old, solver.n_stages - 1
    before = solver.y_old + step * (solver.K[:last].T @ solver.A[last, :last])
    states, rates = np.linalg.norm(solver.y - before), np.linalg.norm(solver.f - solver.K[last])
    return bool(states > 0 and step * rates > BOUNDARY * states)
