"""Axes of a sweep: grids, lists and samples of parameters, and the rows they span.

The rows are the product of all grids and lists, the last one named varying fastest, for each member of the sample in
turn. Row i is a function of i and the seed alone: random numbers come in blocks of their own generators.
"""

import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from itertools import chain
from numbers import Integral
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..documents import NAME
from ..failures import ErrorKind, HolonomError
from ..language import translatable
from ..options import Number, within_reach

BLOCK = 1024  # members of a sample that one generator draws
MOST_ROWS = 10**12
NUMBER = r"[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?(?:/\d+)?"
EXAMPLES = {"--grid": "m=50:500:1000", "--over": "u=1:3:5", "--list": "m=1,2,5", "--sample": "'m=normal(100,5)'"}
ARGUMENTS = {"grid": "{'m': (50, 500, 1000)}", "values": "{'m': [1, 2, 5]}", "sample": "{'m': 'normal(100,5)'}"}
Axis = TypeVar("Axis")
DRAWN = re.compile(rf"(\w+)\(\s*({NUMBER})\s*,\s*({NUMBER})\s*\)")


class Distribution(StrEnum):
    """The distribution of a sample and the meaning of its two numbers.

    They are mean and standard deviation of a normal distribution, else the least and the greatest value.
    """

    NORMAL = "normal"
    UNIFORM = "uniform"
    LOGUNIFORM = "loguniform"


@dataclass(frozen=True)
class Grid:
    """Equidistant numbers."""

    name: str
    first: float
    last: float
    count: int
    text: str  # how they were requested

    def _at(self, places: NDArray[np.intp]) -> NDArray[np.float64]:
        """Return the numbers at some places, from zero."""
        inside = self.first + places * ((self.last - self.first) / max(1, self.count - 1))
        return np.where((places == self.count - 1) & (places > 0), self.last, inside)


@dataclass(frozen=True)
class Listed:
    """Numbers one after the other."""

    name: str
    numbers: tuple[float, ...]
    text: str  # how they were requested

    @property
    def count(self) -> int:
        """Number of values."""
        return len(self.numbers)

    def _at(self, places: NDArray[np.intp]) -> NDArray[np.float64]:
        return np.array(self.numbers)[places]


Values = Grid | Listed


@dataclass(frozen=True)
class Sample:
    """Numbers that a parameter takes at random."""

    name: str
    distribution: Distribution
    first: float
    second: float
    text: str  # how they were requested

    def _draw(self, generator: np.random.Generator, count: int) -> NDArray[np.float64]:
        match self.distribution:
            case Distribution.NORMAL:
                return generator.normal(self.first, self.second, count)
            case Distribution.UNIFORM:
                return generator.uniform(self.first, self.second, count)
            case Distribution.LOGUNIFORM:
                return np.exp(generator.uniform(math.log(self.first), math.log(self.second), count))


@dataclass(frozen=True)
class Axes:
    """The axes of a sweep."""

    values: tuple[Values, ...]
    samples: tuple[Sample, ...]
    size: int  # members of the sample; one without samples
    seed: int

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters that vary."""
        return tuple(axis.name for axis in (*self.values, *self.samples))

    @property
    def rows(self) -> int:
        """Number of rows."""
        return self.size * math.prod(axis.count for axis in self.values)

    def numbers(self, first: int, last: int) -> NDArray[np.float64]:
        """Return the parameters of the rows first, ..., last - 1.

        Parameters
        ----------
        first, last : int
            Row numbers, from zero. The last is excluded.

        Returns
        -------
        ndarray, shape (names, rows)
        """
        rows = np.arange(first, last)
        member, *places = np.unravel_index(rows, (self.size, *(axis.count for axis in self.values)))
        chosen = [axis._at(place) for axis, place in zip(self.values, places, strict=True)]
        drawn = [self._drawn(place, axis, member) for place, axis in enumerate(self.samples)]
        return np.array([*chosen, *drawn])

    def _drawn(self, place: int, axis: Sample, members: NDArray[np.intp]) -> NDArray[np.float64]:
        blocks = range(int(members[0]) // BLOCK, int(members[-1]) // BLOCK + 1)
        numbers = [axis._draw(np.random.default_rng((self.seed, place, block)), BLOCK) for block in blocks]
        return np.concatenate(numbers)[members - blocks[0] * BLOCK]


def read_axes(
    grids: Iterable[str], lists: Iterable[str], samples: Iterable[str], size: int | None, seed: int | None
) -> Axes:
    """Read the axes of a sweep from the options of a command line.

    Parameters
    ----------
    grids : iterable of str
        ``NAME=FIRST:LAST:COUNT``, equidistant numbers.
    lists : iterable of str
        ``NAME=VALUE,VALUE,...``.
    samples : iterable of str
        ``NAME=normal(MEAN,DEVIATION)``, ``NAME=uniform(LEAST,GREATEST)`` or ``NAME=loguniform(LEAST,GREATEST)``.
    size : int or None
        Size of the sample, which samples need.
    seed : int or None
        Seed of the sample. Default: 0.

    Returns
    -------
    Axes

    Raises
    ------
    HolonomError
        One of them is not of its form, a parameter is varied twice or none is, there are too many rows, or size or seed
        is not such a number.
    """
    values = [*read_grids("--grid", grids), *_read("--list", _listed, lists)]
    return _axes(values, [*_read("--sample", _sample, samples)], size, seed)


def read_grids(option: str, texts: Iterable[str]) -> Iterator[Grid]:
    """Read equidistant numbers from an option of a command line.

    Parameters
    ----------
    option : str
        Name of the option.
    texts : iterable of str
        ``NAME=FIRST:LAST:COUNT``.

    Yields
    ------
    Grid

    Raises
    ------
    HolonomError
        One of them is not of its form.
    """
    return _read(option, _grid, texts)


def _read(option: str, read: Callable[[str], Axis], texts: Iterable[str]) -> Iterator[Axis]:
    """Yield the axes of an option. The error for a malformed one shows an example."""
    for text in texts:
        try:
            yield read(text)
        except HolonomError as error:
            example = EXAMPLES[option]
            raise HolonomError(ErrorKind.MALFORMED_AXIS, detail=error.detail, option=option, example=example) from None


def axes_of(
    grids: Mapping[str, Collection[Number]] | None,
    lists: Mapping[str, Collection[Number]] | None,
    samples: Mapping[str, str] | None,
    size: int | None,
    seed: int | None,
) -> Axes:
    """Return the axes of a sweep from the arguments of `holonom.sweep`.

    Parameters
    ----------
    grids : mapping of str to (first, last, count), or None
        Equally spaced values.
    lists : mapping of str to collection, or None
        Lists of values.
    samples : mapping of str to str, or None
        Distributions, as for `read_axes`.
    size, seed : int or None
        As for `read_axes`.

    Returns
    -------
    Axes

    Raises
    ------
    HolonomError
        An argument is not of its form, or as `read_axes`.
    """
    values = [_grid(f"{name}={':'.join(map(str, each))}") for name, each in _entries("grid", _is_triple, grids)]
    values += [_listed(f"{name}={','.join(map(str, each))}") for name, each in _entries("values", _is_list, lists)]
    drawn = [
        _sample(f"{name}={text}") for name, text in _entries("sample", lambda each: isinstance(each, str), samples)
    ]
    return _axes(values, drawn, size, seed)


def _entries(argument: str, well_formed: Callable[[Any], bool], given: Any) -> Iterable[tuple[str, Any]]:
    """Return the entries of a mapping. The error for a malformed one shows an example."""
    if given is None:
        return ()
    if isinstance(given, Mapping) and all(isinstance(name, str) and well_formed(each) for name, each in given.items()):
        return given.items()
    text = f"{argument}={given!r}"
    detail = translatable("%(text)s: this is not the form of the argument", text=text)
    raise HolonomError(ErrorKind.MALFORMED_AXIS, detail=detail, example=f"{argument}={ARGUMENTS[argument]}")


def _is_list(given: Any) -> bool:
    if not isinstance(given, Collection) or isinstance(given, str | Mapping):
        return False
    return not any(isinstance(each, str) and "," in each for each in given)


def _is_triple(given: Any) -> bool:
    return _is_list(given) and len(given) == 3


def _axes(values: Sequence[Values], samples: Sequence[Sample], size: int | None, seed: int | None) -> Axes:
    """Return the axes of a sweep, if they go together."""
    for name, given, least in (("size", size, 1), ("seed", seed, 0)):
        if given is not None and not (isinstance(given, Integral) and given >= least):
            detail = translatable(
                "%(name)s=%(given)s: expected an integer from %(least)s on", name=name, given=repr(given), least=least
            )
            raise not_an_axis(detail)
    names = [axis.name for axis in chain(values, samples)]
    if not names:
        raise HolonomError(ErrorKind.NOTHING_VARIES)
    if twice := next((name for name in names if names.count(name) > 1), None):
        raise not_an_axis(translatable("%(twice)s is varied twice", twice=twice))
    if bool(samples) != (size is not None):
        missing = translatable("a sample needs its --size") if samples else translatable("--size needs a --sample")
        raise not_an_axis(missing)
    axes = Axes(tuple(values), tuple(samples), size or 1, seed or 0)
    if axes.rows > MOST_ROWS:
        raise not_an_axis(
            translatable("these are %(rows)s rows; at most %(most)s are allowed", rows=axes.rows, most=MOST_ROWS)
        )
    return axes


def _grid(text: str) -> Grid:
    name, rest = _named(text)
    parts = [part.strip() for part in rest.split(":")]
    if len(parts) != 3:
        raise not_an_axis(translatable("%(text)s: expected NAME=FIRST:LAST:COUNT", text=text))
    first, last, count = parts
    if not count.isdecimal() or not 1 <= len(count) <= 12 or int(count) < 1:
        raise not_an_axis(translatable("%(text)s: the count is not a positive integer", text=text))
    return Grid(name, _number(first, text), _number(last, text), int(count), text)


def _listed(text: str) -> Listed:
    name, rest = _named(text)
    return Listed(name, tuple(_number(number, text) for number in rest.split(",")), text)


def _sample(text: str) -> Sample:
    name, rest = _named(text)
    found = DRAWN.fullmatch(rest.strip())
    if found is None or found[1] not in set(Distribution):
        raise not_an_axis(
            translatable("%(text)s: expected %(names)s(NUMBER,NUMBER)", text=text, names=", ".join(Distribution))
        )
    kind, first, second = Distribution(found[1]), _number(found[2], text), _number(found[3], text)
    if kind is Distribution.NORMAL and not second > 0:
        raise not_an_axis(translatable("%(text)s: the deviation is not positive", text=text))
    if kind is not Distribution.NORMAL and not first < second:
        raise not_an_axis(translatable("%(text)s: the smallest value is not below the largest", text=text))
    if kind is Distribution.LOGUNIFORM and not first > 0:
        raise not_an_axis(translatable("%(text)s: loguniform needs positive values", text=text))
    return Sample(name, kind, first, second, text)


def _named(text: str) -> tuple[str, str]:
    name, equals, rest = text.partition("=")
    if not equals or not NAME.fullmatch(name.strip()):
        raise not_an_axis(translatable("%(text)s: the name of the parameter is missing", text=text))
    return name.strip(), rest


def _number(text: str, whole: str) -> float:
    text = text.strip()
    if not re.fullmatch(NUMBER, text) or not within_reach(text.lstrip("+-")):
        raise not_an_axis(translatable("%(whole)s: expected a number, not %(text)s", whole=whole, text=repr(text)))
    try:
        return float(Fraction(text))
    except ZeroDivisionError:
        raise not_an_axis(translatable("%(whole)s: division by zero", whole=whole)) from None


def not_an_axis(reason: str) -> HolonomError:
    """Return the error of a varied parameter that a sweep cannot have.

    Parameters
    ----------
    reason : str
        Clause about it.

    Returns
    -------
    HolonomError
    """
    return HolonomError(ErrorKind.NOT_AN_AXIS, detail=reason)
