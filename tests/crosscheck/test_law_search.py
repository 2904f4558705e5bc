"""Random search for laws that make every motion free: it finds those that exist, and none where none exists."""

import pytest
import sympy as sp

from holonom.crosscheck.law_search import find_free_law
from holonom.crosscheck.system import MechanicalSystem, dotted

t, u, w, p, x, y = sp.symbols("t u w p x y", real=True, seq=True)
rate = dotted("dot", u)


def guided(force, constraints=(x,), controls=(u,)) -> MechanicalSystem:
    """A unit mass in a plane; the given force acts along x."""
    energy = (dotted("dot", x) ** 2 + dotted("dot", y) ** 2) / 2
    force = force if isinstance(force, tuple) else (force, sp.Integer(0))
    multipliers = sp.symbols(f"lambda1:{len(constraints) + 1}", real=True)
    return MechanicalSystem(t, (x, y), controls, multipliers, energy, sp.Integer(0), force, tuple(constraints))


@pytest.mark.parametrize(
    ("system", "span", "law"),
    [
        (guided(((1 - t) * u**2 - 1) * y), (0.0, 0.5), lambda t, u: (1 - t) * u**2 - 1),
        (guided((u**3 + u - t) * y), None, lambda t, u: u**3 + u - t),
        (guided(y * (sp.exp(u) - t - 3)), None, lambda t, u: sp.exp(u) - t - 3),
    ],
    ids=["of a square", "of a cubic", "of an exponential"],
)
def test_search_finds_the_value_of_a_law(system, span, law):
    found = find_free_law(system, {}, span, "seed")
    assert abs(law(found.time, found.controls["u"])) < 1e-4


def test_search_states_the_times_it_tried_and_what_is_left_there():
    """No law makes t^45 x vanish, but no number shows it in the first quarter."""
    found = find_free_law(guided(t**45 * y), {}, (0.0, 0.25), "seed")
    assert 0 < found.time - found.reach < found.time + found.reach < 0.25
    assert found.largest < 1e-9


@pytest.mark.parametrize(
    ("force", "holds"),
    [
        ((1 + p * u**2) * y, lambda p, u: abs(1 + p * u**2) < 1e-4),
        (sp.Max(p, 0) * y + u * y**2, lambda p, u: p < 0 and abs(u) < 1e-4),
    ],
)
def test_search_draws_parameters_of_both_signs(force, holds):
    found = find_free_law(guided(force), {}, None, "seed")
    assert holds(found.parameters["p"], found.controls["u"])


@pytest.mark.parametrize(
    "system",
    [
        guided((1 - t**2) * rate * y + t * u * y),
        guided((sp.Integer(0), -y), (y - u,)),
        guided((u - t) * y + (u * w**2 + 1) * y**2, controls=(u, w)),
    ],
    ids=["of first order", "of second order", "two controls"],
)
def test_search_finds_solutions_of_differential_equations(system):
    assert find_free_law(system, {}, (-0.9, -0.1), "seed") is not None


@pytest.mark.parametrize(
    "system",
    [
        guided((1 + t * u**2) * y),
        guided((u - t) * y + rate * y**2),
        guided((rate - u) * y + (u - t**2) * y**2),
        guided(y + u),
        guided((sp.Integer(0), sp.Integer(0)), (x**2 + y**2 - 1 - u**2,)),
        guided((sp.Integer(0), -x), (y - u * x**2,)),
    ],
    ids=["imaginary", "contradictory rate", "two equations", "no control there", "circle", "parabola"],
)
def test_search_finds_no_law_where_there_is_none(system):
    assert find_free_law(system, {}, (1.0, 2.0), "seed") is None


@pytest.mark.parametrize(
    ("force", "span"),
    [
        ((rate - 1 - u**2) * y + (u - t) * y**2, (0.0, 1.0)),
        ((rate - sp.cos(t) + t**2 / 1000) * y + (u - sp.sin(t)) * y**2, (0.0, 1.0)),
    ],
    ids=["rates differ by t^2", "rates differ by t^2/1000"],
)
@pytest.mark.parametrize("seed", range(6))
def test_search_takes_no_near_solution_for_a_law(force, span, seed):
    assert find_free_law(guided(force), {}, span, f"seed {seed}") is None
