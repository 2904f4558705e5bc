"""Formulas say what they stand for, and say it in the notation of the paper."""

import math
import random
from functools import cache
from pathlib import Path

import pytest
from reading import letter, sides
from refusing import failing
from sympy import Abs, Float, Function, Indexed, IndexedBase, Rational, Symbol, cos, exp, lambdify, sin, sqrt, symbols

from holonom.expression.presentation import presented
from holonom.failures import ErrorKind
from holonom.record import Record, Relation, derived_record
from holonom.typeset.formula import formula_box
from holonom.typeset.latex import latex, latex_relation, latex_tree
from holonom.typeset.quantities import spelled_apart

EXAMPLES = Path(__file__).parents[2] / "examples"
x, y, q1, u, t, m = symbols("x y q1 u t m", real=True)
dx = Symbol("dot(x)", real=True)


@cache
def record(example: str) -> Record:
    return derived_record(EXAMPLES / example)


def relations(found: Record) -> list[Relation]:
    """Of the last derivation and of the last scene: in an example these have the most in them."""
    equations = [equation for part in (found.derivations[-1], found.scenes[-1]) for equation in part.equations]
    return [relation for equation in equations for relation in equation.relations]


def readable(relation: Relation) -> Relation:
    """The relation, with a letter in place of a symbol such as [k,m;s]."""
    return Relation("z", relation.right_tree) if relation.left.has(Indexed) else relation


@cache
def at_a_point(example: str) -> tuple[dict[str, float], list[tuple[Relation, list[float]]]]:
    """A number for each letter as it looks, and every relation with the values of its sides."""
    shown = list(map(readable, relations(record(example))))
    names = sorted(set().union(*(side.free_symbols for r in shown for side in (r.left, r.right))), key=str)
    chance = random.Random(7)
    point = [chance.uniform(0.3, 1.7) for _ in names]
    looks = [letter(latex(name)) for name in names]
    assert len(set(looks)) == len(names), "no two quantities look the same"
    expected = lambdify(names, [[r.left, r.right] for r in shown], modules="math")(*point)
    return dict(zip(looks, point, strict=True)), list(zip(shown, expected, strict=True))


@pytest.mark.parametrize(
    ("example", "width"),
    [
        *[(example, width) for example in ("paper/paper.mac", "bead.mac") for width in (math.inf, 70, 33)],
        pytest.param("spherical_pendulum.mac", 70, marks=pytest.mark.long),
    ],
)
def test_a_formula_read_letter_by_letter_and_row_by_row_has_the_value_of_the_equation(example, width):
    values, expected = at_a_point(example)
    for relation, value in expected:
        assert sides(latex_relation(relation, width), values) == pytest.approx(value, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(
    ("name", "written"),
    [
        ("q1", "q_{1}"),
        ("dot(q1)", r"\dot{q}_{1}"),
        ("ddot(q1)", r"\ddot{q}_{1}"),
        ("q1_0", "q_{1 , 0}"),
        ("dot(q1)_0", r"\dot{q}_{1 , 0}"),
        ("dddot(u)", r"\dddot{u}"),
        ("lambda1", r"\lambda_{1}"),
        ("Lambda1", r"\Lambda_{1}"),
        ("Alpha", r"\mathrm{A}"),
        ("%omega_e", r"\omega_{e}"),
        ("θ2", r"\theta_{2}"),
        ("Ω", r"\Omega"),
        ("x_rod", r"x_{\text{rod}}"),
        ("mass", r"\text{mass}"),
        ("_", r"\text{\_}"),
        ("é", r"\text{é}"),
    ],
)
def test_names_are_letters_with_dots_and_indices(name, written):
    assert latex(Symbol(name, real=True)) == written


@pytest.mark.parametrize(
    ("expression", "written"),
    [
        (-x, "- x"),
        (y - x, "y - x"),
        (-x - y, "- x - y"),
        (u * (-x - y), "- u (x + y)"),
        (1 + 2 * u**2, "1 + 2 u^{2}"),
        (2 * u * x + 2 * u * y, "2 u x + 2 u y"),
        (u * (2 * x + 2 * y), "2 u (x + y)"),
        (Rational(-2, 3), r"- \frac{2}{3}"),
        (x / 2, r"\frac{x}{2}"),
        (m * dx**2 / 2, r"\frac{m \dot{x}^{2}}{2}"),
        (x / y, r"\frac{x}{y}"),
        (1 / sqrt(x), r"\frac{1}{\sqrt{x}}"),
        ((x + y) / u, r"\frac{x + y}{u}"),
        (t**2 * (x + y) / 2, r"\frac{t^{2}}{2} \, (x + y)"),
        (q1 + dx * t - t**3, r"q_{1} + \dot{x} t - t^{3}"),
        (q1 - x * (t - 1) ** 3 + y * (t - 1) ** 2, "q_{1} + y (t - 1)^{2} - x (t - 1)^{3}"),
        (u * exp(t), "u e^{t}"),
        (exp(-t / 2), r"e^{- \frac{t}{2}}"),
        (sin(x) ** 2 * y, r"y \sin^{2} x"),
        (cos(2 * x), r"\cos (2 x)"),
        (sin(x) * cos(y), r"\sin x \, \cos y"),
        ((x + y) ** 2, "(x + y)^{2}"),
        (u * (x * (y + 1) - 1), r"u \bigl( x (1 + y) - 1 \bigr)"),
        ((x / y) ** u, r"\left( \frac{x}{y} \right)^{u}"),
        (Indexed(IndexedBase("A"), 1, 2), "A_{1 2}"),
        (Indexed(IndexedBase("A_inverse"), 1, 2), "A^{1 2}"),
        (Indexed(IndexedBase("christoffel"), 1, 2, 3), "[1 , 2 ; 3]"),
        (Float("1.25e-7"), r"1.25 \cdot 10^{-7}"),
        (Float(-0.5) * x, "- 0.5 x"),
        (2**x * 3**y, r"2^{x} \cdot 3^{y}"),
        (Abs(x), r"\lvert x\rvert"),
        (y * Abs(sin(x + 1)), r"y \bigl| \sin (1 + x) \bigr|"),
    ],
)
def test_expressions_look_as_on_paper(expression, written):
    assert latex(expression) == written


@pytest.mark.parametrize(
    ("names", "spelled"),
    [
        (["x", "x0", "x_0"], {"x0"}),
        (["x", "x_0"], set()),
        (["a1", "a_1", "a1_0", "a_1_0"], {"a1", "a_1", "a1_0", "a_1_0"}),
        (["e", "pi", "m"], {"e", "pi"}),
        (["th", "theta", "dot(th)"], {"th", "theta", "dot(th)"}),
        (["_", "__"], {"_", "__"}),
    ],
)
def test_names_that_look_alike_are_spelled_out(names, spelled):
    alone = {name: latex(Symbol(name, real=True)) for name in names}
    with spelled_apart(names):
        apart = {name: latex(Symbol(name, real=True)) for name in names}
    assert {name for name in names if apart[name] != alone[name]} == spelled
    assert len(set(apart.values())) == len(names)
    assert {name: latex(Symbol(name, real=True)) for name in names} == alone


def test_arrays_are_no_names_of_quantities():
    """A parameter called christoffel ended in an internal error, and A_inverse looked as A."""
    assert len({latex(Symbol(name, real=True)) for name in ("A", "A_inverse", "christoffel", "delta")}) == 4


def test_what_no_record_holds_is_refused():
    with failing(ErrorKind.NOT_AN_EXPRESSION, "h"):
        latex(Function("h")(x))
    with failing(ErrorKind.NOT_AN_EXPRESSION, "Gradient"):
        latex_tree(["Gradient", "x"])


@pytest.mark.parametrize("width", [70, 40])
def test_sums_are_broken_before_signs_within_the_width(width):
    long = sum(Symbol(f"x{i}", real=True) * Symbol(f"y{j}", real=True) for i in range(1, 6) for j in range(1, 6))
    rows = latex(long, width).splitlines()[1:-1]
    assert len(rows) > 2
    assert all(row.startswith("& +") for row in rows[1:])
    assert formula_box(presented(long), width).width <= width


@pytest.mark.parametrize(
    ("tree", "written"),
    [
        (["Subscript", "A", "s", "k"], "A_{s k}"),
        (["Subscript", "A_inverse", "l", "s"], "A^{l s}"),
        (["Subscript", "christoffel", "k", "m", "s"], "[k , m ; s]"),
        (["Subscript", "delta", "l", "k"], r"\delta^{l}_{k}"),
        (["Subscript", "q_0", "s"], "q_{s , 0}"),
        (["Dot", ["Subscript", "q_0", "s"]], r"\dot{q}_{s , 0}"),
        (["Partial", ["Subscript", "f", "beta"], "t", "t"], r"\frac{\partial^{2} f_{\beta}}{\partial t^{2}}"),
        (
            ["Partial", ["Subscript", "f", "beta"], ["Subscript", "q", "s"], ["Subscript", "u", "rho"]],
            r"\frac{\partial^{2} f_{\beta}}{\partial q_{s} \partial u_{\rho}}",
        ),
        (
            ["Rate", ["Partial", "T", ["Dot", ["Subscript", "q", "s"]]]],
            r"\frac{d}{d t} \frac{\partial T}{\partial \dot{q}_{s}}",
        ),
        (["Divide", 1, ["Factorial", 3]], r"\frac{1}{3 !}"),
        (
            ["NotEqual", ["Determinant", ["Subscript", "A", "s", "k"]], 0],
            r"\det (A_{s k}) \neq 0",
        ),
        (["List", ["Equal", "t", 0], ["Equal", "f", 0]], r"t = 0 , \quad f = 0"),
        (["Add", "b", ["Negate", "a"]], "b - a"),
    ],
)
def test_general_equations_are_written_as_the_paper_writes_them(tree, written):
    assert latex_tree(tree) == written
