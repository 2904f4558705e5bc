"""`make bench`: closed chains of N rigid bodies in space, in Euler parameters, against CasADi: one table.

    python tests/benchmarks/ring.py build/benchmarks

Ours is the motion program of `examples/ring.mac`, by the whole command. CasADi starts from the same T and f, in a
process of its own (`casadi_functions.py`). Both programs are compiled by the same compiler with the same options, and
compared at a random point before they are timed.
"""

import json
import sys
from dataclasses import dataclass
from itertools import pairwise
from math import log
from pathlib import Path
from tempfile import TemporaryDirectory

import casadi as ca
import numpy as np
from peers import instructions
from timing import CASADI, cost_of, program_of_command, write_report

from holonom.program.c_function import compile_c
from holonom.program.motion_program import Program, read_program
from holonom.program.timing import Timer, shortest_times

EXAMPLE = Path(__file__).parents[2] / "examples" / "ring.mac"
BODIES = (4, 8, 16, 32, 64)
LARGEST_COMPILED = 16  # bodies; the C compiler takes minutes for the next
GROWTH, OPERATIONS, EVALUATION = 1.3, 1.0, 1.1  # bars
TOLERANCE = 1e-8


@dataclass(frozen=True)
class Row:
    """One ring: processor seconds, operations, and seconds of an evaluation, None where it was not compiled."""

    bodies: int
    seconds: float
    operations: int
    casadi_seconds: float
    casadi_operations: int
    evaluation: float | None
    casadi_evaluation: float | None


def measured(bodies: int) -> Row:
    """One row of the table."""
    seconds, ours = our_program(EXAMPLE, bodies)
    theirs_seconds, theirs = casadi_program("ring", bodies, ours)
    times = (None, None) if bodies > LARGEST_COMPILED else evaluations(ours, theirs)
    return Row(bodies, seconds, ours.operations, theirs_seconds, theirs.operations, *times)


def our_program(scene: Path, bodies: int) -> tuple[float, Program]:
    """Processor seconds of the whole command, and the program."""
    text, seconds, _ = program_of_command(scene, f"N={bodies}")
    return seconds, read_program(text)


def casadi_program(system: str, bodies: int, ours: Program) -> tuple[float, Program]:
    """Processor seconds of CasADi's process, and its program with the inputs and outputs of ours."""
    with TemporaryDirectory() as directory:
        file = Path(directory, "function.casadi")
        seconds, _ = cost_of(sys.executable, CASADI, system, str(bodies), str(file))
        function = ca.Function.load(str(file))
    document = {
        "format": "holonom-program",
        "version": 2,
        "scene": None,
        "solve": "direct",
        "method": "CasADi",
        "redundant": [],
        "operations": 0,
        "inputs": list(ours.inputs),
        "assignments": instructions(function, ours.inputs),
        "outputs": {name: f"out{index}" for index, name in enumerate(ours.outputs)},
    }
    return seconds, read_program(json.dumps(document))


def evaluations(ours: Program, theirs: Program) -> tuple[float, float]:
    """Seconds of one evaluation of each, compiled, where their accelerations are the same."""
    point = np.random.default_rng(1).uniform(-1, 1, len(ours.inputs))
    functions = [compile_c(program) for program in (ours, theirs)]
    found = [np.array(function(point)) for function in functions]
    accelerations = [index for index, name in enumerate(ours.outputs) if name.startswith("ddot(")]
    deviation = np.max(np.abs(found[0] - found[1])[accelerations]) / np.max(np.abs(found[0][accelerations]))
    if not deviation <= TOLERANCE:
        raise ArithmeticError(f"CasADi's accelerations deviate by {deviation} of their size")
    timer = Timer()
    times = shortest_times({index: timer.evaluation(function, point) for index, function in enumerate(functions)})
    return times[0], times[1]


def report(rows: list[Row]) -> str:
    """The table, and the bars."""
    lines = ["bodies  processor s  exponent  operations  CasADi s  CasADi operations  ours us  CasADi us"]
    exponents = ["", *(f"{exponent(a, b):.2f}" for a, b in pairwise(rows))]
    for row, power in zip(rows, exponents, strict=True):
        times = ("" if each is None else f"{each * 1e6:.2f}" for each in (row.evaluation, row.casadi_evaluation))
        cells = (f"{row.seconds:<11.2f}", f"{power:<8}", f"{row.operations:<10}", f"{row.casadi_seconds:<8.2f}")
        lines.append(
            "  ".join(
                (f"{row.bodies:<6}", *cells, f"{row.casadi_operations:<17}", *(f"{t:<7}" for t in times))
            ).rstrip()
        )
    operations = max(row.operations / row.casadi_operations for row in rows)
    evaluation = max(row.evaluation / row.casadi_evaluation for row in rows if row.evaluation is not None)
    bars = (
        ("the command's time grows as N to the power", exponent(rows[0], rows[-1]), GROWTH),
        ("operations to CasADi's, at most", operations, OPERATIONS),
        ("time of an evaluation to CasADi's, at most", evaluation, EVALUATION),
    )
    lines += [f"{what} {value:.2f}; bar {bar}: {'holds' if value <= bar else 'FAILS'}" for what, value, bar in bars]
    return "\n".join(lines) + "\n"


def exponent(a: Row, b: Row) -> float:
    """How the time grows between two rings."""
    return log(b.seconds / a.seconds) / log(b.bodies / a.bodies)


def main(directory: Path) -> None:
    """Measure, and write ``ring.txt`` into a directory."""
    our_program(EXAMPLE, 3)  # an image of Maxima is made where there is none yet
    write_report(directory / "ring.txt", report([measured(bodies) for bodies in BODIES]))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
