"""The table of functions: a row is known in scenes, formulas, SymPy, at points and in programs."""

import re

import pytest
import sympy
from mpmath import mp

from holonom.crosscheck import points
from holonom.functions import FUNCTIONS
from holonom.mathjson import CLASSES, from_sympy, to_sympy
from holonom.maxima import LIBRARY
from holonom.notation import scene_text
from holonom.program.motion_program import Operation
from holonom.typeset.latex import latex_tree

ARGUMENTS = {"BesselJ": (1, "0.4"), "BesselY": (1, "0.4"), "BesselI": (1, "0.4"), "BesselK": (1, "0.4")}
ABOVE_ONE = ("Arcsec", "Arccsc", "Arcosh", "Arcoth")


def trees(function):
    """A call of a function with letters, and with numbers that it is real at."""
    numbers = ("1.7" if function.head in ABOVE_ONE else "0.4", "0.3")[: function.arity]
    given = ARGUMENTS.get(function.head, numbers)
    return [function.head, *"xm"[: function.arity]], [
        function.head,
        *(each if isinstance(each, int) else {"num": each} for each in given),
    ]


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda each: each.head)
def test_a_row_is_known_in_every_notation(function):
    letters, numbers = trees(function)
    assert scene_text(letters) == f"{function.scene}({', '.join(letters[1:])})"
    assert latex_tree(letters)
    assert from_sympy(to_sympy(letters)) == letters or function.head == "Sqrt"
    with mp.workdps(20):
        value = points.FUNCTIONS.get(CLASSES[function], mp.sqrt)(*(mp.mpf(str(each)) for each in numeric(numbers)))
        assert abs(value - mp.mpf(str(sympy.N(to_sympy(numbers), 20)))) < mp.mpf(10) ** -14


def numeric(tree):
    return (each["num"] if isinstance(each, dict) else each for each in tree[1:])


def numbers(given):
    return map(mp.mpmathify, given)


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda each: each.head)
def test_the_derivative_is_that_of_the_values(function):
    given = [sympy.Rational(each) for each in numeric(trees(function)[1])]
    place = 1 if function.of_an_order else 0
    before, after = given[:place], given[place + 1 :]
    x = sympy.Symbol("x", real=True)
    with mp.workdps(30):
        rate = CLASSES[function](*before, x, *after).diff(x).subs(x, given[place]).evalf(30)
        value = points.FUNCTIONS.get(CLASSES[function], mp.sqrt)
        quotient = mp.diff(lambda each: value(*numbers(before), each, *numbers(after)), given[place])
        assert abs(mp.mpmathify(rate) - quotient) < mp.mpf(10) ** -12


def test_what_maxima_writes_is_in_the_table_and_nothing_else():
    table = (LIBRARY / "record" / "mathjson.lisp").read_text(encoding="utf-8").partition("*mathjson-functions*")[2]
    heads = set(re.findall(r'\. "(\w+)"', table.partition("(defun")[0])) - {"Multiply", "Divide", "Negate"}
    assert heads == {each.head for each in FUNCTIONS} - {"Sqrt", "Exp"}  # powers, which are written as such


def test_programs_call_what_has_a_name_there():
    named = {each.head for each in FUNCTIONS if each.program}
    assert named <= {each.value for each in Operation}
