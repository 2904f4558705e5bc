"""Results that a notebook and a Python prompt show as the command line does."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

Show = Callable[["Console", Any], None]


class Shown:
    """A result with a table; the tables are the command line's, imported when one is asked for.

    A dataclass among them takes ``repr=False``, or it would print its fields instead.
    """

    def _table(self) -> Show:
        raise NotImplementedError

    def __repr__(self) -> str:
        from .cli.tables.text import text_of

        show = self._table()
        return text_of(lambda console: show(console, self))

    def _repr_html_(self) -> str:
        from .cli.tables.text import html_of

        show = self._table()
        return html_of(lambda console: show(console, self))
