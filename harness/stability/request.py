"""Requests for a linearisation and for equilibria."""

from dataclasses import dataclass
from fractions import Fraction

from ..options import option


@dataclass(frozen=True)
class LinearizationRequest:
    """A request for a linearisation about a state."""

    at: Fraction | None = option(None, "The time; without it, the start.", metavar="T")
    equilibrium: str | None = option(None, "Instead, one of those that equilibria finds.", metavar="NAME")


@dataclass(frozen=True)
class EquilibriaRequest:
    """A request for equilibria."""

    starts: int = option(200, "Random starts of Newton's method.", metavar="N", least=1)
    seed: int = option(1, "Of their random numbers.", metavar="N", least=0)
