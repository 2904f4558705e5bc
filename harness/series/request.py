"""Requests for power series."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from ..options import option

EXACT = "exact"
AUTOMATIC = "automatic"


@dataclass(frozen=True)
class SeriesRequest:
    """A request for power series of a scene file."""

    order: int = option(20, "Highest power of the time.", metavar="N", least=2, required=True)
    scene: str | None = None  # name of the scene; None for the last one
    # on the command line --digits and --exact
    digits: int | str = option(
        AUTOMATIC, "Confirmed digits. exact: rational numbers only; automatic: exact if possible."
    )
    precision: int | str | None = option(
        None,
        "Compute with heyoka in this precision: faster, but the last digits are not verified.",
        metavar="double|extended|quadruple|DIGITS",
    )
    until: Fraction | None = option(None, "Also continue the motion to time T, beyond the radius.", metavar="T")
    sensitivities: tuple[str, ...] = option(
        (),
        "Compute derivatives by these parameters and initial coordinates or velocities.",
        metavar="NAME,...",
        spelt=("--sensitivity",),
    )
    # numbers for what the file leaves open and for parameters
    settings: Mapping[str, str] = field(default_factory=dict)
