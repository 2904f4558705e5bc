"""What every engine is: a motion that has come to an instant and a state, goes on, and says why where it cannot."""

from collections.abc import Callable, Iterator
from math import inf
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from numpy.typing import NDArray

from ...failures import Failure, HolonomError
from ...program.motion_problem import MotionProblem
from ...program.precision import Precision
from ..evaluation import Numbers
from ..hard_cases import HardCase
from ..matrices import MotionMatrices
from ..request import EngineName, SimulationRequest
from .choice import Between

if TYPE_CHECKING:
    from ..mode import Mode

JUDGED_AFTER, MOST_STEPS = 1_000, 1e11  # steps: after which what is left is judged, and which nobody waits for


def require_reach(steps: int, done: Any, left: Any) -> None:
    """Refuse to go on where, by the steps taken so far in the time that is done, the time left takes too many.

    Raises
    ------
    HolonomError
        It takes more than `MOST_STEPS`.
    """
    if steps >= JUDGED_AFTER and steps * float(left) > MOST_STEPS * float(done):
        about = steps * float(left) / float(done) if done > 0 else inf
        raise HolonomError(Failure.TOO_MANY_STEPS, detail=f"the motion takes about {about:.0e} steps to its end")


class Step(NamedTuple):
    """A step of the motion with its dense output."""

    start: Any
    end: Any
    # takes instants of the step, shape (k,), to states, shape (2n, k): coordinates, then velocities
    states: Callable[[NDArray[Any]], NDArray[Any]]
    # mode, impulse: the motion's mode, and the energy that an impulse at the start brought; None from an engine
    mode: "Mode | None" = None
    impulse: Any = None


class Solutions(NamedTuple):
    """What the equations of motion determine at k states."""

    accelerations: Numbers  # shape (n, k)
    # shape (g, k): zero for the constraints that the program leaves out as redundant; where dependent ones are left,
    # the least of all that give the constraint forces
    multipliers: Numbers
    # shape (n, k): J^T lambda, unique; of shape (0, k) where the scene does not observe them
    constraint_forces: Numbers


class Obstacle(HolonomError):
    """Why an engine stopped, where another one may lead on.

    Parameters
    ----------
    t : float
        The instant that is reached.
    reason : str
        A clause about that instant.
    passed : callable
        Whether the obstacle lies behind an instant and a state.
    """

    def __init__(self, t: float, case: HardCase, reason: str, passed: Callable[[Any, Numbers], bool]) -> None:
        super().__init__(Failure.NO_WAY_ON, detail=f"{t:.10g}, where {reason}")
        self.case, self.reason, self.passed = case, reason, passed


class Task(NamedTuple):
    """A motion that an engine is to follow."""

    problem: MotionProblem
    request: SimulationRequest
    precision: Precision
    end: Any  # the last instant
    matrices: MotionMatrices  # of the same motion


class Engine(Protocol):
    """What follows a motion."""

    name: EngineName
    # fixed_pivots, open_parameters: whether it takes the motion program's pivots, and parameters without their values
    fixed_pivots: bool
    open_parameters: bool
    time: Any  # the instant that is reached
    state: Numbers  # shape (2n,): coordinates, then velocities, at that instant
    steps: int  # taken so far
    tol: float  # tolerance of a step
    code: str  # how heyoka compiled it; empty where it did not
    compile_seconds: float
    amid_passage: bool  # whether a singular configuration is so near that only this engine can go on

    @classmethod
    def for_motion(cls, task: Task) -> "Engine":
        """Make the engine of a motion to its end; raises where it cannot follow it as the request asks."""

    @classmethod
    def comparable(cls, tol: float | None) -> bool:
        """Return True if it may begin a motion of that tolerance where no engine is asked for."""

    @classmethod
    def expected_seconds(cls, steps: int, operations: int, tol: float, between: Between) -> float:
        """Seconds that it takes for a motion, arguments as for `quicker_engine`."""

    def restart(self, instant: Any, state: Numbers) -> None:
        """Go on from another instant and state, shape (2n,)."""

    def advance(self, until: Any) -> None:
        """Follow the motion to an instant.

        Raises
        ------
        Obstacle
            The engine cannot, while another one may; time and state are those before the obstacle.
        HolonomError
            The motion itself ends.
        """

    def integrate(self, until: Any) -> Iterator[Step]:
        """Follow the motion to an instant, step by step, with its states between; raises as `advance`.

        A step's states are to be asked for before the next step.
        """

    def solutions(self, instants: Numbers, states: Numbers) -> Solutions:
        """Return what the equations of motion determine at instants, shape (k,), and states, shape (2n, k)."""

    def close(self) -> None:
        """Give back what is held outside of Python; the motion is not followed any more."""
