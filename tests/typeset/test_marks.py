"""The marks on the paper's misprints are where the pen slipped, and nowhere else."""

import pytest

from holonom.expression.mathjson import Tree
from holonom.typeset.latex import latex_marked, latex_tree, marked

F_BETA, Q_S, U_RHO = ["Subscript", "f", "beta"], ["Subscript", "q", "s"], ["Subscript", "u", "rho"]


def marks(tree: Tree) -> list[Tree]:
    if not isinstance(tree, list):
        return []
    return [tree[2]] if tree[0] == "Marked" else [mark for part in tree[1:] for mark in marks(part)]


def twice_by_controls(index: str) -> list[Tree]:
    """The second derivative by u_rho and another control, and that control's time derivative."""
    other = ["Subscript", "u", index]
    return [["Partial", F_BETA, U_RHO, other], ["Dot", other]]


def test_the_misprints_of_the_paper_are_marked_where_they_stand(printed_equations):
    misprints = [e for e in printed_equations if not e.agrees]
    slips = [
        (marks(marked(e.printed_tree, e.corrected_tree, "red")), marks(marked(e.corrected_tree, e.printed_tree, "red")))
        for e in misprints
    ]
    alpha, sigma = twice_by_controls("alpha"), twice_by_controls("sigma")
    mixed_term = ["Multiply", ["Partial", F_BETA, Q_S, U_RHO], ["Dot", Q_S], ["Dot", U_RHO]]
    acceleration = ([["Ddot", "u"]], [["Dot", "u"]])
    factor = ([mixed_term, *alpha, ["Dot", U_RHO]], [2, *sigma, ["Ddot", U_RHO]])
    assert slips == [
        ([*alpha, ["Dot", Q_S], ["Dot", U_RHO]], [*sigma, ["Ddot", Q_S], ["Ddot", U_RHO]]),  # (7)
        factor,  # (8)
        factor,  # (10)
        (["u"], [2]),  # equation of motion of q2
        acceleration,  # multiplier
        acceleration,  # (16), three times
        acceleration,
        acceleration,
        (["u0"], [1]),  # (17), the third
    ]


def test_nothing_is_marked_where_nothing_differs():
    tree = ["Equal", "a", ["Add", "b", ["Negate", "c"]]]
    assert marked(tree, tree, "red") == tree


@pytest.mark.parametrize(
    ("tree", "other", "written"),
    [
        (["Add", "a", "b"], ["Add", "a", "c"], r"a + \textcolor{misprint}{b}"),
        (["Add", "a", "b", "c"], ["Add", "a", "c"], r"a + \textcolor{misprint}{b} + c"),
        (["Add", "a", "c"], ["Add", "a", "b", "c"], r"\textcolor{misprint}{a} + \textcolor{misprint}{c}"),
        (["Multiply", "a", "b"], ["Multiply", 2, "a", "b"], r"\textcolor{misprint}{a b}"),
        (["Add", "a", ["Negate", "b"]], ["Add", "a", "b"], r"a \textcolor{misprint}{-} \textcolor{misprint}{b}"),
        (["Power", "a", 2], ["Power", "a", 3], r"a^{\textcolor{misprint}{2}}"),
        (["Dot", "a"], ["Ddot", "a"], r"\textcolor{misprint}{\dot{a}}"),
    ],
)
def test_the_smallest_part_that_differs_is_marked(tree, other, written):
    assert latex_marked(tree, other) == written
    assert latex_tree(marked(tree, other, "misprint")) == written
