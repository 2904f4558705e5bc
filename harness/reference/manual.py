"""The manual page, roff made of the same topics as the pages: ``python -m holonom.reference.manual FILE``."""

import sys
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path

from ..files import write_whole
from .topic import Code, Table
from .topics import command_topics


def manual_page() -> str:
    """Return the text of holonom.1."""
    return "\n".join(_lines()) + "\n"


def _lines() -> Iterator[str]:
    overview, *commands = command_topics()
    yield f'.TH HOLONOM 1 "" "holonom {metadata.version("holonom")}" "User Commands"'
    yield ".SH NAME"
    yield f"holonom \\- {_roff(metadata.metadata('holonom')['Summary'])}"
    yield ".SH DESCRIPTION"
    yield _roff(overview.summary)
    yield from _parts(overview.parts)
    for topic in commands:
        yield f'.SH "{_roff(topic.title).upper()}"'
        yield _roff(topic.summary)
        yield from _parts(topic.parts)


def _parts(parts: tuple[Table | Code, ...]) -> Iterator[str]:
    for part in parts:
        if isinstance(part, Code):
            yield from (f'.SS "{_roff(part.caption)}"', ".nf", *map(_roff, part.text.splitlines()), ".fi")
            continue
        yield f'.SS "{_roff(part.caption)}"'
        for name, text, *default in part.rows:
            without = f" Without it: {default[0]}." if default and default[0] else ""
            yield from (".TP", f"\\fB{_roff(name)}\\fR", _roff(text + without))


def _roff(text: str) -> str:
    """Text that roff shows as it is."""
    escaped = text.replace("\\", "\\e").replace("-", "\\-")
    return f"\\&{escaped}" if escaped.startswith((".", "'")) else escaped


if __name__ == "__main__":
    write_whole(Path(sys.argv[1]), manual_page())
