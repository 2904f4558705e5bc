"""Accuracy check of a result: its errors, compared with its tolerance.

A method whose steps each have an error of the tolerance has a total error of no more than their product times some
power of ten, relative to the size of the quantity. A larger error of a constraint or of the energy shows a missed
feature, lost digits or a tolerance that was not reached.

A function of the state may be faint nearly everywhere and strong in a small region. Rounding swallows an exponential
that is small, or near to its limit. A high power is similar. Its effect shows neither at a few states nor at the
beginning of a step.
"""

from collections.abc import Callable, Collection, Iterator, Mapping
from fractions import Fraction
from sys import float_info
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..program.motion_program import Call, Operation, Program, calls_in, names_in
from ..program.precision import Precision
from .matrices import Matrices, Vector

MARGIN = 1e4
LARGEST = 0.01  # error of a motion, however many its steps
ERROR_TEXT = {
    "energy": "the energy",
    "acceleration": "a force that acts within a step",
    "multipliers": "a multiplier",
}
FINEST = 1e-15  # relative error of a step in double precision, however fine its tolerance
OF_CONSTRAINTS = ("position", "velocity")  # errors that are computed in double precision


class AccuracyViolation(NamedTuple):
    """A quantity with an error too large for the tolerance."""

    # position, velocity, energy, multipliers, or acceleration: of the equations of motion within a step
    quantity: Annotated[str, "Name of the quantity."]
    error: Annotated[float, "Relative error that was found."]
    expected: Annotated[float, "Largest relative error expected at this tolerance."]

    @property
    def reason(self) -> str:
        """Clause that names the quantity, its error and the expected error."""
        what = ERROR_TEXT.get(self.quantity, f"the {self.quantity} that the constraints allow")
        if np.isnan(self.error):
            return f"{what} has no finite value"
        return (
            f"relative error of {what} is {self.error:.1e}; at most {self.expected:.1e} is expected at this tolerance"
        )


def violations(
    errors: Mapping[str, float], tol: float, steps: int, least: float = FINEST
) -> Iterator[AccuracyViolation]:
    """Yield the quantities whose relative error is too large for the tolerance.

    Parameters
    ----------
    errors : mapping of str to float
        Relative error by quantity.
    tol : float
        Tolerance of a step.
    steps : int
        Number of steps taken.
    least : float, optional
        Relative error of a step that rounding may make. That of residuals is `FINEST`.

    Yields
    ------
    AccuracyViolation
    """
    for quantity, value in errors.items():
        most = float(expected(tol, steps, FINEST if quantity in OF_CONSTRAINTS else least))
        if not value <= most:
            yield AccuracyViolation(quantity, value, most)


def trusted(errors: Mapping[str, Vector], tol: float, steps: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return True for each of k motions without unexpected errors.

    Parameters
    ----------
    errors : mapping of str to ndarray, shape (k,)
        Relative errors by quantity.
    tol : float
        Tolerance of a step.
    steps : ndarray of int, shape (k,)
        Number of steps of each motion.

    Returns
    -------
    ndarray of bool, shape (k,)
    """
    return np.logical_and.reduce([values <= expected(tol, steps) for values in errors.values()])


def finest(precision: Precision) -> float:
    """Return the relative error of a step that rounding may make.

    Parameters
    ----------
    precision : Precision
        Numbers of the motion. Projections onto the constraints are right to its sure digits.

    Returns
    -------
    float
        At least the smallest normal float.
    """
    return max(10.0**-precision.sure_digits, float_info.min)


def expected(tol: float, steps: int | NDArray[np.int64], least: float = FINEST) -> float | Vector:
    """Return the largest relative error to expect from a tolerance after some steps.

    Parameters
    ----------
    tol : float
        Tolerance of a step.
    steps : int or ndarray of int, shape (k,)
        Number of steps taken.
    least : float, optional
        Relative error of a step that rounding may make.

    Returns
    -------
    float or ndarray, shape (k,)
        ``MARGIN`` times the tolerance, or the least error, times the number of steps. At most `LARGEST`, or ten times
        a larger tolerance.
    """
    return np.minimum(MARGIN * max(tol, least) * np.maximum(1, steps), max(LARGEST, 10 * tol))


def relative_energy_error(
    start: tuple[Matrices, Vector],
    end: tuple[Matrices, Vector],
    error: float | Vector,
    exchanged: float | Vector,
    small: Vector,
) -> float | Vector:
    """Return an energy error relative to the size of the energies, of one motion or k.

    Parameters
    ----------
    start, end : (Matrices, ndarray of shape (2n,) or (2n, k))
        Matrices and state there, those of k motions with a last axis more.
    error, exchanged : float or ndarray, shape (k,)
        The largest error, and the largest change of the energy or work.
    small : ndarray, shape (n,) or (n, k)
        Velocities no larger than that make no error: steps of the tolerance, which is one of their nominal sizes too,
        may add up to them.

    Returns
    -------
    float or ndarray, shape (k,)
        Absolute if the energies have no size.
    """
    scale = np.maximum(np.maximum(_energy_scale(*start), _energy_scale(*end)), exchanged)
    at_rest = np.max(np.diagonal(end[0].mass) * np.transpose(small) ** 2, axis=-1, initial=0.0)
    left = np.maximum(error - at_rest, 0.0)  # NaN stays
    return np.where((scale > 0) & (scale < np.inf), left / scale, left)


def _energy_scale(at: Matrices, state: Vector) -> float | Vector:
    """Return the size of the exchanged energies at a state: v^T A v and |h_s q_s|."""
    q, v = np.abs(np.split(state, 2))
    return np.einsum("i...,ij...,j...->...", v, np.abs(at.mass), v) + np.sum(np.abs(at.force) * q, axis=0)


FAINT = frozenset({Operation.EXP, Operation.SINH, Operation.COSH, Operation.TANH, Operation.ERF})
HIGH = 16  # exponents from which a power is as faint as an exponential


def may_hide(program: Program, apart: Collection[str] = ("t",)) -> bool:
    """Return True if a program contains a function that is faint nearly everywhere.

    Parameters
    ----------
    program : Program
        Program to search.
    apart : collection of str
        Inputs that the function may depend on without consequence.

    Returns
    -------
    bool
    """
    return _contains(program, set(program.inputs).difference(apart), _is_faint)


def has_root_of(program: Program, names: Collection[str]) -> bool:
    """Return True if a program contains a root of a function of some inputs.

    Parameters
    ----------
    program : Program
        Program to search.
    names : collection of str
        Names of the inputs.

    Returns
    -------
    bool
    """
    return _contains(program, set(names), is_root)


def _contains(program: Program, moving: set[str], sought: Callable[[Call], bool]) -> bool:
    for name, expression in program.assignments:
        if any(sought(call) and names_in(call) & moving for call in calls_in(expression)):
            return True
        if names_in(expression) & moving:
            moving.add(name)
    return False


def is_root(call: Call) -> bool:
    """Return True if an operation is a root.

    Parameters
    ----------
    call : Call
        The operation.

    Returns
    -------
    bool
    """
    exponent = call.arguments[1] if call.operation is Operation.POWER else None
    return call.operation is Operation.SQRT or (isinstance(exponent, Fraction) and exponent.denominator > 1)


def _is_faint(call: Call) -> bool:
    if call.operation is not Operation.POWER:
        return call.operation in FAINT
    exponent = call.arguments[1]
    return not isinstance(exponent, Fraction) or abs(exponent) >= HIGH
