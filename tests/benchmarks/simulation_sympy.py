"""One motion from its energies to its final state, with SymPy and SciPy alone: the one-shot script of a peer.

    python simulation_sympy.py NAME UNTIL TOLERANCE Q1 Q2 ... V1 V2 ...

SymPy differentiates, `lambdify` with common-subexpression elimination makes functions of NumPy of A, h, J and c,
NumPy solves the bordered system [A -J^T; J 0], `solve_ivp` (DOP853) integrates. The final state goes to standard
output, one number a line.
"""

import sys

import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp
from simulation_algebra import DESCRIPTIONS


def main(name: str, until: float, tolerance: float, state: list[float]) -> None:
    size, describe = DESCRIPTIONS[name]
    matrices = derive(size, describe)
    solution = solve_ivp(
        lambda t, y: rates(matrices(t, *y), y), (0.0, until), state, method="DOP853", rtol=tolerance, atol=tolerance
    )
    print(*solution.y[:, -1], sep="\n")


def derive(size, describe):
    """A, h, J and c as one function of t, q, dot q."""
    t, q, v = sp.Symbol("t"), sp.Matrix(sp.symbols(f"q:{size}")), sp.Matrix(sp.symbols(f"v:{size}"))
    system = describe(t, list(q), list(v), sp)
    momenta = sp.Matrix([system.kinetic]).jacobian(v)
    mass = momenta.jacobian(v)
    forces = sp.Matrix(system.forces) + sp.Matrix([sp.sympify(system.kinetic - system.potential)]).jacobian(q).T
    forces -= momenta.jacobian(q) * v + momenta.diff(t).T
    f = sp.Matrix(system.constraints)
    jacobian = f.jacobian(q)
    velocity = jacobian * v + f.diff(t)
    curvature = velocity.jacobian(q) * v + velocity.diff(t)
    return sp.lambdify([t, *q, *v], [mass, forces, jacobian, curvature], cse=True)


def rates(matrices, y):
    """Velocities and accelerations."""
    mass, forces, jacobian, curvature = matrices
    size, count = mass.shape[0], jacobian.shape[0]
    bordered = np.block([[mass, -jacobian.T], [jacobian, np.zeros((count, count))]])
    found = np.linalg.solve(bordered, np.concatenate([forces.ravel(), -curvature.ravel()]))
    return np.concatenate([y[size:], found[:size]])


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]), float(sys.argv[3]), [float(text) for text in sys.argv[4:]])
