"""Requests for a linearisation and for equilibria."""

from dataclasses import dataclass
from fractions import Fraction

from ..options import option


@dataclass(frozen=True)
class LinearizationRequest:
    """A request for a linearisation about a state."""

    at: Fraction | None = option(None, "Time of the state. Default: the initial time.", metavar="T")
    equilibrium: str | None = option(None, "Name of an equilibrium, in place of a time.", metavar="NAME")


@dataclass(frozen=True)
class EquilibriaRequest:
    """A request for equilibria."""

    starts: int = option(200, "Random starts of Newton's method.", metavar="N", least=1)
    seed: int = option(1, "Seed of the random starts.", metavar="N", least=0)
