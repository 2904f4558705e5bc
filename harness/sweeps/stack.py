"""The place on the stack at which compiled code runs fastest.

Code that stores vectors on the stack takes up to a third more time where they cross lines of the cache. Where the stack
begins is by chance, so the place is found by trial. Results do not depend on it.
"""

from collections.abc import Callable
from itertools import starmap
from math import inf
from time import perf_counter
from typing import TypeVar

TRIALS = 8  # at each place

Result = TypeVar("Result")


def _directly(function: Callable[[], Result]) -> Result:
    """Call a partial function.

    Python calls functions of its own without the stack.
    """
    return function()


def _deeper(function: Callable[[], Result]) -> Result:
    """Call a function by an iterator.

    It moves the stack by half a vector, as measured.
    """
    [found] = starmap(function, [()])
    return found


PLACES = (_directly, _deeper)


class FastestPlace:
    """A caller of functions that take similar times, at the fastest place."""

    def __init__(self) -> None:
        self._calls, self._least = 0, [inf for _ in PLACES]

    def call(self, function: Callable[[], Result]) -> Result:
        """Call a function at the next place to try, after all trials at the fastest.

        Parameters
        ----------
        function : callable
            Function to call.

        Returns
        -------
        object
            Its result.
        """
        if self._calls == TRIALS * len(PLACES):
            return PLACES[self._least.index(min(self._least))](function)
        place, begun = self._calls % len(PLACES), perf_counter()
        found = PLACES[place](function)
        self._least[place] = min(self._least[place], perf_counter() - begun)
        self._calls += 1
        return found
