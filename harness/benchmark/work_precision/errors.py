"""How far a state is from the true one."""

from collections.abc import Iterable, Sequence

import mpmath

State = Sequence[mpmath.mpf]

WORKING_DIGITS = 300  # more than any state has


def relative_error(found: State, true: State) -> float:
    """Larger of the relative errors of coordinates and of velocities, each in the maximum norm.

    Parameters
    ----------
    found, true : sequence of mpf
        Coordinates, then as many velocities.

    Returns
    -------
    float
        Where all true values of one kind are zero, their error is absolute.
    """
    middle = len(true) // 2
    with mpmath.workdps(WORKING_DIGITS):
        deviations = [a - b for a, b in zip(found, true, strict=True)]
        return max(
            float(_largest(deviations[half]) / (_largest(true[half]) or 1))
            for half in (slice(None, middle), slice(middle, None))
        )


def numbers_of(texts: Iterable[str]) -> State:
    """Decimal digits as numbers, not a digit lost."""
    with mpmath.workdps(WORKING_DIGITS):
        return [mpmath.mpf(text) for text in texts]


def _largest(values: State) -> mpmath.mpf:
    return max(map(abs, values))
