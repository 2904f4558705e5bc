"""A close look at the constraints, where an engine's steps shrink: which of them fail, and when.

In the mass metric and scaled to length one, the constraints' directions have a least singular value. Where it runs to
zero the configuration is singular: constraints become dependent. A constraint whose gradient itself runs to zero, a
length that shrinks to nothing, does not show in it; that shows beside the gradient at the start.
"""

from ...program.motion_problem import MotionProblem
from ..evaluation import Numbers, as_floats
from ..matrices import MotionMatrices
from .factorization import WeightedConstraints, weighted_constraints
from .vanishing import VANISHED

REACH = 2.0  # steps ahead within which a singular configuration counts as near
SMALL = 0.5  # least singular value above which none is near, however fast it falls


class Watch:
    """Watches the constraints of a motion.

    Parameters
    ----------
    problem : MotionProblem
    """

    def __init__(self, problem: MotionProblem) -> None:
        self._names, self._matrices = problem.multipliers, MotionMatrices(problem)
        start = [float(problem.start[name]) for name in problem.state]
        self._scale = self._constraints(float(problem.start["t"]), start).scale
        self._least = 1.0

    def begin(self, t: float, state: Numbers) -> None:
        """Look at the state from which the watch goes on."""
        self._least = self.least(t, state)

    def singular_ahead(self, t: float, state: Numbers) -> bool:
        """Whether the next steps, if they are like the last one, reach a singular configuration.

        Parameters
        ----------
        t : float
            After the step.
        state : ndarray, shape (2n,)

        Returns
        -------
        bool
        """
        last, self._least = self._least, self.least(t, state)
        return self._least < SMALL and self._least < REACH * (last - self._least)

    def least(self, t: float, state: Numbers) -> float:
        """Least singular value of the constraints' directions; one where there is none."""
        return float(self._constraints(t, state).singular_values().min(initial=1.0))

    def vanished(self, t: float, state: Numbers) -> str | None:
        """The multiplier whose constraint has lost its gradient, if there is one."""
        left = self._scale / self._constraints(t, state).scale
        return self._names[left.argmin()] if left.min(initial=1.0) < VANISHED else None

    def _constraints(self, t: float, state: Numbers) -> WeightedConstraints:
        at = self._matrices(float(t), as_floats(state))
        return weighted_constraints(at.mass, at.jacobian)
