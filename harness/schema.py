"""JSON Schemas of documents, made from the types of their content."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from inspect import getdoc
from itertools import takewhile
from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from .structs import Entry, entries_of

DRAFT = "https://json-schema.org/draft/2020-12/schema"
SIMPLE = {str: "string", bool: "boolean", int: "integer", float: "number", dict: "object", list: "array"}
SIMPLE |= {NoneType: "null", tuple: "array"}
NUMBER = {"type": "string", "pattern": "^-?[0-9.]+(e[-+]?[0-9]+)?(/[0-9]+)?$"}  # as text, p/q among them


@dataclass(frozen=True, eq=False)
class Rules:
    """JSON Schema beyond a type, for ``Annotated[type, Rules({...})]``."""

    stated: Mapping[str, Any]


def lists_of(part: Mapping[str, Any]) -> dict[str, Any]:
    """Return the schema of lists.

    Parameters
    ----------
    part : mapping
        Schema of an item.

    Returns
    -------
    dict
    """
    return {"type": "array", "items": part}


VECTOR = lists_of({"type": "number"})
MATRIX = lists_of(VECTOR)
PAIRS = lists_of(VECTOR | {"minItems": 2, "maxItems": 2})  # complex numbers
Names = Annotated[tuple[str, ...], Rules({"uniqueItems": True})]
NumberText = Annotated[str, Rules(NUMBER)]
FloatText = Annotated[float, Rules(NUMBER)]


def schema_of(kind: type, name: str, version: int) -> dict[str, Any]:
    """Return the schema of a document.

    Parameters
    ----------
    kind : type
        Type of its content.
    name : str
        Name of the format without ``holonom-``.
    version : int
        Version of the format.

    Returns
    -------
    dict
        JSON Schema. Objects inside are among its definitions, by the names of their types.
    """
    schemas = _Schemas(kind)
    envelope = {"format": {"const": f"holonom-{name}"}, "version": {"const": version}}
    content = schemas.object(kind)
    return {
        "$schema": DRAFT,
        "title": f"holonom-{name}",
        **content,
        "properties": envelope | content["properties"],
        "required": [*envelope, *content["required"]],
        "$defs": getattr(kind, "DEFINITIONS", {}) | schemas.definitions,
    }


class _Schemas:
    """Schemas of types, and of the objects in them as definitions."""

    def __init__(self, root: type) -> None:
        self._root = root
        self._types: dict[str, Any] = {}
        self.definitions: dict[str, dict[str, Any]] = {}

    def object(self, kind: type) -> dict[str, Any]:
        """Return the schema of an object by the entries of its type."""
        stated = [*self._flat(kind)]
        return {
            "description": _description(kind),
            "type": "object",
            "properties": {each.key: {"description": each.text} | self.of(each.kind) | each.rules for each in stated},
            "required": [each.key for each in stated if each.required],
            "additionalProperties": False,
        }

    def of(self, kind: Any) -> dict[str, Any]:
        """Return the schema of a type."""
        origin, inside = get_origin(kind), get_args(kind)
        if kind is None or kind is Any:  # stated by rules alone
            return {}
        if kind in SIMPLE:
            return {"type": SIMPLE[kind]}
        if kind is Fraction:
            return NUMBER
        if origin is Annotated:
            stated = inside[1].stated
            return stated if "$ref" in stated else self.of(inside[0]) | stated
        if origin in (UnionType, Union):
            return _union([self.of(each) for each in inside])
        if origin is tuple and inside[-1] is not Ellipsis:
            return {"type": "array", "prefixItems": [*map(self.of, inside)], "items": False, "minItems": len(inside)}
        if origin is tuple:
            return {"type": "array", "items": self.of(inside[0])}
        if isinstance(origin, type) and issubclass(origin, Mapping):
            return {"type": "object", "additionalProperties": self.of(inside[1])}
        return self._class(kind)

    def _class(self, kind: Any) -> dict[str, Any]:
        if kind is self._root:
            return {"$ref": "#"}
        if hasattr(kind, "SHAPE"):
            self.definitions |= getattr(kind, "DEFINITIONS", {})
            return kind.SHAPE
        if isinstance(kind, type) and issubclass(kind, Enum):
            return {"enum": [str(each.value) for each in kind]}
        return self._reference(kind) if isinstance(kind, type) and entries_of(kind) else {}

    def _reference(self, kind: type) -> dict[str, Any]:
        if self._types.setdefault(kind.__name__, kind) is not kind:
            raise TypeError(f"two types {kind.__name__} in one document")
        if kind.__name__ not in self.definitions:
            self.definitions[kind.__name__] = {}  # while it is being made, for types that contain themselves
            self.definitions[kind.__name__] = self.object(kind)
        return {"$ref": f"#/$defs/{kind.__name__}"}

    def _flat(self, kind: type) -> "list[Entry]":
        """Return the entries of an object, those of groups among them."""
        found = entries_of(kind)
        return [part for each in found for part in ([each] if each.key else self._flat(each.kind))]


def _description(kind: type) -> str:
    """Return the docstring before its sections."""
    paragraphs = takewhile(lambda each: "\n---" not in each, (getdoc(kind) or "").split("\n\n"))
    return " ".join(" ".join(paragraphs).split())


def _union(schemas: list[dict[str, Any]]) -> dict[str, Any]:
    if {} in schemas:
        return {}
    types = [each["type"] for each in schemas if each.keys() == {"type"}]
    others = [each for each in schemas if each.keys() != {"type"}]
    if not others:
        return {"type": types}
    if len(others) == 1 and types == ["null"] and isinstance(others[0].get("type"), str):
        return others[0] | {"type": [others[0]["type"], "null"]}
    return {"anyOf": [*others, *({"type": each} for each in types)]}
