"""Closed forms that the independent evaluation must reproduce."""

import pytest
import sympy as sp
from mpmath import mp
from systems import paper_example, pendulum, symbols

from holonom.crosscheck.evaluation import Steps
from holonom.crosscheck.independent import IndependentEquations
from holonom.crosscheck.points import random_point
from holonom.crosscheck.system import MechanicalSystem

Q1, Q2, V1, V2, U, DU, DDU = symbols("q1 q2 dot(q1) dot(q2) u dot(u) ddot(u)")
X, Y, VX, VY, M, G = symbols("x y dot(x) dot(y) m g")

# Section 4 of the paper, its misprints mended; the string's pull by elementary mechanics.
MULTIPLIERS = [
    (paper_example(), ((DDU - U) * (Q1 + Q2) + 2 * (DU - U) * (V1 + V2)) / (1 + 2 * U**2)),
    (
        pendulum(),
        M * (DU**2 + U * DDU + G * Y - VX**2 - VY**2) / (2 * (X**2 + Y**2)),
    ),
]


@pytest.mark.parametrize(("system", "multiplier"), MULTIPLIERS, ids=["paper", "pendulum"])
def test_bordered_system_gives_the_multiplier_known_in_closed_form(
    system: MechanicalSystem, multiplier: sp.Expr
) -> None:
    equations = IndependentEquations(system)
    names = ["q1", "q2", "q3", "dot(q1)", "dot(q2)", "dot(q3)", "x", "y", "dot(x)", "dot(y)"]
    with mp.workdps(40):
        drawn = random_point([*names, "u", "dot(u)", "ddot(u)", "m", "g"], 1, "closed")
        values = {symbol: mp.mpf(number.p) / number.q for symbol, number in drawn.items()}
        (known,) = Steps([multiplier]).real_at(values)
        solution = equations.bordered.solution(values)
        assert mp.almosteq(solution[system.multipliers[0]], known, mp.mpf(10) ** -35)


def test_multiplier_of_a_pendulum_at_rest_is_negative() -> None:
    """+ lambda grad f stands on the right: the string pulls up, against the gradient."""
    at_rest = {X: 0, Y: -1, VX: 0, VY: 0, U: 1, DU: 0, DDU: 0, M: 1, G: 10}
    values = {symbol: mp.mpf(number) for symbol, number in at_rest.items()}
    solution = IndependentEquations(pendulum()).bordered.solution(values)
    assert solution[sp.Symbol("lambda1", real=True)] == -5


def test_jerk_of_a_bob_on_a_string_of_constant_length() -> None:
    """Uniform circular motion without gravity: dddot(x) = -w^2 dot(x)."""
    equations = IndependentEquations(pendulum())
    unit_circle = {X: 0, Y: 1, VX: -3, VY: 0, U: 1, DU: 0, DDU: 0, M: 2, G: 0}
    steady = {**unit_circle, sp.Symbol("dddot(u)", real=True): 0}
    values = {symbol: mp.mpf(number) for symbol, number in steady.items()}
    jerks = equations.bordered_derivatives.solution(values | equations.bordered.solution(values))
    assert jerks[sp.Symbol("dddot(x)", real=True)] == 27
    assert jerks[sp.Symbol("dddot(y)", real=True)] == 0
