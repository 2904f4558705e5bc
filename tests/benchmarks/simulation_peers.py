"""Who follows the motions: heyoka and DOP853 by hand, SciPy, SUNDIALS, CasADi; mpmath for many digits.

A peer is prepared for a motion, then for a tolerance; what comes out takes the scene's start to the final state.
"""

import contextlib
import ctypes
import subprocess
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path

import heyoka as hy
import numpy as np
from numpy.typing import NDArray
from scipy.integrate import ode, odeint
from scipy.integrate._ivp import dop853_coefficients as dop853
from simulation_algebra import DESCRIPTIONS
from simulation_motions import Motion

from holonom.benchmark.work_precision.solvers import SOLVERS, RightHandSide, Solver
from holonom.failures import ErrorKind, HolonomError
from holonom.program.motion_problem import MotionProblem

HERE = Path(__file__).parent
COMPILER = ("cc", "-std=c99", "-O3", "-march=native", "-ffp-contract=fast", "-shared", "-fPIC")
MOST_STEPS = 10_000_000

State = NDArray[np.float64]
Run = Callable[[], State]
Prepared = Callable[[float], Run]
Peer = Callable[[Motion, MotionProblem], Prepared]

STAGES = """
for (int i = 0; i < N; i++) w[i] = y[i] + h*({sum});
MOTION(t + {fraction!r}*h, w, k{stage});"""
EXPORTED = """
void accelerations(const double *in, double *out)
{
    double rates[N];
    MOTION(in[0], in + 1, rates);
    for (int i = 0; i < N/2; i++) out[i] = rates[N/2 + i];
}
"""


def start_of(problem: MotionProblem) -> State:
    """The scene's initial state."""
    return np.array([float(problem.start[name]) for name in problem.state])


def span_of(motion: Motion, problem: MotionProblem) -> tuple[float, float]:
    """First and last time."""
    return float(problem.start["t"]), float(motion.until)


def heyoka_by_hand(motion: Motion, problem: MotionProblem) -> Prepared:
    """heyoka's integrator on hand-written accelerations."""
    state = [hy.expression(name) for name in problem.state]
    q, v = state[: len(state) // 2], state[len(state) // 2 :]
    equations = list(zip(state, [*v, *motion.by_hand(q, v)], strict=True))
    start, (begin, end) = start_of(problem), span_of(motion, problem)

    def at_tolerance(tolerance: float) -> Run:
        integrator = hy.taylor_adaptive(equations, start.copy(), time=begin, tol=tolerance)

        def run() -> State:
            integrator.state[:] = start
            integrator.time = begin
            integrator.propagate_until(end)
            return integrator.state.copy()

        return run

    return at_tolerance


def dop853_in_c(motion: Motion, problem: MotionProblem) -> Prepared:
    """Dormand and Prince's method of order 8 with a hand-written right-hand side, all in C."""
    integrate = library_by_hand(motion, problem).integrate
    integrate.argtypes = (ctypes.c_double, ctypes.c_double, ctypes.c_double, ctypes.c_void_p)
    integrate.restype = ctypes.c_long
    start, (begin, end) = start_of(problem), span_of(motion, problem)

    def at_tolerance(tolerance: float) -> Run:
        state = start.copy()
        address = state.ctypes.data

        def run() -> State:
            state[:] = start
            integrate(begin, end, tolerance, address)
            return state.copy()

        return run

    return at_tolerance


def python_integrator(solver: Solver, motion: Motion, problem: MotionProblem) -> Prepared:
    """An integrator for Python on the hand-written right-hand side in C."""
    coordinates = len(problem.coordinates)
    accelerations = library_by_hand(motion, problem).accelerations
    accelerations.restype = None
    right_hand_side = RightHandSide(accelerations, coordinates, 2 * coordinates + 1)
    start, span = start_of(problem), span_of(motion, problem)
    return lambda tolerance: partial(solver, right_hand_side, span, start, tolerance)


def casadi_cvodes(motion: Motion, problem: MotionProblem) -> Prepared:
    """CasADi derives, writes C and compiles it; CVODES integrates."""
    import casadi as ca

    size, describe = DESCRIPTIONS[motion.name]
    t, state = ca.SX.sym("t"), ca.SX.sym("y", 2 * size)
    q, v = state[:size], state[size:]
    system = describe(t, ca.vertsplit(q), ca.vertsplit(v), ca)
    momenta = ca.gradient(ca.SX(system.kinetic), v)
    mass, f = ca.jacobian(momenta, v), ca.vertcat(*system.constraints)
    forces = ca.vertcat(*system.forces) + ca.gradient(ca.SX(system.kinetic - system.potential), q)
    forces -= ca.jtimes(momenta, q, v) + ca.jacobian(momenta, t)
    jacobian = ca.jacobian(f, q)
    velocity = ca.jtimes(f, q, v) + ca.jacobian(f, t)
    curvature = ca.jtimes(velocity, q, v) + ca.jacobian(velocity, t)
    weighted = _ldl_solved(mass, jacobian.T)
    unconstrained = _ldl_solved(mass, forces)
    multipliers = _ldl_solved(jacobian @ weighted, -(curvature + jacobian @ unconstrained))
    equations = {"t": t, "x": state, "ode": ca.vertcat(v, unconstrained + weighted @ multipliers)}
    start, (begin, end) = ca.DM(start_of(problem)), span_of(motion, problem)

    def at_tolerance(tolerance: float) -> Run:
        options = {"abstol": tolerance, "reltol": tolerance, "max_num_steps": MOST_STEPS}
        compiled = {"jit": True, "compiler": "shell", "jit_options": {"flags": ["-O3", "-march=native"]}}
        with contextlib.chdir(tempfile.gettempdir()):  # CasADi compiles where it stands
            integrator = ca.integrator("motion", "cvodes", equations, begin, end, options | compiled)
        return lambda: integrator(x0=start)["xf"].full().ravel()

    return at_tolerance


def library_by_hand(motion: Motion, problem: MotionProblem) -> ctypes.CDLL:
    """The motion's hand-written function with DOP853 around it, compiled by the system's C compiler."""
    source = "\n".join(
        [
            (HERE / "simulation_motions.c").read_text(encoding="utf-8"),
            f"#define N {len(problem.state)}",
            f"#define MOTION {motion.name}",
            *_coefficients(),
            (HERE / "simulation_dop853.c").read_text(encoding="utf-8"),
            EXPORTED,
        ]
    )
    with tempfile.TemporaryDirectory() as directory:
        file, library = Path(directory, "motion.c"), Path(directory, "motion.so")
        file.write_text(source, encoding="utf-8")
        subprocess.run([*COMPILER, "-I", str(HERE), str(file), "-o", str(library), "-lm"], check=True)
        return ctypes.CDLL(str(library))


def _coefficients() -> Iterable[str]:
    """The macros that `simulation_dop853.c` asks for."""
    stages = [
        STAGES.format(sum=_sum(dop853.A[stage - 1, : stage - 1], "i"), fraction=float(dop853.C[stage - 1]), stage=stage)
        for stage in range(2, dop853.N_STAGES + 1)
    ]
    yield "#define STAGES " + " ".join(stages).replace("\n", " ")
    for name, row in (("SOLUTION", dop853.B), ("ERROR5", dop853.E5), ("ERROR3", dop853.E3)):
        yield f"#define {name}(i) {_sum(row, 'i')}"


def _sum(coefficients: Sequence[float], index: str) -> str:
    terms = (f"{float(a)!r}*k{stage}[{index}]" for stage, a in enumerate(coefficients, start=1) if a != 0)
    return " + ".join(terms)


def _ldl_solved(matrix: object, side: object) -> object:
    import casadi as ca

    diagonal, factor, order = ca.ldl(matrix)
    return ca.ldl_solve(side, diagonal, factor, order)


def _scipy_ode(motion: RightHandSide, span: tuple[float, float], start: State, tol: float) -> State:
    integrator = ode(motion).set_integrator("dop853", rtol=tol, atol=tol, nsteps=MOST_STEPS)
    integrator.set_initial_value(start, span[0])
    state = integrator.integrate(span[1])
    if not integrator.successful():
        raise HolonomError(ErrorKind.METHOD_GAVE_UP, detail="scipy.integrate.ode gave up")
    return state


def _scipy_odeint(motion: RightHandSide, span: tuple[float, float], start: State, tol: float) -> State:
    states, said = odeint(motion, start, span, tfirst=True, rtol=tol, atol=tol, mxstep=MOST_STEPS, full_output=True)
    if said["message"] != "Integration successful.":
        raise HolonomError(ErrorKind.METHOD_GAVE_UP, detail=f"scipy.integrate.odeint: {said['message']}")
    return states[-1]


HEYOKA, DOP853 = "heyoka by hand", "DOP853 in C by hand"
CASADI = "CasADi with CVODES"
SOLVE_IVP = tuple(name for name in SOLVERS if name.startswith("SciPy"))
SUNDIALS = (*(name for name in SOLVERS if name.startswith("SUNDIALS")), CASADI)
OLDER_SCIPY: Mapping[str, Solver] = {"SciPy ode, dop853": _scipy_ode, "SciPy odeint": _scipy_odeint}
PEERS: Mapping[str, Peer] = {
    HEYOKA: heyoka_by_hand,
    DOP853: dop853_in_c,
    **{name: partial(python_integrator, solver) for name, solver in (SOLVERS | OLDER_SCIPY).items()},
    CASADI: casadi_cvodes,
}
