"""What is asked of a scene file: which scene, how the multipliers are solved for, numbers for what is open."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from ..failures import Failure, HolonomError
from .motion_program import Solve

LONGEST = 200  # digits of a number that an option gives
LARGEST_EXPONENT = 307  # of a double
SETTING = re.compile(r"([^\W\d]\w*)=(-?\d+(?:\.\d+)?(?:e-?\d+)?(?:/\d+)?)", re.IGNORECASE)


@dataclass(frozen=True)
class Request:
    """Which scene of a file, and how."""

    scene: str | None = None  # name of the scene; None for the last one, or for the system where there is none
    solve: Solve = Solve.DIRECT
    # numbers in Maxima's notation, for what the file leaves open and for parameters
    settings: Mapping[str, str] = field(default_factory=dict)


def within_reach(number: str) -> bool:
    """Whether a double holds the parts of a decimal number or quotient, told without computing them."""
    for part in number.lower().split("/"):
        digits, _, exponent = part.partition("e")
        if len(digits) > LONGEST or len(exponent) > 4 or not abs(int(exponent or 0)) + len(digits) <= LARGEST_EXPONENT:
            return False
    return True


def read_settings(texts: Iterable[str]) -> dict[str, str]:
    """Read settings as they stand on a command line: ``NAME=VALUE``, an integer, a decimal or a quotient of integers.

    Raises
    ------
    HolonomError
        One of them is not of that form.
    """
    settings = {}
    for text in texts:
        if (found := SETTING.fullmatch(text)) is None:
            raise HolonomError(Failure.NOT_A_SETTING, detail=text)
        if not within_reach(found[2]):
            raise HolonomError(Failure.SETTING_TOO_LARGE, detail=text if len(text) < LONGEST else found[1])
        settings[found[1]] = found[2]
    return settings
