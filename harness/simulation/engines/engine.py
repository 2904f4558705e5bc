"""Interface of all engines: the time and state of a motion, and its integration.

An engine that cannot continue raises an error with the reason.
"""

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from math import inf
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from numpy.typing import NDArray

from ...failures import ErrorKind, HolonomError
from ...language import translatable
from ...program.motion_problem import MotionProblem
from ..evaluation import Numbers
from ..hard_cases import Difficulty
from ..matrices import MotionMatrices
from ..place_and_reason import place_and_reason
from ..request import EngineName, SimulationRequest

if TYPE_CHECKING:
    from ..mode import Mode

ESTIMATED_AFTER = 1_000  # steps after which the remaining ones are estimated
MOST_STEPS = 1e11  # that are taken


def require_reach(steps: int, done: Any, left: Any) -> None:
    """Reject a motion with too many remaining steps, by the steps taken so far.

    Parameters
    ----------
    steps : int
        Number of steps so far.
    done : number
        Time that they cover.
    left : number
        Remaining time.

    Raises
    ------
    HolonomError
        It takes more than `MOST_STEPS`.
    """
    if steps >= ESTIMATED_AFTER and steps * float(left) > MOST_STEPS * float(done):
        about = steps * float(left) / float(done) if done > 0 else inf
        raise HolonomError(
            ErrorKind.TOO_MANY_STEPS,
            detail=translatable("the motion takes about %(about)s steps to its end", about=f"{about:.0e}"),
        )


class Block(NamedTuple):
    """Consecutive steps whose states may be evaluated together, also later."""

    times: Sequence[Any]  # the start of the first step, then the end of each
    states: Callable[[NDArray[Any]], NDArray[Any]]  # as for `Step`


class Step(NamedTuple):
    """A step of the motion with its dense output."""

    start: Any
    end: Any
    # takes times of the step, shape (k,), to states, shape (2n, k): coordinates, then velocities
    states: Callable[[NDArray[Any]], NDArray[Any]]
    # mode, impulse: the motion's mode, and the energy that an impulse at the initial time brought; None from an engine
    mode: "Mode | None" = None
    impulse: Any = None
    block: Block | None = None  # that it is a step of, or a part of one


class Solutions(NamedTuple):
    """The unknowns of the equations of motion at k states."""

    accelerations: Numbers  # shape (n, k)
    # shape (g, k): zero for the constraints that the program leaves out as redundant; where dependent ones are left,
    # the least of all that give the constraint forces
    multipliers: Numbers
    # shape (n, k): J^T lambda, unique; of shape (0, k) where the scene does not observe them
    constraint_forces: Numbers


class Obstruction(HolonomError):
    """The reason for which an engine stopped, if another one may continue.

    Parameters
    ----------
    t : float
        The time that is reached.
    case : Difficulty or None
        The hard case that the motion is there, if it is one.
    cause : str
        A clause about that time.
    passed : callable
        Whether the obstruction lies behind a time and a state.
    """

    def __init__(self, t: float, case: Difficulty | None, cause: str, passed: Callable[[Any, Numbers], bool]) -> None:
        super().__init__(ErrorKind.NO_WAY_ON, detail=place_and_reason(t, cause))
        self.case, self.cause, self.passed = case, cause, passed


class Task(NamedTuple):
    """The task of an engine: a motion and its request."""

    problem: MotionProblem
    request: SimulationRequest
    end: Any  # the last time, or None for the next one that it reaches
    matrices: MotionMatrices  # of the same motion

    @classmethod
    def of(cls, problem: MotionProblem, **asked: Any) -> "Task":
        """Return the task of a motion whose end is not known.

        Parameters
        ----------
        problem : MotionProblem
            The motion.
        **asked : object
            Fields of `SimulationRequest`.

        Returns
        -------
        Task
        """
        return cls(problem, SimulationRequest(**asked), None, MotionMatrices(problem))


def advance(engine: "Engine", until: Any) -> None:
    """Integrate to a time without the steps.

    Parameters
    ----------
    engine : Engine
        The engine.
    until : number
        Last time.

    Raises
    ------
    Obstruction, HolonomError
        As `Engine.integrate`.
    """
    deque(engine.integrate(until, dense=False), maxlen=0)


class Engine(Protocol):
    """The interface of an engine.

    Parameters
    ----------
    task : Task
        The motion, the request and the numbers.

    Raises
    ------
    HolonomError
        The engine does not support the request.
    """

    name: EngineName
    # fixed_pivots, open_parameters: whether it takes the motion program's pivots, and parameters without their values
    fixed_pivots: bool
    open_parameters: bool
    time: Any  # the time that is reached
    state: Numbers  # shape (2n,): coordinates, then velocities, at that time
    steps: int  # taken so far
    tol: float  # tolerance of a step
    code: str  # how heyoka compiled it; empty where it did not
    compile_seconds: float
    near_singularity: bool  # whether a singular configuration is so near that only this engine can continue

    def __init__(self, task: Task) -> None: ...

    @classmethod
    def comparable(cls, tol: float | None) -> bool:
        """Return True if the engine may be chosen by default for a tolerance.

        Parameters
        ----------
        tol : float or None
            Tolerance of a step, or None if none is requested.

        Returns
        -------
        bool
        """

    @classmethod
    def expected_seconds(cls, steps: int, operations: int, tol: float, dense: bool) -> float:
        """Return the expected time of a motion.

        Parameters
        ----------
        steps, operations, tol, dense : int, int, float, bool
            As for `quicker_engine`.

        Returns
        -------
        float
            In seconds.
        """

    def restart(self, time_point: Any, state: Numbers) -> None:
        """Continue from another time and state.

        Parameters
        ----------
        time_point : number
            The new time.
        state : ndarray, shape (2n,)
            Coordinates, then velocities.
        """

    def integrate(self, until: Any, dense: bool = True) -> Iterator[Step]:
        """Integrate to a time and yield steps with their states.

        Parameters
        ----------
        until : number
            Last time.
        dense : bool
            False if the steps are not needed. An engine may take them at once then.

        Yields
        ------
        Step
            Its states are available only until the next step.

        Raises
        ------
        Obstruction
            The engine cannot continue, but another one may. Time and state are those before the obstruction.
        HolonomError
            The motion itself ends.
        """

    def solutions(self, times: Numbers, states: Numbers) -> Solutions:
        """Return the unknowns of the equations of motion at times and states.

        Parameters
        ----------
        times : ndarray, shape (k,)
            Times that the engine has passed.
        states : ndarray, shape (2n, k)
            States at these times.

        Returns
        -------
        Solutions
        """

    def close(self) -> None:
        """Free resources outside of Python. The motion cannot be continued."""
