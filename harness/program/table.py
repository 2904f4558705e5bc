"""Tables of control laws: thousands of cubic polynomials, one for each interval.

Programs have such a polynomial among their inputs, as t_k and the coefficients of powers of t - t_k
(`maxima/laws/table.mac`). Its numbers are data, selected by the time.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Annotated

from ..schema import Rules
from ..structs import entry

Number = Annotated[str, Rules({"pattern": "^-?[0-9.]+(/[0-9]+|e-?[0-9]+)?$"})]
Piece = tuple[Number, Number, Number, Number, Number]  # t_k, c0, c1, c2, c3, exact or in decimal digits


@dataclass(frozen=True)
class Table:
    """The polynomials of one table, in order."""

    inputs: tuple[str, ...] = entry("Input names of t_k, c0, c1, c2, c3.", minItems=5)
    pieces: tuple[Piece, ...] = entry("Values of t_k, c0, c1, c2, c3 for each polynomial.", minItems=2)

    @cached_property
    def begins(self) -> tuple[Fraction, ...]:
        """The times at which the polynomials begin."""
        return tuple(Fraction(piece[0]) for piece in self.pieces)

    @property
    def knots(self) -> tuple[Fraction, ...]:
        """The knots between the polynomials."""
        return self.begins[1:]

    @property
    def first(self) -> Mapping[str, Fraction]:
        """The first polynomial."""
        return dict(zip(self.inputs, map(Fraction, self.pieces[0]), strict=True))

    @property
    def rows(self) -> Iterator[tuple[float, ...]]:
        """The polynomials in double precision."""
        return ((float(t), *map(float, piece[1:])) for t, piece in zip(self.begins, self.pieces, strict=True))
