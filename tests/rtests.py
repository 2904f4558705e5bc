"""Run files in Maxima's own test convention, pairs of input and expected result, with the library loaded."""

import re
import shutil
from pathlib import Path

from holonom.maxima import DEFAULT_LIMITS, LIBRARY, NO_SETTINGS, _copy, _new_run, _run, statement_ends
from holonom.preloaded import quoted


class RtestFailed(Exception):
    """Not all pairs of a file were tested and passed; the text is what Maxima printed."""


def run_rtest(rtest: Path) -> int:
    """Return the number of pairs of a file, every one of which passed.

    They are counted in the file's text: where Maxima cannot read on it prints no summary. A `HolonomError` tells why
    Maxima ended before.
    """
    tests, unpaired = divmod(count_statements(rtest.read_text(encoding="utf-8")), 2)
    if unpaired:
        raise RtestFailed(f"{rtest}: an input has no expected result")
    with _new_run(LIBRARY / "holonom.mac", DEFAULT_LIMITS, NO_SETTINGS) as run:
        shutil.copy(rtest, run.directory)  # for Maxima leaves a list of errors beside the file it tests
        test = quoted(f"(open_namespace(), batch({quoted(rtest.name)}, test))$")
        ended = _run(run, f"run-file {_copy(run)} {test}")
        ended.require_finished(run, test)
    if re.findall(r"(\d+)/(\d+) tests passed", ended.printed) != [(str(tests), str(tests))]:
        raise RtestFailed(ended.printed)
    return tests


def count_statements(text: str) -> int:
    """Count the statements in Maxima text: terminators, ``;`` or ``$``, outside comments and strings."""
    return sum(1 for _ in statement_ends(text))
