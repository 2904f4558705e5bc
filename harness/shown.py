"""Results that a notebook shows as the terminal does."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

Show = Callable[["Console", Any], None]


class Shown:
    """A result with a table; the tables are the command line's, imported when one is asked for."""

    def _table(self) -> Show:
        raise NotImplementedError

    def _repr_html_(self) -> str:
        from .cli.tables.text import html_of

        show = self._table()
        return html_of(lambda console: show(console, self))
