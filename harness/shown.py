"""Results that a notebook and a Python prompt show as the command line does."""

from collections.abc import Callable
from typing import Any, ClassVar


class Shown:
    """A result with a table, which `holonom.display` makes.

    `holonom.display` sets these functions. It imports results, never the reverse. A dataclass with this base takes
    ``repr=False``, because it would print its fields otherwise.
    """

    as_text: ClassVar[Callable[[Any], str]] = object.__repr__
    as_html: ClassVar[Callable[[Any], str | None]] = lambda _: None

    def __repr__(self) -> str:
        return Shown.as_text(self)

    def _repr_html_(self) -> str | None:
        return Shown.as_html(self)
