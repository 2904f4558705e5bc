"""Which linearisation is asked for."""

from dataclasses import dataclass
from fractions import Fraction

from ..options import option


@dataclass(frozen=True)
class LinearizationRequest:
    """About which state."""

    at: Fraction | None = option(None, "The instant; without it, the start.", metavar="T")
