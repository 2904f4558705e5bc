"""Statements at Maxima's prompt and its answers."""

import re
from pathlib import Path

from ..maxima import run_batch
from ..temporary import private_directory

LOADING = re.compile(r"^load\(.*\)\$$", re.MULTILINE)
ANSWERED = "%answer : ({})$\n%answers : endcons(string(%answer), %answers)$\n"
WRITER = """
write_answers(%file) := block([%stream : openw(%file)],
  for %each in %answers do printf(%stream, "~a~%", %each), close(%stream))$
"""


def answers_of(example: Path | None, statements: tuple[str, ...]) -> tuple[str, ...]:
    """Return Maxima's answers to statements, in one line each.

    Parameters
    ----------
    example : Path or None
        Scene file that is read first.
    statements : tuple of str
        Statements without their terminators.

    Returns
    -------
    tuple of str
        Answers in the order of the statements.

    Raises
    ------
    HolonomError
        Maxima reports an error.
    """
    begun = LOADING.sub("", example.read_text(encoding="utf-8")) if example else ""
    asked = "".join(map(ANSWERED.format, statements))
    with private_directory() as directory:
        file = directory / "session.mac"
        file.write_text(f'load("holonom.mac")$\n{begun}\n%answers : []$\n{asked}{WRITER}', encoding="utf-8")
        return tuple(run_batch(file, "write_answers").replace("\\", "").splitlines())
