"""Times of one evaluation of compiled programs and of Python functions."""

import ctypes
import time
from collections.abc import Callable, Mapping, Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from .c_function import CFunction, load_c
from .templates import template

ROUNDS = 9  # the shortest time counts: what disturbs a measurement makes it longer
BATCH = 0.005  # seconds of calls in one round
GUESSES = 3
SHORTEST = 1e-9  # seconds; no call takes less
Compiled = Callable[..., None]
Batch = Callable[[int], float]  # number of calls -> seconds of one of them

Key = TypeVar("Key")


class Timer:
    """Measures compiled functions without Python between the calls."""

    def __init__(self) -> None:
        self._seconds = load_c(template("timer.c")).seconds_a_call
        self._seconds.argtypes = (ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_long)
        self._seconds.restype = ctypes.c_double

    def batch(self, function: Compiled, point: NDArray[np.float64], outputs: int) -> Batch:
        """Return a batch of calls of ``function(in, out)``.

        Parameters
        ----------
        function : Compiled
            Compiled function.
        point : ndarray, shape (inputs,)
            Its inputs.
        outputs : int
            Number of its outputs.

        Returns
        -------
        Batch
            Function from the number of calls to the seconds of one call.
        """
        result = np.empty(outputs)
        address = ctypes.cast(function, ctypes.c_void_p)
        return lambda calls: self._seconds(address, point.ctypes.data, result.ctypes.data, calls)

    def evaluation(self, function: CFunction, point: NDArray[np.float64]) -> Batch:
        """Return a batch of evaluations of a compiled program at a point.

        Parameters
        ----------
        function : CFunction
            Compiled program.
        point : ndarray, shape (inputs,)
            Its inputs.

        Returns
        -------
        Batch
            Function from the number of calls to the seconds of one call.
        """
        return self.batch(function.one, point, len(function.outputs))


def python_batch(function: Callable[[Sequence[float]], object], point: Sequence[float]) -> Batch:
    """Return a batch of calls of a function of Python.

    Parameters
    ----------
    function : callable
        Function of a sequence of numbers.
    point : sequence of float
        Its inputs.

    Returns
    -------
    Batch
        Function from the number of calls to the seconds of one call.
    """

    def seconds(calls: int) -> float:
        start = time.perf_counter()
        for _ in range(calls):
            function(point)
        return (time.perf_counter() - start) / calls

    return seconds


def shortest_times(batches: Mapping[Key, Batch]) -> dict[Key, float]:
    """Measure the seconds of one call of several functions.

    The functions take turns, so that a temporary slowdown of the machine affects all of them.

    Parameters
    ----------
    batches : mapping of Key to Batch
        Batches of calls, by a key.

    Returns
    -------
    dict of Key to float
        Shortest time of one call, in seconds, by the same key.
    """
    calls = {key: max(1, int(BATCH / max(_first_guess(batch), SHORTEST))) for key, batch in batches.items()}
    rounds = [{key: batch(calls[key]) for key, batch in batches.items()} for _ in range(ROUNDS)]
    return {key: min(times[key] for times in rounds) for key in batches}


def _first_guess(batch: Batch) -> float:
    """Return the shortest time of a few calls, in seconds.

    One disturbed call has no effect on it.
    """
    return min(batch(1) for _ in range(GUESSES))
