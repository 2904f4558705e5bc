"""MathML is well-formed, and in the part of it that browsers show without help."""

import re
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import pytest

from holonom.expression.functions import FUNCTIONS
from holonom.typeset.latex import CORRECTION, latex_marked, latex_tree
from holonom.typeset.mathml import inline_mathml, mathml

# https://w3c.github.io/mathml-core: elements and attributes that a browser acts upon
CORE = {
    *("math", "mfrac", "mi", "mn", "mo", "mover", "mrow", "mspace", "msqrt", "mstyle", "msub", "msubsup", "msup"),
    *("mtable", "mtd", "mtext", "mtr", "mpadded", "munder"),
}
CORE_ATTRIBUTES = {
    *("alttext", "class", "display", "displaystyle", "form", "lspace", "mathvariant", "maxsize", "minsize"),
    *("movablelimits", "rspace", "stretchy", "style", "width"),
}
NAMESPACE = "{http://www.w3.org/1998/Math/MathML}"


def elements(formula: str, kind: str) -> list[Element]:
    return ElementTree.fromstring(formula).findall(f".//{NAMESPACE}{kind}")


@pytest.mark.parametrize("width", [33, 70])
def test_every_equation_of_the_paper_is_in_the_core_language(printed_equations, width):
    for equation in printed_equations:
        root = ElementTree.fromstring(mathml(latex_tree(equation.printed_tree, width)))
        assert {element.tag for element in root.iter()} <= {NAMESPACE + kind for kind in CORE}
        assert {name for element in root.iter() for name in element.attrib} <= CORE_ATTRIBUTES


def test_a_display_and_a_formula_in_a_line_say_what_they_are():
    assert mathml("x").startswith('<math xmlns="http://www.w3.org/1998/Math/MathML" display="block"')
    assert 'display="inline"' in inline_mathml("x")


def test_a_formula_has_words_for_those_who_cannot_see_it():
    assert ElementTree.fromstring(mathml("x", 'x is "less" than 1 & > 0')).get("alttext") == 'x is "less" than 1 & > 0'
    assert ElementTree.fromstring(mathml("x\n+ y")).get("alttext") == "x + y"


def test_broken_formulas_are_tables_row_by_row():
    formula = mathml(latex_tree(["Equal", "a", ["Add", *(f"x{place}" for place in range(40))]], 30))
    rows = elements(formula, "mtr")
    assert len(rows) > 3
    assert len({len(row) for row in rows}) == 1
    assert "".join(ElementTree.fromstring(formula).itertext()).count("x") == 40


def test_marks_are_classes():
    formula = mathml(latex_marked(["Add", "a", "b"], ["Add", "a", "c"], CORRECTION))
    [mark] = elements(formula, "mstyle")
    assert mark.get("class") == "correction"
    assert mark.get("mathcolor") is None


def test_a_sign_behind_an_equals_sign_is_that_of_its_term():
    signs = [sign.get("form") for sign in elements(mathml("a = - b - (- c)"), "mo") if sign.text == "−"]
    assert signs == ["prefix", None, "prefix"]


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda function: function.head)
def test_every_function_has_a_name(function):
    """Of atan2 it was empty, which ended in an internal error."""
    formula = mathml(latex_tree([function.head, *["x", "y"][: function.arity]]))
    assert all(element.text for kind in ("mo", "mi") for element in elements(formula, kind))
    assert not re.search("vert", "".join(ElementTree.fromstring(formula).itertext()))


def test_bars_around_brackets_are_bars():
    formula = mathml(latex_tree(["Abs", ["Sin", ["Add", "x", 1]]]))
    assert [sign.text for sign in elements(formula, "mo")].count("|") == 2


def test_what_is_not_well_formed_is_refused():
    with pytest.raises(ElementTree.ParseError):
        mathml("a & b")


@pytest.mark.parametrize(
    ("latex", "spaces"),
    [(r"\sin\varphi", 1), (r"\sin^2\dot{x}", 1), (r"\operatorname{arsinh}\frac{x}{2}", 1), (r"\ln 2", 1),
     (r"\frac{\sin x}{2} y", 1), (r"\sqrt{\sin x} y", 1),
     (r"\sin(x)", 0), (r"\ln|x|", 0), (r"\mathrm{residual}_1 x", 0), (r"\psi_0 x", 0)],
)  # fmt: skip
def test_the_name_of_a_function_has_a_space_before_an_argument_without_brackets(latex, spaces):
    assert len(elements(mathml(latex), "mspace")) == spaces
