"""The Runge-Kutta engine: the Dormand-Prince method of order 8 in C.

Its steps are compiled for the motion program (`dormand_prince.c`). Its tolerance is that of a step, as for the Taylor
engine. It takes less time than the Taylor engine for coarse tolerances and long programs, and for short runs, since a
whole run is one call.
"""

import ctypes
import time
import weakref
from collections.abc import Iterator
from functools import partial
from itertools import pairwise
from math import inf
from pathlib import Path
from textwrap import indent
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...failures import ErrorKind, HolonomError
from ...language import translatable
from ...program.c_function import has_compiler, load_c, unload
from ...program.c_source import HELPERS, scalar_statements
from ...program.motion_problem import MotionProblem
from ...program.motion_program import Program
from ...program.rewriting import computing
from ...program.sign_pattern import with_values_in
from ..inputs import named_inputs
from ..matrices import start_of
from ..nominal import Nominal
from ..request import EngineName, Stabilization
from .code import REFERENCE
from .engine import Block, Step, Task
from .program_engine import SHRUNK, ProgramEngine, Taken

FINEST, USUAL = 1e-14, 1e-12  # tolerances; below the first, rounding decides about the steps
# seconds a step takes for an operation, in all its stages, and for everything else
STAGES, STEP = 7.5e-9, 2e-7
STRIDE = 0.89  # steps for one of the Taylor engine
DENSE, DENSER = 8, 1.25  # rows of the dense output; its cost, three stages relative to twelve
ORDER = 8  # what its steps shrink with
COMPILER = 0.15, 5e-4  # seconds that the C compiler takes, and for an operation

PROJECTED = 16  # steps after which the state is projected: to project takes as long as a fifth of a step
# Numbers that are written one by one are not yet there for those who read them as vectors: on few of them, vectors cost
# a tenth to a fifth of the time, on 32 they save a fifth.
WIDE, NO_VECTORS = 16, ("-fno-tree-vectorize",)
# A motion of few operations is repeated in every stage, without calls and loops, and takes a sixth to a quarter less
# time. A longer one takes no less to run, and longer to compile.
SMALL, UNROLLED = 64, ("-O3",)
FUNCTION = """\
static inline void {name}(double t, const double *state, double *out)
{{
{body}
}}
"""
DRIVER = Path(__file__).with_name("dormand_prince.c")

Floats = NDArray[np.float64]


class RungeKuttaEngine(ProgramEngine):
    """The Dormand-Prince engine in double precision (see `Engine`).

    Parameters
    ----------
    task : Task

    Raises
    ------
    HolonomError
        The tolerance is finer than the method holds, or there is no C compiler.
    """

    name, fixed_pivots, open_parameters = EngineName.RUNGE_KUTTA, True, False

    def __init__(self, task: Task) -> None:
        request = task.request
        if request.numbers.name != "double":
            raise HolonomError(ErrorKind.RUNGE_KUTTA_IS_DOUBLE, detail=request.numbers.name)
        super().__init__(task._replace(problem=with_values_in(task.problem)), True)
        self.tol = USUAL if request.tol is None else request.tol
        if not FINEST <= self.tol < 1:
            holds = translatable(
                "the Runge-Kutta engine holds tolerances from %(finest)s to 1, not %(tol)s",
                finest=f"{FINEST:g}",
                tol=f"{self.tol:g}",
            )
            raise HolonomError(ErrorKind.TOLERANCE_OUT_OF_RANGE, detail=holds, option="--tol")
        begun, problem = time.perf_counter(), self._problem
        stabilization = request.stabilization if problem.multipliers else Stabilization.NONE
        self._integrator = _DormandPrince(problem, self.tol, stabilization, self.decay, self._matrices.nominal)
        self._longest_step = request.max_step or inf
        self._bound_steps(None)
        self.state = self._integrator.state
        self.compile_seconds = time.perf_counter() - begun

    @classmethod
    def comparable(cls, tol: float | None) -> bool:
        """Return True if C compiles it and holds it (see `Engine.comparable`)."""
        return tol is not None and FINEST <= tol < 1 and has_compiler()

    @classmethod
    def expected_seconds(cls, steps: int, operations: int, tol: float, dense: bool) -> float:
        """Return the time of compilation and steps (see `Engine.expected_seconds`)."""
        taken = STRIDE * steps * (REFERENCE / tol) ** (1 / ORDER) * (DENSER if dense else 1.0)
        begun, each = COMPILER
        return begun + each * operations + taken * (STEP + STAGES * operations)

    def _blocks(self, until: float, dense: bool) -> Iterator[Step]:
        """Take blocks, in one call of C to a near time without an obstruction before it."""
        if not dense and self._defect is None:
            integrator = self._integrator
            self._begin()
            if self._obstruction is None:
                self.steps += integrator.quiet_steps(until, self._first_block)
                if integrator.time == until:
                    return
                self._usual = max(self._usual, integrator.usual)
        yield from super()._blocks(until, dense)

    def _set_values(self) -> None:
        self._integrator.open_values[:] = self.inputs.open_values(self._integrator.time, "right")

    def _bound_steps(self, length: Any) -> None:
        self._integrator.longest_step.value = min(self._longest_step, length or inf)

    def _with_states(self, until: Any, most: int) -> tuple[Taken, list[Step]]:
        return self._integrator.with_states(until, most)

    def close(self) -> None:
        """Close the compiled functions of the motion, which cannot be continued."""
        self._integrator.close()

    @property
    def evaluations(self) -> int:
        """Number of evaluations of the motion program so far."""
        return self._integrator.evaluations


class _DormandPrince(ctypes.Structure):
    """A Dormand-Prince integrator in double precision, in C for all of its steps.

    It is ``struct follower`` of `dormand_prince.c`, and has the part of the interface of heyoka's integrators that
    `Integrator` names.

    Parameters
    ----------
    tol : float
        Relative, and absolute in terms of nominal sizes.
    stabilization : Stabilization
    decay : float
        gamma.
    nominal : Nominal
        Sizes of the motion's quantities.

    Attributes
    ----------
    time : float
        The time that is reached.
    state : ndarray, shape (2n,)
        At that time, in place.
    last_h : float
        Length of the last step.
    quiet_steps : callable
        Takes a time and a number of steps, and that many steps, or those to the time, if there is nothing to
        watch on the way. Returns their number, 0 where the motion is left as it was.
    open_values : sequence of float
        Of `MotionProblem.open_inputs`, in place.
    longest_step : c_double
        Bound of a step.
    usual : float
        Length of the longest step that `quiet_steps` took since the motion began anew.

    Raises
    ------
    HolonomError
        There is no C compiler.
    """

    _fields_ = (
        ("time", ctypes.c_double),
        ("_state", ctypes.c_void_p),
        *((name, ctypes.c_double) for name in ("_until", "last_h", "_shortest", "_longest", "usual")),
        *((name, ctypes.c_long) for name in ("_most", "_taken")),
        *((name, ctypes.c_void_p) for name in ("_times", "_dense")),
    )

    def __init__(
        self,
        problem: MotionProblem,
        tol: float,
        stabilization: Stabilization,
        decay: float,
        nominal: Nominal,
    ) -> None:
        begin, self.state = start_of(problem)
        super().__init__(begin, self.state.ctypes.data)
        self.tol = tol
        narrow = NO_VECTORS if len(problem.state) < WIDE else ()
        small = UNROLLED if problem.motion.operations < SMALL else ()
        library = load_c("\n".join(_source(problem, stabilization, decay)), *narrow, *small)
        self._advance = library.advance
        self._advance.argtypes = (ctypes.c_void_p,)
        library.advance_quietly.argtypes = (ctypes.c_void_p, ctypes.c_double, ctypes.c_long)
        library.advance_quietly.restype = ctypes.c_long
        self._address = ctypes.addressof(self)
        self.quiet_steps = partial(library.advance_quietly, self._address)
        self._evaluations = ctypes.c_long.in_dll(library, "evaluations")
        self.open_values = (ctypes.c_double * len(problem.open_inputs)).in_dll(library, "open_values")
        self.longest_step = ctypes.c_double.in_dll(library, "longest_step")
        library.begin.argtypes = (ctypes.c_double, ctypes.c_double, ctypes.c_void_p)
        library.begin(tol, nominal.time, np.ascontiguousarray(nominal.state).ctypes.data)
        self._closing = weakref.finalize(self, unload, library)
        self._closing.atexit = False

    def close(self) -> None:
        """Give the memory of the library back, and close it."""
        self._closing()
        del self._advance, self.quiet_steps

    @property
    def evaluations(self) -> int:
        """Number of evaluations of the accelerations."""
        return self._evaluations.value

    def propagate_until(self, until: float, max_steps: int) -> tuple[bool, float, float, int]:
        """Take steps (see `Integrator.propagate_until`)."""
        self._until, self._most = until, max_steps
        failed = self._advance(self._address) != 0
        return failed, self._shortest, self._longest, self._taken

    def with_states(self, until: float, most: int) -> tuple[Taken, list[Step]]:
        """Take steps as `propagate_until` does, each with its states."""
        times, dense = np.empty(most + 1), np.empty((most, DENSE, len(self.state)))
        self._times, self._dense = times.ctypes.data, dense.ctypes.data
        taken = self.propagate_until(until, most)
        self._times = self._dense = None
        times[taken[3]] = self.time
        times, dense = times[: taken[3] + 1], dense[: taken[3], ..., None]
        block = Block(times.tolist(), partial(_states_in, times, dense))
        steps = zip(pairwise(block.times), dense, strict=True)
        return taken, [Step(*ends, partial(_states_of, *ends, rows), block=block) for ends, rows in steps]


def _states_in(ends: Floats, dense: Floats, times: Floats) -> Floats:
    """Return states at times of steps between the ends, shape (2n, k)."""
    place = np.searchsorted(ends[1:-1], times)
    return _states_of(ends[place], ends[place + 1], np.moveaxis(dense[place, ..., 0], 0, -1), times)


def _states_of(start: float | Floats, end: float | Floats, rows: Floats, times: Floats) -> Floats:
    """Return states at times of a step, or of a step each, by the dense output.

    Its order is 7 (Hairer, Norsett & Wanner I, section II.6). Rows have the shape (8, 2n, 1) or (8, 2n, k): the state
    at the initial time, and coefficients of products of x and 1 - x in turn.
    """
    x = (times - start) / (end - start)
    states = np.zeros((rows.shape[1], len(times)))
    for place, row in enumerate(rows[:0:-1]):
        states += row
        states *= x if place % 2 == 0 else 1 - x
    return states + rows[0]


def _source(problem: MotionProblem, stabilization: Stabilization, decay: float) -> Iterator[str]:
    places = range(1, len(problem.coordinates) + 1)
    yield from ("#include <math.h>", "#include <stddef.h>", "#include <string.h>", HELPERS)
    yield f"double open_values[{max(1, len(problem.open_inputs))}];"
    yield _function(problem, "accelerations", problem.motion, problem.accelerations)
    if stabilization is not Stabilization.NONE:
        for kind in ("position", "velocity"):
            outputs = {f"{kind}_correction[{place}]" for place in places}
            yield _function(problem, f"{kind}_corrections", problem.projection, outputs)
        yield from _keeping(stabilization, decay)
    yield f"#define STATE {len(problem.state)}"
    yield f"#define SHRUNK {SHRUNK}"
    yield DRIVER.read_text(encoding="utf-8")


def _keeping(stabilization: Stabilization, decay: float) -> Iterator[str]:
    """Yield C code of the constraint stabilization."""
    if stabilization is Stabilization.PROJECTION:
        yield f"#define PROJECTED {PROJECTED}"
    else:
        yield f"#define {stabilization.name}"
        yield f"#define GAMMA {decay!r}"


def _function(problem: MotionProblem, name: str, program: Program, outputs: set[str]) -> str:
    state = [f"state[{place}]" for place in range(len(problem.state))]
    open_values = [f"open_values[{place}]" for place in range(len(problem.open_inputs))]
    inputs = named_inputs(problem, "t", state, "0.0", open_values)
    statements = scalar_statements(computing(program, outputs), list(inputs.values()))
    return FUNCTION.format(name=name, body=indent("\n".join(statements), " " * 4))
