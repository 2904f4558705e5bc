"""Functions that a user of Maxima calls, and the entries of two of them, as `entries.toml` explains them."""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ..structs import structured

TEXT = Path(__file__).with_name("entries.toml")
FUNCTIONS = ("holonomic_system", "holonomic_scene")


@dataclass(frozen=True)
class Refusal:
    """An entry that is refused, and a part of the sentence that says why."""

    given: str
    said: str
    also: tuple[str, ...] = ()


@dataclass(frozen=True)
class EntryText:
    """What there is to know about an entry."""

    function: str
    name: str
    type: str
    default: str
    text: str
    example: str
    refused: tuple[Refusal, ...]
    also: tuple[str, ...] = ()  # entries that the example needs beside it
    system: tuple[str, ...] = ()  # entries of the system that the example needs in the place of those of the same names


@dataclass(frozen=True)
class FunctionText:
    """What there is to know about a function of the description."""

    name: str
    summary: str
    call: str
    context: tuple[str, ...]  # entries of a complete example
    entries: tuple[EntryText, ...]

    def with_entries(self, *replacing: str) -> str:
        """Return the entries of the example, those given in the place of the ones of the same names."""
        by_name = {_name_of(entry): entry for entry in (*self.context, *replacing)}
        return ",\n  ".join(by_name.values())

    def complete_call(self) -> str:
        """Return the complete example, an expression of Maxima."""
        first = "system, " if self.name == "holonomic_scene" else ""
        return f"{self.name}({first}\n  {self.with_entries()})"


@dataclass(frozen=True)
class PartText:
    """Function called by itself: a step of the derivation, or a writer of entries for a body, a joint or a load."""

    name: str
    call: str
    text: str
    example: str
    context: tuple[str, ...]  # statements that the example needs before it
    refused: tuple[Refusal, ...]
    gives: str = ""  # what the example returns, an expression of Maxima


@cache
def part_texts() -> tuple[PartText, ...]:
    """Return the functions that write entries for bodies, joints and loads."""
    return _parts("part")


@cache
def step_texts() -> tuple[PartText, ...]:
    """Return the steps of the derivation, in the paper's order."""
    return _parts("step")


def _parts(kind: str) -> tuple[PartText, ...]:
    described = _described()
    context = described[f"{kind}_context"]

    def statements(example: str) -> tuple[str, ...]:
        return tuple(f"{name} : {context[name]}$" for name in _names_used(example, context))

    return tuple(structured(PartText, part, context=statements(part["example"])) for part in described[kind])


def _names_used(text: str, context: Mapping[str, str]) -> list[str]:
    """Return the names of the context that a text uses, those that their values use among them, in their order."""
    used = {name for name in context if re.search(rf"(?<!')\b{name}\b(?! =)", text)}
    below = {each for name in used for each in _names_used(context[name], context)}
    return [name for name in context if name in used | below]


@cache
def function_texts() -> tuple[FunctionText, ...]:
    """Return the two functions with their entries."""
    described = _described()
    return tuple(_function(name, described[name]) for name in FUNCTIONS)


def _described() -> dict:
    return tomllib.loads(TEXT.read_text(encoding="utf-8"))


def _function(name: str, described: dict) -> FunctionText:
    entries = tuple(structured(EntryText, entry, function=name) for entry in described["entry"])
    return structured(FunctionText, described, name=name, entries=entries)


def _name_of(entry: str) -> str:
    return entry.partition("=")[0].strip()
