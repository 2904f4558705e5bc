"""Advice from measurements: the cheapest method for each number of digits.

The growth of a method's time with every digit is its price.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ...structs import computed, entry
from .measurement import WHOLE_MOTION, Measurement

ASKED_DIGITS = (3, 6, 9, 12, 15, 30)
FEWEST = 3  # points that a slope is drawn through


@dataclass(frozen=True)
class CheapestRun:
    """The shortest run with a number of correct digits."""

    method: str = entry("Name of the method.")
    setting: str = entry("Setting of the method.")
    seconds: float = entry("Run time in seconds.")
    error: float = entry("Relative error.")


@dataclass(frozen=True)
class Advice:
    """The cheapest method for a number of digits, or None."""

    digits: int = entry("Number of digits required.")
    cheapest: Measurement | None

    @property
    @computed("The shortest run with this many correct digits; null if there is none.", "cheapest")
    def _run(self) -> CheapestRun | None:
        found = self.cheapest
        return found and CheapestRun(found.method, found.setting, found.seconds, found.error)


@dataclass(frozen=True)
class Price:
    """The cost of one more digit."""

    method: str = entry("Name of the method.")
    factor: float = entry("Factor by which the time grows.", exclusiveMinimum=0)
    first_digits: float = entry("Fewest digits of the range of the factor.")
    last_digits: float = entry("Most digits of the range of the factor.")


def cheapest_methods(measurements: Sequence[Measurement]) -> Iterator[Advice]:
    """Yield the fastest run with 3, 6, 9, 12, 15, 30 correct digits at the end.

    Parameters
    ----------
    measurements : sequence of Measurement
        All measurements of a study. Those of whole motions count.

    Yields
    ------
    Advice
        Advice for one number of digits.
    """
    whole = [m for m in measurements if m.group in WHOLE_MOTION]
    for digits in ASKED_DIGITS:
        enough = [m for m in whole if m.error <= 10.0**-digits]
        yield Advice(digits, min(enough, key=lambda m: m.seconds, default=None))


def prices(measurements: Sequence[Measurement]) -> Iterator[Price]:
    """Yield the growth of each method's time with every digit.

    It is a least-squares fit of log(time) against digits. Runs whose error no longer falls with the tolerance, because
    of rounding, are left out. Every method with enough settings has a price.

    Parameters
    ----------
    measurements : sequence of Measurement
        All measurements of a study. Those of whole motions count.

    Yields
    ------
    Price
        Price of one method.
    """
    for method in dict.fromkeys(m.method for m in measurements if m.group in WHOLE_MOTION):
        falling = _falling([m for m in measurements if m.method == method and m.group in WHOLE_MOTION])
        if len(falling) >= FEWEST:
            digits = [-math.log10(m.error) for m in falling]
            slope, _ = np.polyfit(digits, [math.log(m.seconds) for m in falling], 1)
            yield Price(method, math.exp(float(slope)), min(digits), max(digits))


def _falling(measurements: Sequence[Measurement]) -> list[Measurement]:
    """Return measurements with a smaller error than all before them."""
    frontier: list[Measurement] = []
    for m in measurements:
        if 0 < m.error < (frontier[-1].error if frontier else math.inf):
            frontier.append(m)
    return frontier
