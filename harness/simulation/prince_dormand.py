"""The integrator of the Runge-Kutta engine: GSL's method of Prince and Dormand on programs compiled to C.

J. Comput. Appl. Math. 7 (1981) 67; `prince_dormand.c` holds what surrounds GSL.
"""

import ctypes
import shlex
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from textwrap import indent
from typing import Any

import numpy as np
from numpy.typing import NDArray

from harness.failures import Failure, HolonomError
from harness.motion.c_function import load_c
from harness.motion.c_source import HELPERS, scalar_statements
from harness.motion.problem import MotionProblem, computing
from harness.motion.program import Program

PROJECTED = 16  # steps after which the state is projected: to project takes as long as a fifth of a step
FUNCTION = """\
static inline void {name}(double t, const double *state, double *out)
{{
{body}
}}
"""
DRIVER = Path(__file__).with_suffix(".c")

Floats = NDArray[np.float64]


class PrinceDormand:
    """Follows a motion in double precision, in C from the first to the last step.

    It has the part of the interface of heyoka's integrators that `harness.simulation.program_motion.Integrator` names.

    Parameters
    ----------
    problem : MotionProblem
        Without an obstacle.
    tol : float
        Relative and absolute.
    projects : bool
        Whether it keeps the constraints.

    Attributes
    ----------
    time : float
    state : ndarray, shape (2n,)
    tol : float

    Raises
    ------
    HolonomError
        There is no C compiler; the GNU Scientific Library is not installed.
    """

    def __init__(self, problem: MotionProblem, tol: float, projects: bool) -> None:
        self.tol = tol
        library = load_c("\n".join(_source(problem, projects)), *_options_of_gsl())
        self._advance, self._go_between = library.advance, library.go_between
        self._advance.argtypes = (ctypes.c_void_p,)
        self._go_between.argtypes = (ctypes.c_double, ctypes.c_double, ctypes.c_void_p)
        library.begin.argtypes = (ctypes.c_double,)
        if library.begin(tol) != 0:
            raise MemoryError
        self._follower = _follower_type(len(problem.state))()
        self._evaluations = ctypes.c_long.in_dll(library, "evaluations")
        self._address = ctypes.addressof(self._follower)
        self.state = np.frombuffer(self._follower.state)
        self.state[:] = [float(problem.start[name]) for name in problem.state]
        self._follower.t = float(problem.start["t"])

    @property
    def time(self) -> float:
        """The instant that is reached; a new one makes the integrator begin anew."""
        return self._follower.t

    @time.setter
    def time(self, instant: float) -> None:
        self._follower.t, self._follower.step = instant, 0.0

    @property
    def evaluations(self) -> int:
        """How often the accelerations have been evaluated."""
        return self._evaluations.value

    @property
    def last_h(self) -> float:
        """Length of the last step."""
        return self._follower.last

    def propagate_until(
        self, until: float, *, max_steps: int, c_output: bool
    ) -> tuple[bool, float, float, int, "Steps | None", None]:
        """Take steps: to an instant, or so many, or until one fails.

        Parameters
        ----------
        until : float
        max_steps : int
        c_output : bool
            Whether the states between the steps are wanted.

        Returns
        -------
        (bool, float, float, int, Steps or None, None)
            Whether a step has failed, the shortest and the longest step without one that `until` cut short, their
            number, the states between them.
        """
        follower = self._follower
        follower.until, follower.most = until, max_steps
        if c_output:
            return self._with_steps(max_steps)
        failed = self._advance(self._address) != 0
        return failed, follower.shortest, follower.longest, follower.taken, None, None

    def _with_steps(self, most: int) -> tuple[bool, float, float, int, "Steps", None]:
        follower, instants, states = self._follower, np.empty(most + 1), np.empty((most, len(self.state)))
        follower.instants, follower.states = instants.ctypes.data, states.ctypes.data
        failed = self._advance(self._address) != 0
        follower.instants = None
        taken = follower.taken
        instants[taken] = follower.t
        steps = Steps(self._go_between, instants[: taken + 1], states[:taken])
        return failed, follower.shortest, follower.longest, taken, steps, None


class Steps:
    """States between steps: each is reached by a step of its own, as exact as those of the motion.

    Parameters
    ----------
    go_between : callable
        Takes an instant, a later one and the address of the state at the first; returns zero.
    times : ndarray, shape (steps + 1,)
    states : ndarray, shape (steps, 2n)
        At the beginnings.
    """

    def __init__(self, go_between: Any, times: Floats, states: Floats) -> None:
        self._go_between, self._states = go_between, states
        self.times = times

    def __call__(self, instants: Floats) -> Floats:
        """The states at instants of the steps, shape (k, 2n)."""
        steps = np.clip(np.searchsorted(self.times, instants, side="right") - 1, 0, len(self._states) - 1)
        found = self._states[steps]
        for begin, instant, state in zip(self.times[steps], instants, found, strict=True):
            if self._go_between(begin, instant, state.ctypes.data) != 0:
                raise HolonomError(Failure.NO_WAY_ON, detail=f"{begin:.10g}, where a step between two others fails")
        return found


def _follower_type(size: int) -> type[ctypes.Structure]:
    """``struct follower`` of `prince_dormand.c`."""
    numbers = [(name, ctypes.c_double) for name in ("t", "until", "step", "last", "shortest", "longest")]
    counts = [(name, ctypes.c_long) for name in ("most", "taken")]
    arrays = [("state", ctypes.c_double * size), ("instants", ctypes.c_void_p), ("states", ctypes.c_void_p)]
    return type("Follower", (ctypes.Structure,), {"_fields_": [*numbers, *counts, *arrays]})


def _source(problem: MotionProblem, projects: bool) -> Iterator[str]:
    places = range(1, len(problem.coordinates) + 1)
    yield from ("#include <math.h>", "#include <stddef.h>", "#include <string.h>", HELPERS)
    yield _function(problem, "accelerations", problem.motion, {f"ddot({name})" for name in problem.coordinates})
    if projects:
        for kind in ("position", "velocity"):
            outputs = {f"{kind}_correction[{place}]" for place in places}
            yield _function(problem, f"{kind}_corrections", problem.projection, outputs)
        yield f"#define PROJECTED {PROJECTED}"
    yield f"#define STATE {len(problem.state)}"
    yield DRIVER.read_text(encoding="utf-8")


def _function(problem: MotionProblem, name: str, program: Program, outputs: set[str]) -> str:
    state = [f"state[{place}]" for place in range(len(problem.state))]
    unused = ["0.0"] * len(problem.multipliers)
    statements = scalar_statements(computing(program, outputs), ["t", *state, *unused])
    return FUNCTION.format(name=name, body=indent("\n".join(statements), " " * 4))


def _options_of_gsl() -> list[str]:
    """What the compiler is told about the library."""
    configuration = shutil.which("gsl-config")
    if configuration is None:
        raise HolonomError(Failure.GSL_MISSING)
    command = [configuration, "--cflags", "--libs"]
    said = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=True).stdout
    return shlex.split(said)
