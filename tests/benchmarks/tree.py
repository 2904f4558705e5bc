"""`make bench`: binary trees of N rigid bodies in space, in Euler parameters, against CasADi: one table.

    python tests/benchmarks/tree.py build/benchmarks

As `ring.py`, with the scene `tree.mac`; the programs of the smallest tree are compared.
"""

import sys
from dataclasses import dataclass
from itertools import pairwise
from math import log
from pathlib import Path

from ring import casadi_program, evaluations, our_program
from timing import write_report

SCENE = Path(__file__).with_name("tree.mac")
BODIES = (16, 32, 64, 128, 256)
OPERATIONS, SECONDS, GROWTH = 1.0, 5.0, 1.1  # bars, the first two in terms of CasADi's


@dataclass(frozen=True)
class Row:
    """One tree: processor seconds and operations, ours and CasADi's."""

    bodies: int
    seconds: float
    operations: int
    casadi_seconds: float
    casadi_operations: int


def measured(bodies: int) -> Row:
    """One row of the table."""
    seconds, ours = our_program(SCENE, bodies)
    casadi_seconds, theirs = casadi_program("tree", bodies, ours)
    if bodies == BODIES[0]:
        evaluations(ours, theirs)  # which ends where their accelerations differ
    return Row(bodies, seconds, ours.operations, casadi_seconds, theirs.operations)


def exponent(a: Row, b: Row) -> float:
    """How our time grows between two trees."""
    return log(b.seconds / a.seconds) / log(b.bodies / a.bodies)


def report(rows: list[Row]) -> str:
    """The table, and the bars."""
    lines = ["bodies  processor s  exponent  CasADi s  operations  CasADi operations"]
    for row, power in zip(rows, ["", *(f"{exponent(a, b):.2f}" for a, b in pairwise(rows))], strict=True):
        times = f"{row.seconds:<11.2f}  {power:<8}  {row.casadi_seconds:<8.2f}"
        lines.append(f"{row.bodies:<6}  {times}  {row.operations:<10}  {row.casadi_operations}")
    bars = (
        ("operations to CasADi's, at most", max(row.operations / row.casadi_operations for row in rows), OPERATIONS),
        ("processor time to CasADi's, at most", max(row.seconds / row.casadi_seconds for row in rows), SECONDS),
        ("the command's time grows as N to the power", exponent(rows[0], rows[-1]), GROWTH),
    )
    lines += [f"{what} {value:.2f}; bar {bar}: {'holds' if value <= bar else 'FAILS'}" for what, value, bar in bars]
    return "\n".join(lines) + "\n"


def main(directory: Path) -> None:
    """Measure, and write ``tree.txt`` into a directory."""
    our_program(SCENE, 3)  # an image of Maxima is made where there is none yet
    write_report(directory / "tree.txt", report([measured(bodies) for bodies in BODIES]))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
