"""Types and schemas of documents say the same: names, lists, what may be null, kinds of values."""

from collections.abc import Iterator, Mapping
from dataclasses import MISSING, Field, fields, is_dataclass
from enum import Enum
from types import NoneType, UnionType
from typing import Any, Union, get_args, get_origin

import pytest

from holonom.described import System
from holonom.description import DescribedScene, Table
from holonom.errata import PrintedEquation
from holonom.formats import schema
from holonom.free_motion import FreeMotion
from holonom.program.effects import Costs
from holonom.program.model import Model
from holonom.program.motion_problem import MotionProblem
from holonom.program.motion_program import Program
from holonom.record import Record
from holonom.series.power_series import MotionSeries
from holonom.stability.linear_equations import LinearEquations

KINDS = {bool: "boolean", int: "integer", str: "string"}
READ = {
    "motion-series": (MotionSeries, (), ""),
    "record": (Record, (), ""),
    "model": (Model, (), "system source"),
    "effects": (Costs, (), ""),
    "program": (Program, (), "outputs operations"),
    "motion-problem": (MotionProblem, (), "system source joints joint_shapes start drawing origins after _compiled"),
    "linearization": (LinearEquations, (), "scene system title"),
    "free-motion": (FreeMotion, (), "premises check control_law effects parameter_values system time_span"),
    "description scenes": (DescribedScene, ("scenes", 0), ""),
    "description tables": (Table, ("tables", 0), ""),
    "description system": (
        System,
        ("system",),
        "name drawing time multipliers velocities accelerations control_rates control_accelerations",
    ),
    "errata": (PrintedEquation, ("equations", 0), ""),
}
"""Types that read documents or a part of them, with the names that their readers take otherwise."""


class Comparison:
    """A type and a schema, compared part by part."""

    def __init__(self, name: str, otherwise: str) -> None:
        self._root = schema(name)
        self._otherwise = {"format", "version", *otherwise.split()}
        self._seen: set[tuple[Any, int]] = set()

    def part(self, path: tuple[str | int, ...]) -> dict:
        """A part of the schema."""
        found = self._root
        for step in path:
            found = self._resolved(found)
            found = found["items"] if step == 0 else found["properties"][step]
        return self._resolved(found)

    def differences(self, kind: Any, path: tuple[str | int, ...]) -> Iterator[str]:
        """The differences of a type from a part of the schema."""
        return self._differences(kind, self.part(path), "$")

    def _resolved(self, found: dict) -> dict:
        while "$ref" in found:
            target = self._root
            for step in found["$ref"].removeprefix("#").strip("/").split("/"):
                target = target[step] if step else target
            found = {**target, **{key: value for key, value in found.items() if key != "$ref"}}
        return found

    def _differences(self, kind: Any, found: dict, path: str) -> Iterator[str]:
        found = self._resolved(found)
        parts = [self._resolved(each) for each in found.get("anyOf", found.get("oneOf", [found]))]
        null = any("null" in _listed(each.get("type", ())) for each in parts) or None in found.get("enum", ())
        parts = [each for each in parts if each.get("type") != "null"]
        if get_origin(kind) in (UnionType, Union):
            optional = NoneType in get_args(kind)
            kind = next(each for each in get_args(kind) if each is not NoneType)
        else:
            optional = False
        if null and not optional:
            yield f"{path}: null by the schema, {kind} by the type"
        if len(parts) == 1 and (kind, id(parts[0].get("properties"))) not in self._seen:
            yield from self._of_kind(kind, parts[0], path)

    def _of_kind(self, kind: Any, found: dict, path: str) -> Iterator[str]:
        origin, inside = get_origin(kind), get_args(kind)
        if kind in KINDS:
            if KINDS[kind] not in _listed(found.get("type", KINDS[kind])):
                yield f"{path}: {found['type']} by the schema, {kind} by the type"
        elif isinstance(kind, type) and issubclass(kind, Enum):
            if (values := {each.value for each in kind}) != {*found.get("enum", ())} - {None}:
                yield f"{path}: {found.get('enum')} by the schema, {values} by the type"
        elif origin is tuple and Ellipsis in inside:
            yield from self._inside(inside[0], found.get("items"), f"{path}[]")
        elif isinstance(origin, type) and issubclass(origin, Mapping):
            yield from self._inside(inside[1], found.get("additionalProperties"), f"{path}.*")
        elif is_dataclass(kind) and (path == "$" or not hasattr(kind, "of_document")):
            self._seen.add((kind, id(found.get("properties"))))
            yield from self._fields(kind, found, path)

    def _inside(self, kind: Any, found: Any, path: str) -> Iterator[str]:
        if isinstance(found, dict):
            yield from self._differences(kind, found, path)
        else:
            yield f"{path}: nothing by the schema, {kind} by the type"

    def _fields(self, kind: Any, found: dict, path: str) -> Iterator[str]:
        named, properties = dict(_named(kind)), found.get("properties", {})
        for name in sorted((named.keys() ^ properties.keys()) - self._otherwise):
            yield f"{path}.{name}: only in the {'type' if name in named else 'schema'}"
        for name in (named.keys() & properties.keys()) - self._otherwise:
            each = named[name]
            given = each.default is not MISSING or each.default_factory is not MISSING
            if name not in found.get("required", ()) and not given:
                yield f"{path}.{name}: may be missing, and has no default"
            yield from self._differences(each.type, properties[name], f"{path}.{name}")


def _named(kind: Any) -> Iterator[tuple[str, Field]]:
    """The fields by their names in the document, those of groups among them."""
    for each in fields(kind):
        name = each.metadata.get("key", each.name)
        yield from [(name, each)] if name else _named(each.type)


def _listed(kinds: Any) -> list:
    return kinds if isinstance(kinds, list) else [kinds]


@pytest.mark.parametrize("name", READ)
def test_type_and_schema_say_the_same(name):
    kind, path, otherwise = READ[name]
    assert list(Comparison(name.split()[0], otherwise).differences(kind, path)) == []


@pytest.mark.parametrize("name", READ)
def test_a_name_more_or_less_is_found(name):
    kind, path, otherwise = READ[name]
    comparison = Comparison(name.split()[0], otherwise)
    properties = comparison.part(path)["properties"]
    first = next(each for each in properties if each not in ("format", "version", *otherwise.split()))
    properties["another"] = properties.pop(first)
    assert len(list(comparison.differences(kind, path))) == 2
