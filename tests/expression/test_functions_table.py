"""The table of functions: a row is known in scenes, formulas, SymPy, at points and in programs."""

import re
import subprocess
import sys
from itertools import zip_longest

import pytest
import sympy
from mpmath import mp

from holonom.crosscheck.tape import coefficients
from holonom.expression.functions import FUNCTIONS
from holonom.expression.mathjson import CLASSES, from_sympy, to_sympy
from holonom.expression.notation import scene_text
from holonom.maxima import LIBRARY
from holonom.typeset.latex import latex_tree

ABOVE_ONE = ("Arcsec", "Arccsc", "Arcosh", "Arcoth")


def trees(function):
    """A call of a function with letters, and with numbers that it is real at."""
    numbers = ("1.7" if function.head in ABOVE_ONE else "0.4", "0.3")[: function.arity]
    given = (1, "0.4") if function.of_an_order else numbers
    return [function.head, *"xm"[: function.arity]], [
        function.head,
        *(each if isinstance(each, int) else {"num": each} for each in given),
    ]


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda each: each.head)
def test_a_row_is_known_in_every_notation(function):
    letters, numbers = trees(function)
    if function.head == "PolyGamma":
        assert scene_text([*letters[:1], 1, letters[2]]) == "psi[1](m)"
    else:
        assert scene_text(letters) == f"{function.scene}({', '.join(letters[1:])})"
    assert latex_tree(letters)
    assert from_sympy(to_sympy(letters)) == letters or function.head == "Sqrt"
    with mp.workdps(20):
        value = function.of(mp)(*(mp.mpf(str(each)) for each in numeric(numbers)))
        assert abs(value - mp.mpf(str(sympy.N(to_sympy(numbers), 20)))) < mp.mpf(10) ** -14


def numeric(tree):
    return (each["num"] if isinstance(each, dict) else each for each in tree[1:])


def numbers(given):
    return map(mp.mpmathify, given)


@pytest.mark.parametrize("function", [each for each in FUNCTIONS if each.slope], ids=lambda each: each.head)
def test_the_differential_equation_gives_the_taylor_coefficients(function):
    place = function.arguments.index("x")
    with mp.workdps(30):
        given = [mp.mpf(str(each)) for each in numeric(trees(function)[1])]
        found = coefficients(function.head, mp.prec, 4, *given)
        value = function.of(mp)
        expected = mp.taylor(lambda x: value(*given[:place], x, *given[place + 1 :]), given[place], 4)
        assert len(found) <= 5
        pairs = zip_longest(found, expected, fillvalue=mp.zero)
        assert all(abs(a - b) < mp.mpf(10) ** -12 * (1 + abs(b)) for a, b in pairs)


@pytest.mark.parametrize("function", [each for each in FUNCTIONS if each.head != "Zeta"], ids=lambda each: each.head)
def test_the_derivative_is_that_of_the_values(function):
    given = [sympy.Rational(each) for each in numeric(trees(function)[1])]
    place = 1 if function.of_an_order else 0
    before, after = given[:place], given[place + 1 :]
    x = sympy.Symbol("x", real=True)
    with mp.workdps(30):
        rate = CLASSES[function](*before, x, *after).diff(x).subs(x, given[place]).evalf(30)
        value = function.of(mp)
        quotient = mp.diff(lambda each: value(*numbers(before), each, *numbers(after)), given[place])
        assert abs(mp.mpmathify(rate) - quotient) < mp.mpf(10) ** -12


def test_what_maxima_writes_is_in_the_table_and_nothing_else():
    table = (LIBRARY / "record" / "mathjson.lisp").read_text(encoding="utf-8").partition("*mathjson-functions*")[2]
    heads = set(re.findall(r'\. "(\w+)"', table.partition("(defun")[0])) - {"Multiply", "Divide", "Negate"}
    assert heads == {each.head for each in FUNCTIONS} - {"Sqrt", "Exp", "PolyGamma"}  # which are written as such


SINC = """
from holonom.expression import functions
slope = ["Divide", ["Subtract", ["Cos", "x"], "y"], "x"]
functions.FUNCTIONS += (functions.Function("Sinc", "sinc", "sinc", slope=slope, **functions.PERIODIC),)
"""


def test_a_row_more_is_a_function_more():
    code = """
import sympy
from mpmath import mp
from holonom.crosscheck.evaluation import Steps
from holonom.crosscheck.tape import Tape
from holonom.crosscheck.taylor import Taylor
from holonom.crosscheck.verdict import Comparison, Pair, verify
from holonom.expression.mathjson import from_sympy, to_sympy
from holonom.expression.notation import scene_text
from holonom.typeset.latex import latex_tree

tree, x = ["Sinc", "x"], sympy.Symbol("x", real=True)
assert scene_text(tree) == "sinc(x)"
assert "sinc" in latex_tree(tree)
assert to_sympy(tree) == sympy.sinc(x) and from_sympy(sympy.sinc(x)) == tree
assert abs(Steps([to_sympy(tree)]).real_at({x: mp.mpf(2)})[0] - mp.sin(2) / 2) < 1e-14
tape = Tape()
place = tape.place(tree)
taylor, known = Taylor(3), {"x": (mp.mpf(2), mp.one)}
values = tape.values(taylor, known)
expected = mp.taylor(mp.sinc, 2, 4)
assert all(abs(a - b) < 1e-12 for a, b in zip(values[place], expected))
rate = tape.gradient(taylor, values, {place: (mp.one,)})["x"]
assert all(abs(a - k * b) < 1e-12 for k, (a, b) in enumerate(zip(rate, expected[1:]), 1))
assert verify(Comparison((Pair("sinc", to_sympy(tree), sympy.sin(x) / x),)), "seed").verdict.value == "agrees at points"
assert verify(Comparison((Pair("sinc", to_sympy(tree), sympy.sin(x)),)), "seed").verdict.value == "disagrees"
"""
    subprocess.run([sys.executable, "-c", SINC + code], check=True)
