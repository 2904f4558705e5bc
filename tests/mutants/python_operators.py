"""Operators for Python: Cosmic Ray's, and ours for what those lack."""

from __future__ import annotations

import re
from collections.abc import Iterator

import parso
from cosmic_ray.operators.operator import Operator
from cosmic_ray.plugins import get_operator, operator_names

# Left out: operators that need a variable to be named, those that only change the type, and `is` for `==`.
WITHOUT = re.compile(
    r"(Variable\w+|RemoveDecorator|ExceptionReplacer|_Is_Eq|_Eq_Is|_IsNot_NotEq|_NotEq_IsNot|"
    r"(Add|Sub|Mul|Div|FloorDiv|Mod|Pow)_(RShift|LShift|Bit\w+))$"
)
EXCHANGED = {"any": "all", "all": "any", "min": "max", "max": "min", "floor": "ceil", "ceil": "floor"}
COMMUTATIVE = {"min", "max", "minimum", "maximum", "suppress"}
NEEDED = ("import_name", "import_from", "pass_stmt", "global_stmt", "nonlocal_stmt", "string")


class _Ours(Operator):
    """An operator that replaces the texts that `_changes` yields."""

    def mutation_positions(self, node):
        return ((node.start_pos, node.end_pos) for _ in self._changes(node))

    def mutate(self, node, index):
        return parso.parse(node.get_first_leaf().prefix + list(self._changes(node))[index])

    @classmethod
    def examples(cls):
        return ()


class Exchange(_Ours):
    """any and all, min and max, floor and ceil."""

    def _changes(self, node):
        if node.type == "name" and node.value in EXCHANGED:
            yield EXCHANGED[node.value]


class Arguments(_Ours):
    """Two neighbouring arguments of a call, exchanged."""

    def _changes(self, node):
        if node.type == "arglist" and node.get_previous_leaf().get_previous_leaf().value not in COMMUTATIVE:
            texts = [child.get_code().strip() for child in node.children[::2]]
            plain = [child.type != "argument" for child in node.children[::2]]
            for i in range(len(texts) - 1):
                if plain[i] and plain[i + 1] and texts[i] != texts[i + 1]:
                    yield ", ".join([*texts[:i], texts[i + 1], texts[i], *texts[i + 2 :]])


class Statement(_Ours):
    """A statement, left out."""

    def _changes(self, node):
        is_needed = node.type != "simple_stmt" or node.children[0].type in NEEDED
        if not is_needed and node.get_code().strip() != "return None":
            yield "pass\n"


class Condition(_Ours):
    """The condition of an if, always true or always false."""

    def _changes(self, node):
        parent = node.parent
        if parent is not None and parent.type in ("if_stmt", "while_stmt") and node is parent.children[1]:
            yield from ("True", "False") if parent.type == "if_stmt" else ("False",)


def operators() -> Iterator[tuple[str, Operator]]:
    """Yield each operator with its kind: the module of Cosmic Ray's, the class of ours."""
    for name in operator_names():
        if not WITHOUT.search(name):
            operator = get_operator(name)
            yield operator.__module__.rpartition(".")[2], operator()
    for operator in (Exchange, Arguments, Statement, Condition):
        yield operator.__name__, operator()
