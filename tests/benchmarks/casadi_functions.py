"""CasADi's functions of the same chains, rings and trees: from the description to a file, in a process of its own.

    python tests/benchmarks/casadi_functions.py chain|ring|tree N FILE

As CasADi's manual has it, SX graphs, the Schur complement by its sparse LDL^T, and `cse`. Inertia has no inverse in
Euler parameters: as ours does, the function of bodies adds J^T J of the unit lengths to it. The file is C where its
name ends so, otherwise CasADi's own.
"""

import sys
from collections.abc import Callable
from itertools import pairwise
from math import atan, pi, sin, tan
from pathlib import Path

import casadi as ca
import chain

INERTIA = (0.1, 0.05, 0.1)


def chain_of(links: int) -> tuple[ca.SX, ca.SX]:
    """Inputs and results of a chain whose first link has the length u."""
    q, v, controls = ca.SX.sym("q", 2 * links), ca.SX.sym("v", 2 * links), ca.SX.sym("u", 3)
    state, rate = ca.vertcat(q, v, controls[:2]), ca.vertcat(v, ca.SX(v.numel(), 1), controls[1:])
    f = ca.vertcat(*chain.constraints(ca.vertsplit(q), controls[0]))
    jacobian = ca.jacobian(f, q)
    curvature = ca.jtimes(ca.jtimes(f, state, rate), state, rate)
    applied = ca.DM([0, -float(chain.GRAVITY)] * links)
    multipliers = -ldl_solver(jacobian @ jacobian.T)(curvature + jacobian @ applied)
    inputs = ca.vertcat(ca.SX.sym("t"), q, v, controls)
    return inputs, ca.vertcat(applied + jacobian.T @ multipliers, multipliers)


def bodies_of(joints_of: Callable, bodies: int) -> tuple[ca.SX, ca.SX]:
    """Inputs and results of bodies with joints."""
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
    by_mass = ldl_solver(mass)(ca.horzcat(jacobian.T, force))
    across, free = by_mass[:, :-1], by_mass[:, -1]
    multipliers = -ldl_solver(jacobian @ across)(jacobian @ free + curvature)
    return ca.vertcat(t, q, v), ca.vertcat(free + across @ multipliers, multipliers)


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
    angles = [2 * atan(round(1000 * tan(pi * k / (4 * bodies))) / 1000) for k in range(bodies + 1)]
    return [sin(2 * (b - a)) for a, b in pairwise(angles)]


def joints_of_tree(placed: list) -> list:
    """The end of the body above less the beginning of each, as `tree.mac` has them."""
    ends = [0, *(centre + axis / 2 for centre, axis in placed)]
    return [ends[k // 2] - centre + axis / 2 for k, (centre, axis) in enumerate(placed, start=1)]


SYSTEMS = {
    "chain": chain_of,
    "ring": lambda bodies: bodies_of(joints_of_ring, bodies),
    "tree": lambda bodies: bodies_of(joints_of_tree, bodies),
}


def write(system: str, size: int, file: Path) -> None:
    """Write the function of a system of some size."""
    inputs, results = SYSTEMS[system](size)
    function = ca.Function(system + "_", [inputs], [ca.cse(results)])
    if file.suffix == ".c":
        generator = ca.CodeGenerator(file.name)
        generator.add(function)
        generator.generate(f"{file.parent}/")
    else:
        function.save(str(file))


if __name__ == "__main__":
    write(sys.argv[1], int(sys.argv[2]), Path(sys.argv[3]))
