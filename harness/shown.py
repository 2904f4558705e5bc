"""Results that a notebook and a Python prompt show as the command line does."""

from collections.abc import Callable
from typing import Any, ClassVar


class Shown:
    """A result with a table. `holonom.display` makes it, and sets these functions; it imports results, never they it.

    A dataclass among them takes ``repr=False``, or it would print its fields instead.
    """

    as_text: ClassVar[Callable[[Any], str]] = object.__repr__
    as_html: ClassVar[Callable[[Any], str | None]] = lambda _: None

    def __repr__(self) -> str:
        return Shown.as_text(self)

    def _repr_html_(self) -> str | None:
        return Shown.as_html(self)
