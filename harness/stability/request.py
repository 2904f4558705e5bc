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
class AlongRequest:
    """A request for a linearisation along a motion."""

    until: Fraction | None = option(None, "The last time, in place of the scene's.", metavar="T")
    samples: int = option(11, "Equidistant times.", metavar="N", least=2)


@dataclass(frozen=True)
class EquilibriaRequest:
    """A request for equilibria."""

    starts: int = option(200, "Random starts of Newton's method.", metavar="N", least=1)
    seed: int = option(1, "Seed of the random starts.", metavar="N", least=0)
