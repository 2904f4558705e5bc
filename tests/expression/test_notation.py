"""Expressions as text: read again as what they are, and with no more signs and strokes than a reader wants."""

import json

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from holonom.expression.mathjson import to_sympy
from holonom.expression.notation import scene_text
from holonom.failures import HolonomError

SYMPYS_NAMES = {
    "abs": sympy.Abs,
    "signum": sympy.sign,
    **{name: getattr(sympy, name) for name in ("exp", "log", "sqrt", "sin", "asinh", "sech", "erf", "atan2")},
}
LETTERS = {name: sympy.Symbol(name, real=True) for name in ("x", "m", "q1_0", "lambda1")}

atoms = st.one_of(
    st.integers(-3, 3),
    st.just({"num": "12345678901234567890"}),
    st.tuples(st.integers(-5, 5), st.integers(1, 4)).map(lambda parts: ["Rational", *parts]),
    st.sampled_from(sorted(LETTERS)),
)


exponents = st.one_of(st.integers(-3, 3), st.sampled_from(sorted(LETTERS)))  # powers of numbers would grow without end


def combined(parts: st.SearchStrategy) -> st.SearchStrategy:
    several = st.lists(parts, min_size=1, max_size=4)
    return st.one_of(
        several.map(lambda terms: ["Add", *terms]),
        several.map(lambda factors: ["Multiply", *factors]),
        parts.map(lambda part: ["Negate", part]),
        st.tuples(st.sampled_from(["Subtract", "Divide"]), parts, parts).map(list),
        st.tuples(parts, exponents).map(lambda power: ["Power", *power]),
        st.tuples(parts, st.sampled_from([-1, 1, 3])).map(lambda power: ["Power", power[0], ["Rational", power[1], 2]]),
        st.tuples(st.sampled_from(["Sqrt", "Sin", "Abs"]), parts).map(list),
    )


@given(st.recursive(atoms, combined, max_leaves=9))
def test_text_is_read_as_the_expression(tree):
    """Truth: SymPy reads the text by its own rules, and the tree by `to_sympy`."""
    text = scene_text(tree)
    try:
        expected = to_sympy(tree)
    except HolonomError:  # it divides by zero
        return
    if expected.has(sympy.zoo, sympy.nan):  # as this does
        return
    read = sympy.sympify(text.replace("^", "**"), locals=LETTERS | SYMPYS_NAMES)
    point = dict(zip(LETTERS.values(), (1.25, 0.75, 1.5, 2.25), strict=True))
    there = sympy.N((read - expected).subs(point), 30)
    assert read == expected or abs(there) <= 1e-9 * max(1, abs(sympy.N(expected.subs(point))))


@pytest.mark.parametrize(
    ("tree", "text"),
    [
        (["Add", ["Multiply", -1, "a"], ["Multiply", ["Rational", -1, 2], "m", ["Power", "dot(x)", 2]], 3],
         "-a - m*dot(x)^2/2 + 3"),
        (["Multiply", ["Rational", 1, 2], ["Add", "a", "b"], ["Power", "c", -2], ["Power", "d", -1]],
         "(a + b)/(2*c^2*d)"),
        (["Power", "x", ["Rational", -1, 2]], "1/sqrt(x)"),
        (["Power", ["Multiply", -1, "x"], 2], "(-x)^2"),
        (["Subtract", "a", ["Add", "b", "c"]], "a - (b + c)"),
        (["Subscript", "christoffel", 1, 2, 3], "christoffel[1,2,3]"),
        (["Multiply", "Pi", ["Exp", ["Multiply", -1, "t"]]], "%pi*exp(-t)"),
        (["Arctan2", "y", ["Negate", "x"]], "atan2(y, -x)"),
        ({"num": "125e-2"}, "1.25"),
    ],
)  # fmt: skip
def test_a_formula_looks_as_it_would_be_written(tree, text):
    assert scene_text(tree) == text


@pytest.mark.parametrize(
    "tree",
    [None, True, 1.5, [], ["x"], ["eval", "x"], "a b", "__import__('os')", ["Rational", 1], ["Rational", "x", 2],
     ["Multiply"], ["Add"], ["Sin", 1, 2], ["Subscript", "A", "x"], {"num": "1", "more": 2}, {"num": "x"}],
)  # fmt: skip
def test_what_is_no_expression_is_refused(tree):
    with pytest.raises(HolonomError):
        scene_text(["Add", 1, tree])


def test_depth_is_no_obstruction():
    tree = "x"
    for _ in range(900):
        tree = ["Sin", tree]
    assert scene_text(json.loads(json.dumps(tree))).count("sin(") == 900


def test_orders_stand_where_maxima_has_them():
    assert (
        scene_text(["Multiply", ["PolyGamma", 1, "x"], ["BesselJ", ["Rational", 1, 3], "x"]])
        == "psi[1](x)*bessel_j(1/3, x)"
    )
