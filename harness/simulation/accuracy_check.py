"""Whether a result may be called one: what it misses beside what its tolerance lets expect, and what may hide from it.

A method whose steps each err by its tolerance errs, over so many steps, by no more than their product times some power
of ten, relative to the size of what is computed. A constraint or an energy that is missed by more was not followed: a
feature was stepped over, digits were lost, or the tolerance was not held.

Functions of the state may be faint nearly everywhere, and strong in a narrow place. An exponential is so small away
from there, or so near to its limit, that rounding swallows it, and a high power is no better. What they do shows
neither at a few states, however chosen, nor at the beginning of a step.
"""

from collections.abc import Collection, Iterator, Mapping
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..program.motion_program import Call, Operation, Program, calls_in, names_in
from .matrices import Matrices, Vector

MARGIN = 1e4
MISSED = {
    "energy": "the energy",
    "acceleration": "a force that acts within a step",
    "multipliers": "a multiplier",
}
FINEST = 1e-15  # relative error of a step, however fine its tolerance: residuals are computed in double precision


class AccuracyViolation(NamedTuple):
    """A quantity that is out of proportion."""

    # ``position``, ``velocity``, ``energy``, ``multipliers``, or ``acceleration``: of the equations of motion within a
    # step
    quantity: str
    # missed, expected: relative: what was found, and the most that the tolerance lets expect
    missed: float
    expected: float

    @property
    def reason(self) -> str:
        """Say in a clause by how much the quantity is missed."""
        what = MISSED.get(self.quantity, f"the {self.quantity} that the constraints allow")
        if np.isnan(self.missed):
            return f"{what} has no finite value"
        amount = f"is missed by {self.missed:.1e} of its size"
        return f"{what} {amount}, where the tolerance lets expect {self.expected:.1e} at most"


def doubts(missed: Mapping[str, float], tol: float, steps: int) -> Iterator[AccuracyViolation]:
    """Yield what is out of proportion to the tolerance, of what is missed by quantity, relative to its size."""
    most = float(expected(tol, steps))
    for quantity, value in missed.items():
        if not value <= most:
            yield AccuracyViolation(quantity, value, most)


def trusted(missed: Mapping[str, Vector], tol: float, steps: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Of which of k motions nothing is out of proportion; each quantity has shape (k,)."""
    return np.logical_and.reduce([values <= expected(tol, steps) for values in missed.values()])


def expected(tol: float, steps: int | NDArray[np.int64]) -> float | Vector:
    """Return the relative error that a tolerance lets expect after some steps, at most."""
    return MARGIN * max(tol, FINEST) * np.maximum(1, steps)


def energy_missed(
    start: tuple[Matrices, Vector],
    end: tuple[Matrices, Vector],
    error: float | Vector,
    exchanged: float | Vector,
    small: Vector,
) -> float | Vector:
    """Return an energy error relative to the size of the energies that it is an error of; of one motion or of k.

    Parameters
    ----------
    start, end : (Matrices, ndarray of shape (2n,) or (2n, k))
        Matrices and state there, those of k motions with a last axis more.
    error, exchanged : float or ndarray, shape (k,)
        The largest error, and the largest change of the energy or work.
    small : ndarray, shape (n,) or (n, k)
        Velocities no larger than that make no error: steps of the tolerance, which is one of their nominal sizes too,
        may add up to them.
    """
    scale = np.maximum(np.maximum(energy_scale(*start), energy_scale(*end)), exchanged)
    at_rest = np.max(np.diagonal(end[0].mass) * np.transpose(small) ** 2, axis=-1, initial=0.0)
    left = np.maximum(error - at_rest, 0.0)  # NaN stays
    return np.where((scale > 0) & (scale < np.inf), left / scale, left)


def energy_scale(at: Matrices, state: Vector) -> float | Vector:
    """Size of the energies that are exchanged at a state: v^T A v and |h_s q_s|, which rounding is relative to.

    Parameters
    ----------
    state : ndarray, shape (2n,) or (2n, k)
    """
    q, v = np.abs(np.split(state, 2))
    return np.einsum("i...,ij...,j...->...", v, np.abs(at.mass), v) + np.sum(np.abs(at.force) * q, axis=0)


FAINT = frozenset({Operation.EXP, Operation.SINH, Operation.COSH, Operation.TANH, Operation.ERF})
HIGH = 16  # exponents from which a power is as faint as an exponential


def may_hide(program: Program, apart: Collection[str] = ("t",)) -> bool:
    """Return True if a program contains such a function of the state, or of any other of its inputs but those apart."""
    moving = set(program.inputs).difference(apart)
    for name, expression in program.assignments:
        if any(_is_faint(call) and names_in(call) & moving for call in calls_in(expression)):
            return True
        if names_in(expression) & moving:
            moving.add(name)
    return False


def _is_faint(call: Call) -> bool:
    if call.operation is not Operation.POWER:
        return call.operation in FAINT
    exponent = call.arguments[1]
    return not isinstance(exponent, Fraction) or abs(exponent) >= HIGH
