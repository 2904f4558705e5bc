"""Programs as functions in the numbers of a run: compiled by heyoka in a few milliseconds, and not to the utmost.

One evaluation takes about a microsecond in double precision, most of it the call; the compilation's optimiser would
take longer than it ever gains at the few states where these are wanted.
"""

import os
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..program.heyoka_function import COMPACT_FROM, heyoka_expressions, import_heyoka
from ..program.motion_problem import MotionProblem
from ..program.motion_program import Program
from ..program.precision import Precision

Numbers = NDArray[Any]  # floats in double precision, heyoka's own numbers beyond
Evaluation = Callable[[Numbers], Numbers]


def evaluation(program: Program, precision: Precision) -> Evaluation:
    """Compile a program.

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
    """Compile a program of a problem, once for all values of its open parameters."""
    return problem.once(("evaluation", precision.name), program, lambda: evaluation(program, precision))


def lane_evaluation(problem: MotionProblem, program: Program) -> Evaluation:
    """Compile a program of a problem, once, to be evaluated at many points in double precision.

    Returns
    -------
    callable
        Takes the inputs, shape (inputs, points), to the outputs, shape (outputs, points). What comes out at a point
        does not hang on the other points, to the last bit: all go through the same vector instructions, because what
        is missing to full vectors is filled up.
    """
    heyoka = import_heyoka()

    def build() -> Evaluation:
        variables = {name: heyoka.expression(name) for name in program.inputs}
        outputs = list(heyoka_expressions(program, variables).values())
        compact = program.operations >= COMPACT_FROM
        return in_full_vectors(heyoka.cfunc(outputs, vars=list(variables.values()), compact_mode=compact))

    return problem.once("lanes", program, build)


def in_full_vectors(function: Callable[[Numbers], Numbers]) -> Evaluation:
    """A function of heyoka's that takes points in full vectors only, shape (inputs, points)."""
    width = import_heyoka().recommended_simd_size()

    def evaluate(inputs: Numbers) -> Numbers:
        points = inputs.shape[1]
        missing = -points % width
        filled = np.concatenate([inputs, np.repeat(inputs[:, -1:], missing, axis=1)], axis=1) if missing else inputs
        return function(np.ascontiguousarray(filled))[:, :points]

    return evaluate


def zeros(precision: Precision, *shape: int) -> Numbers:
    """An array of zeros of these numbers."""
    array = np.empty(shape, dtype=np.asarray([precision.number("0")]).dtype)
    array[...] = precision.number("0")
    return array


def as_floats(numbers: Numbers) -> NDArray[np.float64]:
    """The same numbers in double precision."""
    return np.array([float(number) for number in numbers])


def wake_compiler() -> None:
    """Compile next to nothing: heyoka's first compilation takes 0.1 s longer than any other, best while one waits."""
    heyoka = import_heyoka()
    heyoka.cfunc([heyoka.expression("x")], vars=[heyoka.expression("x")], opt_level=0)


def one_blas_thread() -> AbstractContextManager[object]:
    """Keep BLAS to one thread inside the block.

    Matrices here have some dozens of rows. On a busy machine BLAS takes twenty times as long for them with its threads
    as without, as measured.
    """
    if os.environ.get("OPENBLAS_NUM_THREADS") == "1":  # told before it was loaded, as the command line does
        return nullcontext()
    from threadpoolctl import threadpool_limits

    return threadpool_limits(1, "blas")
