"""MathJSON and SymPy: the same expression there and back, and nothing but expressions."""

import json

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st
from sympy import Float, I, Integer, Rational, Symbol, pi

from holonom.expression.mathjson import CLASSES, from_sympy, to_sympy
from holonom.failures import HolonomError

x, q1_rate = Symbol("x", real=True), Symbol("dot(q1)", real=True)

numbers = st.one_of(
    st.integers().map(Integer),
    st.integers(min_value=2**53, max_value=2**200).map(Integer),
    st.fractions().map(lambda value: Rational(value.numerator, value.denominator)),
)
symbols = st.sampled_from(["x", "q1", "dot(q1)", "ddot(u)", "q1_0", "dot(q1)_0", "%omega", "Q_1", "lambda1"])
OF_ONE = [function for each, function in CLASSES.items() if each.arity == 1 and each.head != "Sqrt"]
functions = [function for function in OF_ONE if function is not sympy.gamma]  # of numbers: factorials
leaves = st.one_of(
    numbers,
    symbols.map(lambda name: Symbol(name, real=True)),
    st.sampled_from([pi, sympy.E, I, sympy.sqrt(5) / 2]),
)


def combined(parts: st.SearchStrategy) -> st.SearchStrategy:
    """Of readable parts: SymPy's atan2 raises an error for infinities and for complex numbers."""
    parts = parts.filter(is_readable)
    reals = parts.filter(lambda part: part.is_extended_real is not False)
    several = st.lists(parts, min_size=2, max_size=4)
    return st.one_of(
        several.map(lambda terms: sympy.Add(*terms)),
        several.map(lambda factors: sympy.Mul(*factors)),
        st.tuples(parts, st.integers(-3, 3).map(Integer)).map(lambda power: sympy.Pow(*power)),
        st.tuples(reals, reals).map(lambda sides: sympy.atan2(*sides)),
        st.tuples(st.sampled_from(functions), parts).map(lambda call: call[0](call[1])),
    )


def is_readable(expression: sympy.Expr) -> bool:
    """Without the infinities and the functions of complex numbers that SymPy's own simplification may bring in."""
    known = {*OF_ONE, sympy.atan2, sympy.Add, sympy.Mul, sympy.Pow}
    return all(part.func in known if part.args else part.is_finite for part in sympy.preorder_traversal(expression))


@given(st.recursive(leaves, combined, max_leaves=12).filter(is_readable))
def test_there_and_back(expression):
    tree = json.loads(json.dumps(from_sympy(expression)))
    assert sympy.expand(to_sympy(tree) - expression) == 0


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_doubles_are_exact(value):
    assert float(to_sympy(from_sympy(Float(value)))) == value


@given(st.integers(18, 60), st.integers(1, 10**9))
def test_long_floats_keep_their_digits(digits, seed):
    value = sympy.sqrt(seed).evalf(digits)
    assert abs(to_sympy(from_sympy(value)) - value) <= abs(value) * Float(10) ** (1 - digits)


@pytest.mark.parametrize(
    ("tree", "expression"),
    [
        (["Divide", 1, 3], Rational(1, 3)),
        (["Rational", 1, {"num": "9007199254740993"}], Rational(1, 9007199254740993)),
        (["Subtract", "x", ["Negate", 2]], x + 2),
        (["Sqrt", ["Power", "dot(q1)", 2]], sympy.Abs(q1_rate)),
        (["Arctan2", 1, "x"], sympy.atan2(1, x)),
        (["Exp", 1], sympy.E),
        (["Gamma", "x"], sympy.gamma(x)),
        ({"num": "-12345678901234567e-16"}, Float(-1.2345678901234567)),
        (["Add", "x"], x),
    ],
)
def test_readings(tree, expression):
    assert to_sympy(tree) == expression


def test_indexed_quantities():
    entry = to_sympy(["Subscript", "A_inverse", 1, 2])
    assert entry.base.label.name == "A_inverse"
    assert entry.indices == (1, 2)
    assert from_sympy(entry) == ["Subscript", "A_inverse", 1, 2]


@pytest.mark.parametrize(
    "tree",
    [
        None,
        True,
        1.5,
        2**53,
        [],
        [1, 2],
        ["Add"],
        ["Sin", 1, 2],
        ["Power", "x"],
        ["__import__", "os"],
        ["Rational", 1, 0],
        ["Rational", "x", 2],
        ["Divide", 1, 0],
        ["Ln", 0],
        ["Subscript", "A"],
        ["Subscript", "A", "x"],
        {"num": "nan"},
        {"num": "1_000"},
        {"num": "0x10"},
        {"num": 5},
        {"num": "5", "unit": "m"},
        {"fn": ["Add", 1, 2]},
        "",
        "True",
        "x y",
        "dot(q1",
        "print(1)",
        "x.__class__",
        ["Add", 1, ["Multiply", 2, "'x'"]],
    ],
)
def test_anything_else_is_refused(tree):
    with pytest.raises(HolonomError):
        to_sympy(tree)


@pytest.mark.parametrize(
    "expression", [Symbol("x"), Symbol("Pi", real=True), sympy.Ci(x), sympy.oo, sympy.Derivative(sympy.sin(x), x)]
)
def test_what_a_record_cannot_hold_is_refused(expression):
    with pytest.raises(HolonomError):
        from_sympy(expression)


def test_depth_is_no_obstruction():
    tree = "x"
    for _ in range(20_000):
        tree = ["Negate", tree]
    assert to_sympy(tree) == x
