"""The Runge-Kutta engine: GSL's method of order 8 on the motion program in C.

Its tolerance is that of a step, as the Taylor engine's is. It takes less time than the Taylor engine where a tolerance
is not fine and the program long; and for short runs, since all of a run is one call.
"""

import time

from ...failures import Failure, HolonomError
from ...program.motion_problem import MotionProblem
from ...program.precision import read_precision
from ..request import Stabilization
from .prince_dormand import PrinceDormand
from .program_motion import ProgramMotion

FINEST, USUAL = 1e-14, 1e-12  # tolerances; below the first, rounding decides about the steps


class RungeKuttaMotion(ProgramMotion):
    """A motion followed by the method of Prince and Dormand, in double precision.

    Parameters
    ----------
    problem : MotionProblem
        Without an obstacle.
    tol : float or None
        Tolerance of a step, relative and absolute; None for `USUAL`.
    drift : Stabilization
        ``PROJECTION`` or ``NONE``.

    Raises
    ------
    HolonomError
        The tolerance is finer than the method holds; there is no such cure of drift; there is no C compiler or no GNU
        Scientific Library.
    """

    def __init__(
        self, problem: MotionProblem, tol: float | None = None, drift: Stabilization = Stabilization.PROJECTION
    ) -> None:
        super().__init__(problem, read_precision("double"), failed=True)
        if drift not in (Stabilization.PROJECTION, Stabilization.NONE):
            raise HolonomError(Failure.NO_SUCH_CURE, detail=drift)
        if tol is not None and not FINEST <= tol < 1:
            holds = f"the Runge-Kutta engine holds tolerances from {FINEST:g} to 1, not {tol:g}"
            raise HolonomError(Failure.TOLERANCE_UNHELD, detail=holds)
        self.tol = USUAL if tol is None else tol
        begun = time.perf_counter()
        self._integrator = PrinceDormand(
            problem, self.tol, drift is Stabilization.PROJECTION and bool(problem.multipliers)
        )
        self.state = self._integrator.state
        self.compile_seconds = time.perf_counter() - begun

    @property
    def evaluations(self) -> int:
        """How often the motion program has been evaluated so far."""
        return self._integrator.evaluations
