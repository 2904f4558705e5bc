"""`make bench`: what the whole command takes for chains of up to 2048 masses, beside CasADi: one table.

    python tests/benchmarks/size.py build/benchmarks

Processor time of `holonom program` and of all that it starts, so that what else the machine does counts little; the
least of a few runs. CasADi's is that of a process, too (`casadi_functions.py`).
"""

import json
import sys
from dataclasses import dataclass
from itertools import pairwise
from math import log
from pathlib import Path
from tempfile import TemporaryDirectory

from timing import CASADI, cost_of, cost_of_command, program_of_command, write_report

EXAMPLE = Path(__file__).parents[2] / "examples" / "chain.mac"
LINKS = (64, 128, 256, 512, 1024, 2048)
RUNS = 2
FROM, TO = 128, 1024  # between which the exponent is taken
SECONDS, GROWTH, MEBIBYTES, OPERATIONS = {512: 5.0, 1024: 10.0}, 1.15, 2048, 1.25  # bars
TO_CASADI, TO_CASADI_IN_C = 5.0, 8.0  # bars at `TO` links


@dataclass(frozen=True)
class Row:
    """What one chain takes: processor seconds to JSON and to C, ours and CasADi's; MiB; operations."""

    links: int
    seconds: float
    seconds_to_c: float
    casadi: float
    casadi_to_c: float
    mebibytes: float
    operations: int


def measured(links: int) -> Row:
    """The least that the commands take for a chain."""
    runs = [one_run(links) for _ in range(RUNS)]
    least = (min(getattr(run, name) for run in runs) for name in ("seconds", "seconds_to_c", "casadi", "casadi_to_c"))
    return Row(links, *least, min(run.mebibytes for run in runs), runs[0].operations)


def one_run(links: int) -> Row:
    """One run of each command, a process of its own."""
    text, seconds, mebibytes = program_of_command(EXAMPLE, f"N={links}")
    with TemporaryDirectory() as directory:
        library, *files = (str(Path(directory, name)) for name in ("library", "chain.casadi", "chain.c"))
        to_c, _ = cost_of_command("program", str(EXAMPLE), "--set", f"N={links}", "--to", "c", "-o", library)
        theirs = [cost_of(sys.executable, CASADI, "chain", str(links), file)[0] for file in files]
    return Row(links, seconds, to_c, *theirs, mebibytes, json.loads(text)["operations"])


def report(rows: list[Row]) -> str:
    """The table, and how it grows."""
    lines = ["links  processor s  exponent  CasADi s  to C  CasADi s to C  largest process MiB  operations  to hand"]
    exponents = ["", *(f"{_exponent(a, b):.2f}" for a, b in pairwise(rows))]
    for row, exponent in zip(rows, exponents, strict=True):
        by_hand = row.operations / (23 * row.links - 9)
        times = (f"{row.seconds:<11.2f}", f"{exponent:<8}", f"{row.casadi:<8.2f}", f"{row.seconds_to_c:<4.1f}")
        cells = (*times, f"{row.casadi_to_c:<13.2f}", f"{row.mebibytes:<19.0f}", f"{row.operations:<10}")
        lines.append("  ".join((f"{row.links:<5}", *cells, f"{by_hand:.2f}")))
    chosen = {row.links: row for row in rows}
    lines.append(f"from {FROM} to {TO} links the time grows as N^{_exponent(chosen[FROM], chosen[TO]):.2f}")
    bars = (
        *((f"processor seconds at {links} links", chosen[links].seconds, bar) for links, bar in SECONDS.items()),
        (f"to CasADi's at {TO} links", chosen[TO].seconds / chosen[TO].casadi, TO_CASADI),
        ("the same to C", chosen[TO].seconds_to_c / chosen[TO].casadi_to_c, TO_CASADI_IN_C),
        ("that exponent", _exponent(chosen[FROM], chosen[TO]), GROWTH),
        (f"MiB at {TO} links", chosen[TO].mebibytes, MEBIBYTES),
        ("operations to those by hand", max(row.operations / (23 * row.links - 9) for row in rows), OPERATIONS),
    )
    lines += [f"{what}: {value:.3g}; bar {bar}: {'holds' if value <= bar else 'FAILS'}" for what, value, bar in bars]
    return "\n".join(lines) + "\n"


def _exponent(a: Row, b: Row) -> float:
    return log(b.seconds / a.seconds) / log(b.links / a.links)


def main(directory: Path) -> None:
    """Measure, and write ``size.txt`` into a directory."""
    measured(2)  # an image of Maxima is made where there is none yet
    write_report(directory / "size.txt", report([measured(links) for links in LINKS]))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
