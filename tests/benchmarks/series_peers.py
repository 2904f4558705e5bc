"""Who expands the paper's example under u = 3/10 + t in a power series, and how long the expansion takes.

Holonom is given the scene file. The peers are given the equations solved by hand, which spares them the derivation:
with s = q1 + q2,

    ddot(q1) = -s - u lambda,  ddot(q2) = -2 dot(s) - u lambda,  lambda = (2 dot(s) - u (s + 2 dot(s)))/(1 + 2 u^2).

Each does what it has for that: SymPy differentiates along the motion, as equation (18) does on paper; mpmath expands
as its integrator `odefun` does; JAX propagates Taylor coefficients through `jax.experimental.jet`, one order a pass;
heyoka by hand is the limit for ours.
"""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from holonom.program.heyoka_function import import_heyoka
from holonom.program.motion_problem import MotionProblem, motion_problem
from holonom.program.precision import read_precision
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.series.compute import compute_series
from holonom.series.heyoka_series import OFTEN, expanding_integrator
from holonom.series.request import SeriesRequest

PAPER = Path(__file__).parents[2] / "examples" / "paper" / "paper.mac"
START = ((3, 10), (1, 1), (2, 1), (1, 2), (-1, 3))  # u, q1, q2, dot(q1), dot(q2)
DIGITS = 30
STEPS = 20  # the shortest of several counts


@dataclass(frozen=True)
class Expansion:
    """Coefficients of q1 from order 0, the seconds they took, and those to compile before where that is apart."""

    coefficients: Sequence[Any]
    expand: float
    compile: float | None = None


Method = Callable[[int], Expansion]


def rates(u: Any, q1: Any, q2: Any, v1: Any, v2: Any) -> tuple[Any, ...]:
    """Rates of (u, q1, q2, dot(q1), dot(q2))."""
    s, ds = q1 + q2, v1 + v2
    reaction = (2 * ds - u * (s + 2 * ds)) / (1 + 2 * u * u)
    return u * 0 + 1, v1, v2, -s - u * reaction, -2 * ds - u * reaction


def exact(order: int) -> Expansion:
    """Holonom: Maxima's whole process, rational coefficients."""
    return _maxima(order, "exact")


def rounded(order: int) -> Expansion:
    """Holonom: Maxima's whole process, confirmed digits."""
    return _maxima(order, DIGITS)


def _maxima(order: int, digits: int | str) -> Expansion:
    start = time.perf_counter()
    motion = compute_series(PAPER, SeriesRequest(order, digits=digits), Limits())
    return Expansion(motion.coordinates["q1"], time.perf_counter() - start)


def heyoka(order: int) -> Expansion:
    """Holonom: the motion program in heyoka, double precision."""
    problem, double = _problem(), read_precision("double")
    return _compiled(order, lambda: expanding_integrator(problem, order, double, OFTEN), row=0)


@cache
def _problem() -> MotionProblem:
    return motion_problem(PAPER, Request(), Limits(), digits=27)


def heyoka_by_hand(order: int) -> Expansion:
    """heyoka: the equations above, in the mode that its manual recommends for high orders."""
    module = import_heyoka()
    names = ("u", "q1", "q2", "v1", "v2")
    variables = module.make_vars(*names)
    return _compiled(order, lambda: _integrator_by_hand(module, variables, order), row=1)


def _integrator_by_hand(module: ModuleType, variables: Sequence[Any], order: int) -> Any:
    equations = list(zip(variables, rates(*variables), strict=True))
    equations[0] = (variables[0], module.expression(1.0))
    start = [numerator / denominator for numerator, denominator in START]
    return module.taylor_adaptive(equations, start, tol=math.exp(-2 * order) * (1 + 1e-9), compact_mode=True)


def _compiled(order: int, build: Callable[[], Any], row: int) -> Expansion:
    """One step of an integrator, and what building it takes without heyoka's cache."""
    states = import_heyoka().llvm_state
    states.set_diskcache_enabled(False)
    states.set_memcache_limit(0)
    start = time.perf_counter()
    integrator = build()
    compiled = time.perf_counter() - start
    time_point, state = integrator.time, integrator.state.copy()
    times = []
    for _ in range(STEPS):
        integrator.time, integrator.state[:] = time_point, state
        start = time.perf_counter()
        integrator.step(write_tc=True)
        times.append(time.perf_counter() - start)
    return Expansion([float(x) for x in integrator.tc[row][: order + 1]], min(times), compiled)


def sympy(order: int) -> Expansion:
    """SymPy: total derivatives along the motion, simplified, evaluated at the start."""
    import sympy as sp

    start = time.perf_counter()
    state = sp.symbols("u q1 q2 v1 v2")
    flow = rates(*state)
    values = dict(zip(state, (sp.Rational(*pair) for pair in START), strict=True))
    derivative, coefficients = state[1], []
    for n in range(order + 1):
        coefficients.append(derivative.xreplace(values) / sp.factorial(n))
        derivative = sp.together(sum(sp.diff(derivative, x) * rate for x, rate in zip(state, flow, strict=True)))
    return Expansion(coefficients, time.perf_counter() - start)


def mpmath(order: int) -> Expansion:
    """mpmath: the expansion inside odefun, in a double's precision."""
    import mpmath as mp
    from mpmath.calculus.odes import ode_taylor

    with mp.workprec(53):
        start = time.perf_counter()
        state = [mp.mpf(numerator) / denominator for numerator, denominator in START]
        series, _ = ode_taylor(mp.mp, lambda t, y: list(rates(*y)), mp.mpf(0), state, 53, order)
        seconds = time.perf_counter() - start
    return Expansion(series[1][: order + 1], seconds)


def jet(order: int) -> Expansion:
    """JAX: jet, one order more a pass; the first time it compiles."""
    start = time.perf_counter()
    _jet(order)
    first = time.perf_counter()
    coefficients = _jet(order)
    expand = time.perf_counter() - first
    return Expansion(coefficients, expand, first - start - expand)


def _jet(order: int) -> list[float]:
    import jax
    from jax.experimental import jet as experimental

    jax.config.update("jax_enable_x64", True)
    state = tuple(np.float64(numerator) / denominator for numerator, denominator in START)
    derivatives = [[rate] for rate in rates(*state)]
    for _ in range(order - 1):
        values, higher = experimental.jet(rates, state, derivatives)
        derivatives = [[value, *rest] for value, rest in zip(values, higher, strict=True)]
    return [float(state[1]), *(float(d) / math.factorial(n) for n, d in enumerate(derivatives[1], 1))]


METHODS: dict[str, Method] = {
    "Holonom, Maxima exact": exact,
    f"Holonom, Maxima {DIGITS} digits": rounded,
    "Holonom, heyoka double": heyoka,
    "heyoka by hand": heyoka_by_hand,
    "mpmath": mpmath,
    "SymPy": sympy,
    "jax.experimental.jet": jet,
}
