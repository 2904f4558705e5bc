"""Roots along a motion whose arguments touch zero.

The square root of x^2 + y^2 is |x| on the line y = 0. A step across the zero of its argument continues the root with
the wrong sign, as an analytic function, and no estimate of its error shows that. So arguments of roots are examined
along the whole motion, as switching functions are (`zeros.py`). If one touches zero, the velocities behind it must
change by the integral of the accelerations. If they do not, the motion begins anew behind the zero, or ends there if
the accelerations jump: friction in a plane sticks from then on, and a spring of no length has no direction.

The angle atan2(y, x) is continued beyond its cut in the same way.

Roots whose argument has a sign of its own, as Hertz's force, are followed by the modes of the motion.
"""

from dataclasses import replace

import numpy as np

from ..program.friction import Pattern
from ..program.motion_problem import MotionProblem
from ..program.motion_program import Call, Expression, Name, Operation, Program, calls_in, names_in
from ..program.precision import Precision
from ..program.rewriting import computing
from ..program.sign_pattern import program_in
from .accuracy_check import finest, is_root
from .defect import DefectControl
from .engines.engine import Step
from .evaluation import Numbers, as_floats, evaluation_once
from .inputs import Inputs
from .zeros import BETWEEN, CONSTANT, TO_COEFFICIENTS, Crossing, SignedFunctions, narrow_dip

MARGIN = 1e3  # of a tolerance: the velocities of a step are not that wrong
EDGES = np.concatenate([[0.0], 2.0 ** np.arange(-40, 1)])  # of what is behind a zero: roots begin there


def radicands(problem: MotionProblem, program: Program | None = None) -> Program | None:
    """Return the arguments of roots of the state, without those that contain signs.

    For atan2(y, x) it is sqrt(x^2 + y^2) + x, which is zero on its cut.

    Parameters
    ----------
    problem : MotionProblem
        The motion.
    program : Program or None
        One of its programs, in which to look for roots. Default: its matrices.

    Returns
    -------
    Program or None
        With outputs ``radicand[1]``, ``radicand[2]``, ..., or None without any.
    """
    program = problem.matrices if program is None else program
    found = _radicands_of(program, set(problem.state), {sign.name for sign in problem.signs})
    if not found:
        return None
    named = {f"radicand[{place}]": each for place, each in enumerate(found, start=1)}
    with_arguments = replace(
        program, assignments=(*program.assignments, *named.items()), outputs={name: Name(name) for name in named}
    )
    return computing(with_arguments, named.keys())


def _radicands_of(program: Program, moving: set[str], signed: set[str]) -> list[Expression]:
    found: dict[Expression, None] = {}
    for name, expression in program.assignments:
        for vanishing in filter(None, map(_vanishing_at_branch, calls_in(expression))):
            names = names_in(vanishing)
            if names & moving and not names & signed:
                found[vanishing] = None
        for names in (moving, signed):
            if names_in(expression) & names:
                names.add(name)
    return list(found)


def _vanishing_at_branch(call: Call) -> Expression | None:
    """Return the function that vanishes where an operation has another branch.

    It is the argument of a root, and for atan2(y, x), whose cut is y = 0, x < 0, it is sqrt(x^2 + y^2) + x.
    """
    if is_root(call):
        return call.arguments[0]
    if call.operation is not Operation.ARCTAN2:
        return None
    squares = tuple(Call(Operation.MULTIPLY, (each, each)) for each in call.arguments)
    return Call(Operation.ADD, (Call(Operation.SQRT, (Call(Operation.ADD, squares),)), call.arguments[1]))


class Radicands(SignedFunctions):
    """The arguments of roots along one mode of a motion.

    Parameters
    ----------
    problem : MotionProblem
        With its signs.
    pattern : Pattern
        The signs of the mode.
    program : Program
        As `radicands` returns it.
    span : float
        Length of the time span.
    tol : float
        Tolerance of a step.
    """

    touching = 1e-6  # the accelerations decide

    def __init__(
        self,
        problem: MotionProblem,
        pattern: Pattern,
        program: Program,
        precision: Precision,
        span: float,
        tol: float,
    ) -> None:
        super().__init__(precision, span)
        self._rows = [(name, -1, 1) for name in program.outputs]
        self._inputs = Inputs(problem, precision)
        self._evaluate = evaluation_once(problem, program_in(problem, program, pattern), precision)
        self._defect, self._most = DefectControl(span, precision), MARGIN * max(tol, finest(precision))
        self._edges = precision.numbers(EDGES)

    def values(self, times: Numbers, states: Numbers) -> Numbers:
        """Return the arguments of the roots (see `SignedFunctions.values`)."""
        return as_floats(np.array(self._evaluate(self._inputs(times, states))))

    def lost(self, step: Step) -> float | None:
        """Return the time at which a step crosses a zero without the accelerations.

        Parameters
        ----------
        step : Step
            A step of the mode, up to its end.

        Returns
        -------
        float or None
        """
        zero = self.first_crossing(step, {})
        if zero is None or not zero.t < step.end:
            return None
        edges = zero.t + (step.end - zero.t) * self._edges
        return zero.t if self._defect.between(edges, step) > self._most else None

    def agrees(self, step: Step) -> bool:
        """Return True if the velocities change by the integral of the accelerations.

        Parameters
        ----------
        step : Step
            A step of the mode, up to its end.

        Returns
        -------
        bool
        """
        edges = step.end - (step.end - step.start) * self._edges[::-1]
        return self._defect.between(edges, step) <= self._most

    def _in_row(self, step: Step, row: int, places: Numbers, values: Numbers, first: int) -> Crossing | None:
        """Return the first sample or minimum that is small, of either sign."""
        name, to, _ = self._rows[row]
        if not np.isfinite(values).all():
            return None
        touched = self.touching * np.max(np.abs(values))
        if values[0] <= touched:
            return Crossing(places[0], name, to)
        coefficients = TO_COEFFICIENTS @ values[1:-1]
        around = narrow_dip(coefficients - touched * CONSTANT, BETWEEN @ coefficients, 0.0, 1.0)
        if around is not None:
            times, found = self._samples(step, around)
            if found[row, 1] <= touched:
                return Crossing(times[1], name, to)
        return Crossing(places[-1], name, to) if values[-1] <= touched else None
