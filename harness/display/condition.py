"""Show the condition of free motion (10), with names for its roots if it is long.

A short condition is one formula. A long one is a list of its terms.
"""

import re
from collections.abc import Callable, Iterator
from functools import partial

from ..expression.notation import scene_text
from ..expression.trees import Tree, converted

LARGEST_CONDITION = 60
"""Names, numbers and operations of a condition that is printed as one formula; Maxima has its largest_condition."""

Roots = dict[tuple[str, int], tuple[str, Tree]]
"""By radicand, as text, and degree: the name of the root, and the root."""


def condition_lines(left: Tree) -> list[str]:
    """Write left = 0 in lines.

    Parameters
    ----------
    left : Tree
        Left side of the condition, as MathJSON.

    Returns
    -------
    list of str
        One formula, or the roots' names and one line for each term.
    """
    if sum(1 for _ in _nodes(left)) <= LARGEST_CONDITION:
        return [f"{scene_text(left)} = 0"]
    roots: Roots = {}
    named = converted(left, partial(_with_named_roots, roots, _prefix(left)))
    terms = named[1:] if isinstance(named, list) and named[0] == "Add" else [named]
    written = [scene_text(term) for term in terms]
    return [
        *(f"with {name} = {scene_text(root)}" for name, root in roots.values()),
        *(["0 = the sum of", *(f"    {term}" for term in written)] if len(written) > 1 else [f"{written[0]} = 0"]),
    ]


def _nodes(tree: Tree) -> Iterator[Tree]:
    waiting = [tree]
    while waiting:
        node = waiting.pop()
        yield node
        if isinstance(node, list):
            waiting += node[1:]


def _prefix(tree: Tree) -> str:
    """Return a prefix of names that no symbol of the tree has."""
    prefix, taken = "r", {node for node in _nodes(tree) if isinstance(node, str)}
    while any(re.fullmatch(rf"{prefix}\d+", name) for name in taken):
        prefix += "r"
    return prefix


def _with_named_roots(roots: Roots, prefix: str, tree: Tree) -> tuple[Callable[..., Tree], list[Tree]]:
    match tree:
        case ["Subscript" | "Rational", *_]:
            return (lambda: tree), []
        case [str(head), *arguments]:
            return partial(_rebuilt, roots, prefix, head), arguments
        case _:
            return (lambda: tree), []


def _rebuilt(roots: Roots, prefix: str, head: str, *arguments: Tree) -> Tree:
    match head, *arguments:
        case "Sqrt", base:
            return _named(roots, prefix, base, 2)
        case "Power", base, ["Rational", int(numerator), int(degree)]:
            root = _named(roots, prefix, base, degree)
            return root if numerator == 1 else ["Power", root, numerator]
        case _:
            return [head, *arguments]


def _named(roots: Roots, prefix: str, base: Tree, degree: int) -> Tree:
    """Replace roots by their names, except roots of numbers."""
    root = ["Sqrt", base] if degree == 2 else ["Power", base, ["Rational", 1, degree]]
    if isinstance(base, int | dict):
        return root
    return roots.setdefault((repr(base), degree), (f"{prefix}{len(roots) + 1}", root))[0]
