"""The system as it is described: with the effects called for and no others, and with rates of everything that moves."""

import sympy as sp
from systems import symbols

from holonom.crosscheck.system import MechanicalSystem, described_system, dotted

X, Y, U, T, LAMBDA = symbols("x y u t lambda1")
VX = dotted("dot", X)


def test_effects_that_are_not_called_for_are_not_in_the_system(every_term_record):
    k, u, y = symbols("k u y")
    described = every_term_record.system
    whole = described_system(described, ["bare", "turning", "spring", "drag", "push"])
    part = described_system(described, ["bare", "push"])
    assert whole.potential_energy == k * X * Y
    assert part.potential_energy == 0
    assert whole.forces == (-y * VX, T * dotted("dot", u))
    assert part.forces == (0, T * dotted("dot", u))
    assert (
        sp.expand(whole.kinetic_energy - part.kinetic_energy)
        == T * u * VX + X * dotted("dot", u) * dotted("dot", y) + X * u
    )


def test_everything_that_moves_has_a_rate():
    """d/dt of t, q, dot(q), ddot(q), u and lambda, once each."""
    nothing = (sp.Integer(0),)
    system = MechanicalSystem(T, (X,), (U,), (LAMBDA,), sp.Integer(0), sp.Integer(0), nothing, (X - U,))
    moving = (T, X, VX, dotted("ddot", X), U, dotted("dot", U), dotted("ddot", U), LAMBDA)
    rates = (1, VX, dotted("ddot", X), dotted("dddot", X), dotted("dot", U), dotted("ddot", U), dotted("dddot", U))
    weights = symbols("a b c d e f g h")
    expected = sp.Add(*(w * rate for w, rate in zip(weights, (*rates, dotted("dot", LAMBDA)), strict=True)))
    assert (
        sp.expand(system.time_derivative(sp.Add(*(w * x for w, x in zip(weights, moving, strict=True)))) - expected)
        == 0
    )
