"""The request to a scene file: scene, solve of the multipliers, and settings."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum

from ..failures import ErrorKind, HolonomError
from ..options import LONGEST, option, within_reach

SETTING = re.compile(r"([^\W\d]\w*)=(-?\d+(?:\.\d+)?(?:e-?\d+)?(?:/0*[1-9]\d*)?)", re.IGNORECASE)


class Solve(StrEnum):
    """The method that solves for the multipliers."""

    DIRECT = "direct"
    ORTHOGONAL = "orthogonal"


@dataclass(frozen=True)
class Request:
    """A request about one scene of a file."""

    # name of the scene; None for the last one, or for the system where there is none
    scene: str | None = option(None, "Scene in the file. Default: the last one.", metavar="NAME")
    solve: Solve = option(
        Solve.DIRECT,
        "Method that solves for the multipliers. orthogonal is more accurate near singular configurations.",
    )
    # numbers in Maxima's notation, for what the file leaves open and for parameters
    settings: Mapping[str, str] = field(default_factory=dict)
    derivatives: bool = False  # whether derivatives of the motion are requested


def read_settings(texts: Iterable[str]) -> dict[str, str]:
    """Read settings ``NAME=VALUE`` from a command line.

    A value is an integer, a decimal or a quotient of integers.

    Parameters
    ----------
    texts : iterable of str
        Settings of the command line. The last one of a name counts.

    Returns
    -------
    dict of str to str
        Values as text, by name.

    Raises
    ------
    HolonomError
        One of them is not of that form.
    """
    settings = {}
    for text in texts:
        if (found := SETTING.fullmatch(text)) is None:
            raise HolonomError(ErrorKind.NOT_A_SETTING, detail=text)
        if not within_reach(found[2]):
            raise HolonomError(ErrorKind.SETTING_TOO_LARGE, detail=text if len(text) < LONGEST else found[1])
        settings[found[1]] = found[2]
    return settings


@dataclass(frozen=True)
class FreeRequest:
    """A request for free motion."""

    order: int | None = option(
        None,
        "Order of the power series that tests whether the multipliers vanish. Default: 40.",
        metavar="N",
        least=2,
    )


class Index(StrEnum):
    """The form of the system, by its differentiation index."""

    THREE = "3"
    TWO = "2"
    ONE = "1"
    GGL = "ggl"


@dataclass(frozen=True)
class DaeRequest:
    """A request for a form of the system."""

    index: Index = option(Index.GGL, "Differentiation index. ggl: index 2, with the constraints satisfied, too.")
