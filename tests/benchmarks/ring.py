"""`make bench`: closed chains of N rigid bodies in space, in Euler parameters, against CasADi: one table.

    python tests/benchmarks/ring.py build/benchmarks

Ours is the motion program of `examples/ring.mac`, by the whole command. CasADi starts from the same T and f. Its
inertia has no inverse in Euler parameters: as ours does, it adds J^T J of the unit lengths to it, solves by its sparse
LDL^T of the Schur complement, and eliminates common subexpressions by `cse`. Both programs are compiled by the same
compiler with the same options, and compared at a random point before they are timed.
"""

import json
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import log
from pathlib import Path

import casadi as ca
import numpy as np
from peers import instructions
from timing import program_of_command, write_report

from holonom.program.c_function import compile_c
from holonom.program.motion_program import Program, read_program
from holonom.program.timing import Timer, shortest_times

EXAMPLE = Path(__file__).parents[2] / "examples" / "ring.mac"
BODIES = (4, 8, 16, 32, 64)
LARGEST_COMPILED = 16  # bodies; the C compiler takes minutes for the next
GROWTH, OPERATIONS, EVALUATION = 1.3, 1.0, 1.1  # bars
INERTIA = (0.1, 0.05, 0.1)
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
    theirs_seconds, theirs = casadi_program(joints_of_ring, bodies, ours)
    times = (None, None) if bodies > LARGEST_COMPILED else evaluations(ours, theirs)
    return Row(bodies, seconds, ours.operations, theirs_seconds, theirs.operations, *times)


def our_program(scene: Path, bodies: int) -> tuple[float, Program]:
    """Processor seconds of the whole command, and the program."""
    text, seconds, _ = program_of_command(scene, f"N={bodies}")
    return seconds, read_program(text)


def casadi_program(joints_of: Callable, bodies: int, ours: Program) -> tuple[float, Program]:
    """Processor seconds of CasADi, and its program of bodies with joints, with the inputs and outputs of ours."""
    begun = time.process_time()
    t, q, v = ca.SX.sym("t"), ca.SX.sym("q", 7 * bodies), ca.SX.sym("v", 7 * bodies)
    kinetic, lengths, joints = description(joints_of, bodies, q, v)
    momenta = ca.gradient(kinetic, v)
    mass = ca.jacobian(momenta, v)
    force = ca.gradient(kinetic, q) - ca.jtimes(momenta, q, v)
    f = ca.vertcat(lengths, joints)
    jacobian = ca.jacobian(f, q)
    curvature = ca.jtimes(ca.jtimes(f, q, v), q, v)
    unit = jacobian[:bodies, :]
    mass, force = mass + unit.T @ unit, force - unit.T @ curvature[:bodies]
    inverse_of_mass = ldl_solver(mass)
    by_mass = inverse_of_mass(ca.horzcat(jacobian.T, force))
    across, free = by_mass[:, :-1], by_mass[:, -1]
    multipliers = -ldl_solver(jacobian @ across)(jacobian @ free + curvature)
    results = ca.cse(ca.vertcat(free + across @ multipliers, multipliers))
    function = ca.Function("ring", [ca.vertcat(t, q, v)], [results])
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
    return time.process_time() - begun, read_program(json.dumps(document))


def ldl_solver(matrix):
    """The solve by a sparse LDL^T in CasADi's own order."""
    diagonal, factor, order = ca.ldl(matrix)
    return lambda sides: ca.sparsify(ca.ldl_solve(sides, diagonal, factor, order))


def description(joints_of: Callable, bodies: int, q, v):
    """T, |e|^2 - 1 of each body, and the joints between places and axes of bodies."""
    kinetic, lengths, placed = 0, [], []
    for k in range(bodies):
        place, e, velocity, rate = (
            q[7 * k : 7 * k + 3],
            q[7 * k + 3 : 7 * k + 7],
            v[7 * k : 7 * k + 3],
            v[7 * k + 3 : 7 * k + 7],
        )
        e0, e1, e2, e3 = ca.vertsplit(e)
        in_body = ca.vertcat(ca.horzcat(-e1, e0, e3, -e2), ca.horzcat(-e2, -e3, e0, e1), ca.horzcat(-e3, e2, -e1, e0))
        spin = 2 * in_body @ rate
        kinetic += (ca.dot(velocity, velocity) + ca.dot(ca.DM(INERTIA) * spin, spin)) / 2
        lengths.append(ca.dot(e, e) - 1)
        axis = ca.vertcat(2 * (e1 * e2 - e0 * e3), e0**2 - e1**2 + e2**2 - e3**2, 2 * (e2 * e3 + e0 * e1))
        placed.append((place, axis))
    return kinetic, ca.vertcat(*lengths), ca.vertcat(*joints_of(placed))


def joints_of_ring(placed: list) -> list:
    """The end of each body less the beginning of the next, as `examples/ring.mac` has them."""
    ends = [(c - half * axis, c + half * axis) for half, (c, axis) in zip(half_sides(len(placed)), placed, strict=True)]
    return [end - beginning for (_, end), (beginning, _) in zip(ends, [*ends[1:], ends[0]], strict=True)]


def half_sides(bodies: int) -> list[float]:
    """Of the polygon whose corners the example puts on a circle."""
    angles = [2 * np.arctan(round(1000 * np.tan(np.pi * k / (4 * bodies))) / 1000) for k in range(bodies + 1)]
    return [float(np.sin(2 * (b - a))) for a, b in pairwise(angles)]


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
