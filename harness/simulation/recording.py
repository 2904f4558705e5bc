"""Samples recorded during integration: states at times, and the work until then.

They are processed in blocks, so that any number of samples takes the memory of one block.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain, groupby, islice
from typing import Any, NamedTuple

import numpy as np

from .engines.engine import Step
from .evaluation import Numbers, as_floats
from .mode import Mode

BLOCK = 2**14
"""Samples that are processed together: enough for arrays to be efficient, with little memory."""

PORTION = 2**10
"""Samples that are looked up together in one step; the work until each is a sum over ten states."""

TOGETHER = 2**8
"""Intervals over which the power is integrated together: between two points of a table there may be one alone."""


class SampleBlock(NamedTuple):
    """Consecutive samples of a motion."""

    times: Numbers  # shape (k,)
    states: Numbers  # shape (2n, k)
    works: Numbers  # shape (k,): work done until each time
    modes: Sequence[Mode]  # of each

    def by_mode(self) -> Iterator[tuple[Mode, Numbers, Numbers]]:
        """Yield runs of consecutive samples in one mode.

        Yields
        ------
        mode : Mode
        times : ndarray, shape (l,)
        states : ndarray, shape (2n, l)
        """
        first = 0
        for mode, run in groupby(self.modes):
            here = slice(first, first := first + sum(1 for _ in run))
            yield mode, self.times[here], self.states[:, here]


class Interval(NamedTuple):
    """A part of a step, up to an output time or to the step's end."""

    start: Any
    end: Any
    state: Numbers | None  # at the end, where it is wanted
    impulse: Any  # energy that an impulse at the initial time brought


class Recording:
    """States of a motion at times.

    Parameters
    ----------
    mode : Mode
        In which the motion begins.
    times : iterable of numbers, or None
        In order, before the last, or None for the ends of the steps.
    process : callable
        Takes each `SampleBlock`.

    Attributes
    ----------
    mode : Mode
        Of the last step.
    work : number
        Work done in all.
    largest_work : float
        The largest work done up to a time, between the samples and within a step as well.
    """

    def __init__(
        self, mode: Mode, times: Iterable[Any] | None, zero: Any, process: Callable[[SampleBlock], None]
    ) -> None:
        self.mode, self._process = mode, process
        self._steps = times is None
        self._waiting = iter(times or ())
        self._next = next(self._waiting, None)
        self._samples: list[tuple[Any, Numbers, Any, Mode]] = []  # times, states, works until then, and modes
        self._intervals: list[Interval] = []  # of one mode, their works not yet known
        self._inside: list[tuple[Numbers, Numbers]] = []  # where the power is needed
        self.work = self._zero = zero
        self.largest_work = 0.0

    def begin(self, time: Any, state: Numbers) -> None:
        """Record the first state if its time is an output time.

        Parameters
        ----------
        time : number
            Initial time.
        state : ndarray, shape (2n,)
            Coordinates, then velocities.
        """
        if self._steps or any(True for _ in self._wanted_until(time)):
            self._keep(time, state.copy())

    def take(self, step: Step) -> None:
        """Record samples of a step.

        Parameters
        ----------
        step : Step
            It begins at the end of the last one.
        """
        start, impulse = step.start, step.impulse
        while start != step.end:
            wanted = [step.end] if self._steps else list(islice(self._wanted_until(step.end), PORTION))
            ends = wanted if len(wanted) == PORTION or step.end in wanted[-1:] else [*wanted, step.end]
            self._look_up(step._replace(start=start), ends, wanted, impulse)
            start, impulse = ends[-1], self._zero

    def _look_up(self, step: Step, ends: list[Any], wanted: list[Any], impulse: Any) -> None:
        if step.mode is not self.mode or len(self._intervals) >= TOGETHER:
            self._settle()
            self.mode = step.mode
        parts = self.mode.balance.parts(step, ends)
        lasts, ends = np.cumsum(list(map(len, parts))) - 1, list(chain(*parts))
        starts = [step.start, *ends[:-1]]
        inside, at_ends = self.mode.balance.times_between(starts, ends), [None] * len(ends)
        if wanted or len(inside):
            states = step.states(np.concatenate([np.array(wanted), inside]) if wanted else inside)
            for last, state in zip(lasts, states[:, : len(wanted)].T, strict=False):
                at_ends[last] = state
            self._inside.append((inside, states[:, len(wanted) :]))
        impulses = [impulse, *[self._zero] * (len(ends) - 1)]
        self._intervals += map(Interval, starts, ends, at_ends, impulses)

    def _settle(self) -> None:
        """Record the states at output times, with the work until then."""
        if not self._intervals:
            return
        intervals, inside = self._intervals, self._inside
        self._intervals, self._inside = [], []
        starts, ends = (np.array([interval[side] for interval in intervals]) for side in (0, 1))
        works, passing = self.mode.balance.works(starts, ends, inside)
        until = []
        for interval, work in zip(intervals, works, strict=True):
            self.work = self.work + (interval.impulse + work)
            until.append(self.work)
            if interval.state is not None:
                self._keep(interval.end, interval.state)
        self.largest_work = max(largest(until, self.largest_work), passing)

    def end(self, time: Any, state: Numbers) -> None:
        """Record the final state, projected, in place of the last step's.

        Parameters
        ----------
        time : number
            Last time.
        state : ndarray, shape (2n,)
            Projected coordinates, then velocities.
        """
        self._settle()
        if self._samples and self._samples[-1][0] == time:
            self._samples.pop()
        self._keep(time, state.copy())

    def flush(self) -> None:
        """Process the samples since the last call."""
        if self._samples:
            times, states, works, modes = zip(*self._samples, strict=True)
            self._process(SampleBlock(np.array(times), np.array(states).T, np.array(works), modes))
        self._samples = []

    def _keep(self, time: Any, state: Numbers) -> None:
        if len(self._samples) == BLOCK:  # the last one stays, for `end` may change it
            self.flush()
        self._samples.append((time, state, self.work, self.mode))

    def _wanted_until(self, end: Any) -> Iterator[Any]:
        while self._next is not None and self._next <= end:
            time, self._next = self._next, next(self._waiting, None)
            yield time


def largest(numbers: Numbers | list[Any], known: float) -> float:
    """Return the largest size of the numbers and a known one.

    Parameters
    ----------
    numbers : ndarray or list of number
        Numbers of any sign.
    known : float
        The largest so far.

    Returns
    -------
    float
        NaN if one of the numbers is NaN.
    """
    return float(np.max(np.abs([*as_floats(numbers), known])))
