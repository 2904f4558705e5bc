"""Programs as functions in a precision, compiled by heyoka without optimisation.

One evaluation takes about a microsecond in double precision, most of it the call. The compilation's optimiser would
take longer than it gains at the few states of interest. For very few states, NumPy is done before heyoka has compiled.
"""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..program.heyoka_function import COMPACT_FROM, heyoka_expressions, import_heyoka
from ..program.motion_problem import MotionProblem
from ..program.motion_program import Program
from ..program.numpy_function import NumpyFunction, needs_scipy
from ..program.precision import Precision

COMPILED, COMPILED_OPERATION = 1.2e-2, 6e-5  # seconds that heyoka takes to compile a function, and for an operation
CALLED, OPERATION, OPERATION_AT_POINT = 1e-5, 3.5e-7, 1.5e-9  # seconds that NumPy takes for a call, and in it

Numbers = NDArray[Any]  # floats in double precision, heyoka's own numbers beyond
Evaluation = Callable[[Numbers], Numbers]


def evaluation(program: Program, precision: Precision) -> Evaluation:
    """Compile a program.

    Parameters
    ----------
    program : Program
        Program to compile.
    precision : Precision
        Numbers of inputs and outputs.

    Returns
    -------
    callable
        Takes the inputs, shape (inputs,) or (inputs, points), to the outputs, shape (outputs,) or (outputs, points).

    Raises
    ------
    HolonomError
        heyoka is not installed.
    """
    heyoka = import_heyoka()
    variables = {name: heyoka.expression(name) for name in program.inputs}
    outputs = heyoka_expressions(program, variables, precision.ratio)
    return heyoka.cfunc(
        list(outputs.values()),
        vars=list(variables.values()),
        compact_mode=program.operations >= COMPACT_FROM,
        opt_level=0,
        **precision.options,
    )


def evaluation_once(problem: MotionProblem, program: Program, precision: Precision) -> Evaluation:
    """Compile a program of a problem, once for all values of its open parameters.

    Without open parameters, NumPy evaluates a program in double precision until compilation is worthwhile. A function
    that is cached for later motions is compiled at once. Otherwise their last bits would depend on the motions before.

    Parameters
    ----------
    problem : MotionProblem
        The motion, which stores the compiled function.
    program : Program
        One of its programs.
    precision : Precision
        Numbers of inputs and outputs.

    Returns
    -------
    callable
        As `evaluation`.
    """

    def build() -> Evaluation:
        lazy = precision.name == "double" and not problem.open_inputs and not needs_scipy(program)
        return LazyCompiledFunction(program, precision) if lazy else evaluation(program, precision)

    return problem.once(("evaluation", precision.name), program, build)


class LazyCompiledFunction:
    """A program in double precision, compiled as soon as that is worthwhile.

    NumPy evaluates it until it has taken as long as compilation takes. Times are estimated by numbers of calls, so that
    the same calls have the same results everywhere: measured on programs of 17 to 434 operations.
    """

    def __init__(self, program: Program, precision: Precision) -> None:
        self._program, self._precision, self._by_numpy = program, precision, NumpyFunction(program)
        self._compiled: Evaluation | None = None
        self._left = COMPILED + COMPILED_OPERATION * program.operations

    def __call__(self, inputs: Numbers) -> Numbers:
        """Evaluate the function at inputs of shape (inputs,) or (inputs, points)."""
        if self._compiled is None:
            points = inputs.reshape(len(inputs), -1)
            self._left -= CALLED + self._program.operations * (OPERATION + OPERATION_AT_POINT * points.shape[1])
            if self._left > 0:
                return self._by_numpy.at_points(points).reshape(-1, *inputs.shape[1:])
            self._compiled = evaluation(self._program, self._precision)
        return self._compiled(inputs)


def batch_evaluation(problem: MotionProblem, program: Program) -> Evaluation:
    """Compile a program of a problem, once, for many points in double precision.

    Parameters
    ----------
    problem : MotionProblem
        The motion, which stores the compiled function.
    program : Program
        One of its programs.

    Returns
    -------
    callable
        Takes the inputs, shape (inputs, points), to the outputs, shape (outputs, points). The result at a point does
        not depend on the other points, to the last bit: points are filled up to full vectors, so that all go through
        the same vector instructions.
    """
    heyoka = import_heyoka()

    def build() -> Evaluation:
        variables = {name: heyoka.expression(name) for name in program.inputs}
        outputs = list(heyoka_expressions(program, variables).values())
        compact = program.operations >= COMPACT_FROM
        return in_full_vectors(heyoka.cfunc(outputs, vars=list(variables.values()), compact_mode=compact))

    return problem.once("elements", program, build)


def in_full_vectors(function: Callable[[Numbers], Numbers]) -> Evaluation:
    """Return a function of heyoka's that takes points in full vectors only.

    Parameters
    ----------
    function : callable
        Function compiled by heyoka in double precision.

    Returns
    -------
    callable
        Takes inputs, shape (inputs, points), of any number of points to outputs, shape (outputs, points).
    """
    width = import_heyoka().recommended_simd_size()

    def evaluate(inputs: Numbers) -> Numbers:
        points = inputs.shape[1]
        missing = -points % width
        filled = np.concatenate([inputs, np.repeat(inputs[:, -1:], missing, axis=1)], axis=1) if missing else inputs
        return function(np.ascontiguousarray(filled))[:, :points]

    return evaluate


def zeros(precision: Precision, *shape: int) -> Numbers:
    """Return an array of zeros of a precision.

    Parameters
    ----------
    precision : Precision
        Numbers of the array.
    *shape : int
        Shape of the array.

    Returns
    -------
    ndarray
    """
    if precision.name == "double":
        return np.zeros(shape)
    array = np.empty(shape, dtype=np.asarray([precision.number("0")]).dtype)
    array[...] = precision.number("0")
    return array


def as_floats(numbers: Numbers) -> NDArray[np.float64]:
    """Return numbers in double precision.

    Parameters
    ----------
    numbers : ndarray
        Numbers of any precision.

    Returns
    -------
    ndarray of float
        A new array of the same shape.
    """
    if getattr(numbers, "dtype", None) == np.float64:
        return numbers.copy()
    array = np.asarray(numbers)
    return np.array([float(number) for number in array.ravel()]).reshape(array.shape)


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Limit BLAS to one thread inside the block, or in a decorated function.

    Matrices here have some dozens of rows. On a busy machine BLAS takes twenty times as long for them with its threads
    as without, as measured.

    Yields
    ------
    None
    """
    if os.environ.get("OPENBLAS_NUM_THREADS") == "1":  # set before it was loaded, as the command line does
        yield
        return
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1, "blas"):
        yield
