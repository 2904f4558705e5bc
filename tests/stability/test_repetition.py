"""Equations that repeat after a period or a turn, and others that agree with such for a while."""

import numpy as np
import pytest
import sympy as sp

import holonom

SCENE = """system : holonomic_system(coordinates = [x], controls = [u], parameters = [k], kinetic_energy = dot(x)^2/2,
  potential_energy = ({stiffness})*x^2/2, forces = [damping = [-k*dot(x)/4]])$
s : holonomic_scene(system, parameter_values = [k = 2], control_law = [u = {law}], nominal = [x = 1],
  initial_state = [x = 0, dot(x) = 0])$"""

REPEATING = [
    ("4 + sin(2*%pi*t)*cos(4*%pi*t + 1)", "u"),
    ("cos(%pi*t)", "4 + u^2*sin(%pi*t + 1)*u"),
    ("cos(%pi*t)^3", "4 + abs(u) + cosh(u) + u^(-2)*sinh(u)*tan(u)/4"),
    ("4 + exp(sin(2*%pi*t + cos(2*%pi*t)))", "u"),
    ("t", "4 + dot(u)*cos(2*%pi*u)/(3 + sin(2*%pi*t))"),
    ("2 - cos(sqrt(k)*sqrt(2)*%pi*t)", "u"),
    ("signum(sin(2*%pi*t + 1))", "4 + u"),
]
OTHERS = [
    ("if t < 5/2 then 4 else -4", "u"),
    ("4 - 100/(1 + 1000*(t - 5)^2)^20", "u"),
    ("4 + t/10^10", "u"),
    ("4 + sin(t/10^9)", "u"),
    ("1 + cos(%pi*t)", "4 + u^2"),
    ("cos(%pi*t)", "4 + exp(u)"),
    ("4 + sin(2*%pi*t + 10^(-6)*t)", "u"),
    ("4 + sin(2*%pi*t) + sin(2*t)", "u"),
    ("(3 + cos(2*%pi*t))^(1 + t/10^9)", "u"),
    ("4/(1 + t/10^9)", "u"),
    ("table([[0, 4], [1, 5], [2, 4], [20, 4]])", "u"),
]


@pytest.mark.parametrize(
    ("law", "stiffness", "expected"), [*((*each, True) for each in REPEATING), *((*each, False) for each in OTHERS)]
)
def test_motions_have_multipliers_if_the_equations_repeat_for_ever(law, stiffness, expected):
    """Of those that do so for the first two periods alone, the state at rest was called asymptotically stable."""
    found = holonom.system(SCENE.format(law=law, stiffness=stiffness)).linearize_along(until=1, samples=2)
    assert (found.floquet is not None) is expected


@pytest.mark.parametrize("digits", [pytest.param(3, marks=pytest.mark.long), 12])
def test_a_period_has_the_digits_that_are_given(digits):
    scene = holonom.system(SCENE.format(law="4 + sin(t)", stiffness="u"))
    found = scene.linearize_along(until=f"{2 * np.pi:.{digits}f}", samples=2)
    assert (found.floquet is not None) is (digits == 12)


# ---- whole turns -----------------------------------------------------------------------------------------------------

TURNING = """system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + (1 + cos(x)^2)*dot(y)^2)/2,
  potential_energy = {potential})$
s : holonomic_scene(system, initial_state = [x = 1/10, y = 0, dot(x) = 0, dot(y) = 0])$"""


@pytest.mark.parametrize(
    ("potential", "turns"),
    [
        ("-cos(x) + y^2/2", ("x",)),
        ("-cos(x + 2*y) - cos(y)", ("x", "y")),
        ("-cos(x + y/2) + sin(y/2)*cos(y/2)", ("x",)),
        ("sin(x/2)^2 + tan(y/2)^2/(1 + tan(y/2)^2)", ("x", "y")),
        ("-cos(x/2) + y^2/2", ()),
        ("-cos(3*x/2) - cos(y)*exp(sin(y))", ("y",)),
        ("-cos(x) + y^2/2 - 30*exp(-(x - 12)^2)", ()),
        ("-10*cos(x) + exp(5*(x - 20)) + y^2/2", ()),
        ("-10*cos(x) + 25*max(0, x - 20)^2 + y^2/2", ()),
    ],
)
def test_coordinates_that_whole_turns_do_not_change(potential, turns):
    """Far from the initial state a well, a wall and a stop were not met: those near 3 pi were listed near pi."""
    found = holonom.system(TURNING.format(potential=potential)).equilibria(starts=100)
    assert found.turns == turns
    x, y = sp.symbols("x y", real=True)
    energy = sp.parse_expr(potential.replace("^", "**").replace("max", "Max"), local_dict={"x": x, "y": y})
    for each in found:
        at = {x: each.coordinates["x"], y: each.coordinates["y"]}
        assert [float(sp.diff(energy, q).subs(at)) for q in (x, y)] == pytest.approx([0, 0], abs=1e-6)
