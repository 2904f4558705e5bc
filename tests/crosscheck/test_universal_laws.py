"""The second look at a law that is said to make every motion free: right laws pass it, wrong ones do not."""

import pytest
import sympy as sp

from holonom.crosscheck.report import Verdict
from holonom.crosscheck.system import MechanicalSystem, dotted
from holonom.crosscheck.universal_laws import ControlLaw, _within, verify_law


def real(names: str) -> tuple[sp.Symbol, ...]:
    return sp.symbols(names, real=True, seq=True)


(t,) = real("t")
(u, w, u0, u1, k, m) = real("u w u0 u1 k m")


def system(names: str, force, constraints, controls=(u,), mass=1) -> MechanicalSystem:
    q = real(names)
    multipliers = real(" ".join(f"lambda{beta}" for beta, _ in enumerate(constraints, start=1)))
    energy = sp.Add(*(mass * dotted("dot", x) ** 2 for x in q)) / 2
    return MechanicalSystem(t, q, tuple(controls), multipliers, energy, sp.Integer(0), tuple(force), tuple(constraints))


(q1, q2, q3), (x, y, z) = real("q1 q2 q3"), real("x y z")
CENTRIPETAL = -(dotted("dot", x) ** 2 + dotted("dot", y) ** 2) / (x**2 + y**2)
PAPER = system(
    "q1 q2 q3", (-q1 - q2, -2 * (dotted("dot", q1) + dotted("dot", q2)), sp.Integer(0)), [q3 - u * (q1 + q2)]
)
CIRCLE = system("x y", (CENTRIPETAL * x, CENTRIPETAL * y), [x**2 + y**2 - u**2])
SPRING = system("x", (-k * x,), [x - u], mass=m)
PUSHED = system("x", (dotted("dot", x),), [x - u])
LARGE = system("x y z", (CENTRIPETAL * x, CENTRIPETAL * y, 10**40 * (x**2 + y**2 - 1)), [x**2 + y**2 - 1, z - u])
SUM = system("x", (sp.Integer(-10),), [x - u - w], controls=(u, w))


@pytest.mark.parametrize(
    ("moved", "law", "positive"),
    [
        (PAPER, {u: u0 * sp.exp(t)}, ()),
        (CIRCLE, {u: sp.sqrt(2 * u0 + 2 * u1 * t)}, ()),
        (SPRING, {u: u0 * sp.cos(sp.sqrt(k / m) * t)}, (k / m,)),
        (SUM, {u: -w + u0 - 5 * t**2}, ()),
        (PUSHED, {u: u0 * sp.exp(t)}, ()),
        (LARGE, {u: u0 + u1 * t}, ()),
    ],
    ids=[
        "the paper's law",
        "on a curved manifold",
        "for one sign of a parameter",
        "with a free control",
        "only where the velocity is that of the constraint",
        "where what is zero on the manifold has a large factor",
    ],
)
def test_law_that_makes_every_motion_free_passes(moved, law, positive):
    found = verify_law(moved, {}, ControlLaw(law, positive))
    assert (found.verdict, found.detail) == (Verdict.AGREES, "")


@pytest.mark.parametrize(
    ("moved", "law"),
    [
        (PAPER, {u: u0 * sp.exp(t) + sp.Rational(1, 10**20)}),
        (CIRCLE, {u: u0 + t}),
        (SPRING, {u: u0 * sp.cos(t)}),
        (SUM, {u: w + u0 - 5 * t**2}),
    ],
)
def test_law_that_leaves_a_reaction_is_caught(moved, law):
    assert verify_law(moved, {}, ControlLaw(law)).verdict is Verdict.DISAGREES


def test_a_law_under_which_no_state_is_regular_is_neither_right_nor_wrong():
    found = verify_law(CIRCLE, {}, ControlLaw({u: sp.Integer(0)}))
    assert found.verdict is Verdict.UNDECIDED
    assert "0" in found.detail.split()


def test_a_law_for_one_sign_of_a_parameter_is_tried_for_that_sign_alone():
    """cos(sqrt|k/m| t) is real for either sign, and a spring's motion for one.

    Of eight random states four are positive throughout; one in sixteen draws has k/m > 0 in the others too.
    """
    law = {u: u0 * sp.cos(sp.sqrt(sp.Abs(k / m)) * t)}
    assert verify_law(SPRING, {}, ControlLaw(law, (k / m,))).verdict is Verdict.AGREES
    drawn = (verify_law(SPRING, {}, ControlLaw(law)).verdict for _ in range(16))
    assert Verdict.DISAGREES in drawn


def test_times_are_drawn_within_the_span():
    t, x = sp.symbols("t x", real=True)
    drawn = [_within((sp.Integer(10), sp.Rational(21, 2)), {t: sp.Rational(k, 7), x: k}, t) for k in range(-14, 15)]
    assert [point[t] for point in drawn] == [10 + sp.Rational(k + 14, 56) for k in range(-14, 15)]
    assert [point[x] for point in drawn] == [*range(-14, 15)]


ROOT = system("x z", (-dotted("dot", x), sp.Integer(0)), [z - sp.sqrt(u - t**2) * x])


@pytest.mark.parametrize(
    ("offset", "verdict"), [(0, Verdict.AGREES), (1, Verdict.DISAGREES)], ids=["at the end", "inside"]
)
def test_law_at_the_end_of_a_domain_is_put_in_before_derivatives(offset, verdict):
    assert verify_law(ROOT, {}, ControlLaw({u: t**2 + offset})).verdict is verdict
