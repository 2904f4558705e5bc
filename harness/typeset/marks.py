"""What an equation has that another has not: marks on the smallest parts that differ."""

from ..mathjson import Tree

IN_ANY_ORDER = {"Add", "Multiply"}
QUANTITIES = {"Subscript", "Dot", "Ddot", "Dddot", "Partial"}  # marked whole


def marked(tree: Tree, other: Tree, colour: str) -> Tree:
    """Mark the parts of a tree that are not in the other one.

    Parameters
    ----------
    tree, other : int, str, dict or list
        Two formulas of much the same form.
    colour : str
        What the marks say.

    Returns
    -------
    int, str, dict or list
        `tree` with ["Marked", colour, part] in place of each part that differs.
    """
    if tree == other:
        return tree
    if not _same_form(tree, other):
        return ["Marked", colour, tree]
    head, *parts = tree
    partners = _partners(head, parts, other[1:])
    return ["Marked", colour, tree] if partners is None else [head, *_marked_parts(parts, partners, colour)]


def _same_form(tree: Tree, other: Tree) -> bool:
    if not (isinstance(tree, list) and isinstance(other, list)) or tree[0] != other[0] or tree[0] in QUANTITIES:
        return False
    return len(tree) == len(other) or tree[0] in IN_ANY_ORDER


def _partners(head: str, parts: list[Tree], others: list[Tree]) -> list[Tree | None] | None:
    """For each part the one to compare it with, if there is one; None for all where a part is missing."""
    if head not in IN_ANY_ORDER:
        return list(others)
    lone, spare = _without(parts, others), _without(others, parts)
    if len(lone) < len(spare):
        return None
    left = iter(spare if len(lone) == len(spare) else [])
    return [part if part in others else next(left, None) for part in parts]


def _without(parts: list[Tree], others: list[Tree]) -> list[Tree]:
    return [part for part in parts if part not in others]


def _marked_parts(parts: list[Tree], partners: list[Tree | None], colour: str) -> list[Tree]:
    return [
        ["Marked", colour, part] if partner is None else marked(part, partner, colour)
        for part, partner in zip(parts, partners, strict=True)
    ]
