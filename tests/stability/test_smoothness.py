"""Linearizations where a sign is zero, and the equations have derivatives all the same."""

import numpy as np
import pytest
from refusing import failing

import holonom
from holonom.failures import ErrorKind
from holonom.stability.equilibria import Stability


def scene(force: str, controls: str = "", law: str = "", initial: str = "x = 0, dot(x) = 0"):
    return holonom.system(f"""
      system : holonomic_system(coordinates = [x], {controls} kinetic_energy = dot(x)^2/2, forces = [{force}])$
      run : holonomic_scene(system, {law} initial_state = [{initial}], time_span = [0, 1])$""")


@pytest.mark.parametrize(
    ("force", "slopes"),
    [
        ("-4*x - 3*dot(x)*abs(dot(x))", [-4, 0]),
        ("-4*x - dot(x) - 2*x*abs(x)", [-4, -1]),
        ("-4*x - dot(x)*(2 + abs(dot(x) - x))", [-4, -2]),
        ("-4*x - max(0, dot(x))^2 + max(0, -x)^2", [-4, 0]),
        ("max(-1, min(1, -4*x - dot(x)))", [-4, -1]),
    ],
)
def test_a_force_with_continuous_derivatives_is_linearized(force, slopes):
    found = scene(force).linearize()
    assert np.array([[0, 1], slopes]) == pytest.approx(found.A, abs=1e-14)
    [rest] = scene(force).equilibria(starts=20).found
    assert rest.coordinates["x"] == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize(
    "force",
    [
        "-4*x - signum(dot(x))",
        "-4*x - abs(x)",
        "-4*x - abs(dot(x))",
        "-4*x - dot(x)*(2 + signum(x - dot(x)))",
        "-10^13*x - signum(dot(x))",
        "-10^13*x - abs(x)/10",
    ],
)
def test_a_force_with_a_jump_or_a_kink_is_not(force):
    with failing(ErrorKind.NOT_ANALYTIC):
        scene(force).linearize()


def test_a_control_that_is_zero_hides_no_jump():
    """u signum(dot(x)) is zero on both sides under u = 0, and its slope by u is not."""
    friction = scene("-x - u*signum(dot(x))", "controls = [u],", "control_law = [u = 0],")
    for ask in (friction.linearize, friction.equilibria):
        with failing(ErrorKind.NOT_ANALYTIC):
            ask()


def test_the_sign_of_a_control_at_rest_is_known():
    bounded = scene("-x^3 - 4*x + max(-1, min(1, u))", "controls = [u],", "control_law = [u = 1/2],")
    [rest] = bounded.equilibria(starts=20).found
    x = rest.coordinates["x"]
    assert x**3 + 4 * x == pytest.approx(0.5)


def plane(force: str, output: str = "speed^2"):
    return holonom.system(f"""
      speed : sqrt(dot(x)^2 + dot(y)^2)$
      system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
        potential_energy = [springs = 2*x^2 + 8*y^2], forces = [{force}])$
      run : holonomic_scene(system, initial_state = [x = 0, y = 0, dot(x) = 0, dot(y) = 0], time_span = [0, 1],
        observe = [output = {output}])$""")


@pytest.mark.parametrize(
    ("force", "damping"),
    [
        ("drag = -3*speed*[dot(x), dot(y)]", 0),
        ("drag = -3*(1 + speed)*[dot(x), dot(y)]", 3),
        ("drag = -(1 + x)*(dot(x)^2 + dot(y)^2)^(3/4)*[dot(x), dot(y)]/(1 + speed)", 0),
        ("drag = -3*speed*[dot(x), dot(y)] - abs(dot(x))*[dot(x), 0]", 0),
    ],
)
def test_drag_in_a_plane_is_linearized_at_rest(force, damping):
    found = plane(force).linearize()
    expected = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.diag([4, 16]), -damping * np.eye(2)]])
    assert expected == pytest.approx(found.A, abs=1e-14)
    [rest] = plane(force).equilibria(starts=20).found
    assert [*rest.coordinates.values()] == pytest.approx([0, 0], abs=1e-9)


@pytest.mark.parametrize(
    "force",
    [
        "-[dot(x), dot(y)]/speed",
        "[dot(x)*dot(y)/speed, 0]",
        "-(dot(x)^2 + dot(y)^2)^(1/4)*[dot(x), dot(y)]/speed",
        "-10^13*[x, y] - [0, dot(x)^2/speed]",
        "[speed, 0]",
    ],
)
def test_forces_by_the_direction_alone_are_not(force):
    with failing(ErrorKind.NO_DERIVATIVES):
        plane(f"friction = {force}").linearize()


def test_an_output_without_a_derivative_hides_no_equilibrium():
    quick = plane("drag = -speed*[dot(x), dot(y)]", output="speed")
    [rest] = quick.equilibria(starts=20).found
    assert rest.stability == Stability.STABLE
    assert np.isnan(rest.linearization.output_row("output")).any()
    with failing(ErrorKind.NO_DERIVATIVES):
        quick.linearize()
