"""Programs of a motion with derivatives by parameters, initial values and time.

A state moves in a direction by X, shape (2n,). Then a program's output changes by its gradient along X, and by its own
derivative if the direction is an input of the program.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from math import floor, log10

import numpy as np

from ..failures import ErrorKind, HolonomError
from ..program.differentiation import along, derivative_name, differentiated
from ..program.motion_problem import MotionProblem
from ..program.motion_program import Program
from ..program.precision import read_precision
from ..program.rewriting import ONE, computing
from .evaluation import Evaluation, Numbers, evaluation
from .inputs import Inputs

TIME = "t"


def size_of(problem: MotionProblem, name: str) -> Fraction:
    """Return the scale of a direction: a parameter's power of ten, or one.

    Parameters
    ----------
    problem : MotionProblem
        The motion, with values of its parameters.
    name : str
        Direction.

    Returns
    -------
    Fraction
    """
    value = problem.values.get(name)
    return Fraction(10) ** floor(log10(abs(value))) if value else ONE


def no_sensitivity(reason: str) -> HolonomError:
    """Return the error of a motion without the derivatives that are asked for.

    Parameters
    ----------
    reason : str
        Clause about them.

    Returns
    -------
    HolonomError
    """
    return HolonomError(ErrorKind.NO_SENSITIVITY, detail=reason)


class Variation:
    """Derivatives of a program's outputs in directions, compiled.

    Parameters
    ----------
    problem : MotionProblem
        Without signs.
    program : Program
        One of its programs.
    outputs : sequence of str
        Those of its outputs that are differentiated.
    directions : sequence of str
        Parameters, names of the state, and ``t``.
    solved : sequence of str
        The multipliers, then the accelerations that the program takes: inputs other than the state.
    """

    def __init__(
        self,
        problem: MotionProblem,
        program: Program,
        outputs: Sequence[str],
        directions: Sequence[str],
        solved: Sequence[str] = (),
    ) -> None:
        self._shape = len(outputs), len(directions)

        def build() -> Evaluation:
            own = {name: {name: size_of(problem, name)} for name in directions if name not in problem.state}
            found = differentiated(computing(program, outputs), along((*problem.state, *solved), directions) | own)
            rates = {name: found.outputs[name] for name in (derivative_name(y, k) for y in outputs for k in directions)}
            return evaluation(computing(replace(found, outputs=rates), rates), read_precision("double"))

        sizes = (size_of(problem, name) for name in directions)
        kind = ("variation", *directions, *sizes, *solved, *outputs)
        self._evaluate = problem.once(kind, program, build)
        self._inputs = Inputs(problem)

    def __call__(
        self,
        times: Numbers,
        states: Numbers,
        moves: Numbers,
        multipliers: Numbers | None = None,
        accelerations: Numbers | None = None,
    ) -> Numbers:
        """Evaluate the derivatives.

        Parameters
        ----------
        times : ndarray, shape (k,)
        states : ndarray, shape (2n, k)
        moves : ndarray, shape (2n + solved, p, k)
            How the state and what is solved move in each direction.
        multipliers, accelerations : ndarray, shape (g, k), shape (n, k), or None
            As for `Inputs`.

        Returns
        -------
        ndarray, shape (outputs, p, k)
        """
        k = len(times)
        here = self._inputs(times, states, multipliers, accelerations=accelerations)
        inputs = np.concatenate([here, moves.reshape(-1, k)])
        return self._evaluate(np.ascontiguousarray(inputs)).reshape(*self._shape, k)
