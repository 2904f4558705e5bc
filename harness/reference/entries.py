"""Functions that a user of Maxima calls, and their entries, from `entries.toml`."""

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
class ErrorExample:
    """An entry that raises an error, and a part of its message."""

    given: str
    message: str
    also: tuple[str, ...] = ()


@dataclass(frozen=True)
class EntryText:
    """The text about an entry."""

    function: str
    name: str
    type: str
    default: str
    text: str
    example: str
    errors: tuple[ErrorExample, ...]
    also: tuple[str, ...] = ()  # other entries that the example needs
    system: tuple[str, ...] = ()  # entries of the system that the example needs in place of those of the same names


@dataclass(frozen=True)
class FunctionText:
    """The text about a function of the description."""

    name: str
    summary: str
    call: str
    context: tuple[str, ...]  # entries of a complete example
    entries: tuple[EntryText, ...]

    def with_entries(self, *replacing: str) -> str:
        """Return the entries of the example, with some of them replaced.

        Parameters
        ----------
        *replacing : str
            Entries ``name = value`` that replace others.

        Returns
        -------
        str
            Entries, separated by commas.
        """
        by_name = {entry.partition("=")[0].strip(): entry for entry in (*self.context, *replacing)}
        return ",\n  ".join(by_name.values())

    def complete_call(self) -> str:
        """Return the complete example, an expression of Maxima.

        Returns
        -------
        str
            Maxima expression.
        """
        first = "system, " if self.name == "holonomic_scene" else ""
        return f"{self.name}({first}\n  {self.with_entries()})"


@dataclass(frozen=True)
class PartText:
    """The text about a function: a step, or a writer of entries.

    A step belongs to the derivation. Writers are for bodies, joints and loads.
    """

    name: str
    call: str
    text: str
    example: str
    context: tuple[str, ...]  # statements that the example needs before it
    errors: tuple[ErrorExample, ...]
    gives: str = ""  # what the example returns, an expression of Maxima


@cache
def part_texts() -> tuple[PartText, ...]:
    """Return the functions that write entries for bodies, joints and loads.

    Returns
    -------
    tuple of PartText
        Texts of the functions.
    """
    return _parts("part")


@cache
def step_texts() -> tuple[PartText, ...]:
    """Return the steps of the derivation, in the paper's order.

    Returns
    -------
    tuple of PartText
        Texts of the steps.
    """
    return _parts("step")


@cache
def tool_texts() -> tuple[PartText, ...]:
    """Return the functions around the steps: notation, tables and questions.

    Returns
    -------
    tuple of PartText
        Texts of the functions.
    """
    return _parts("tool")


def _parts(kind: str) -> tuple[PartText, ...]:
    described = _described()
    context = described[f"{kind}_context"]

    def statements(example: str) -> tuple[str, ...]:
        return tuple(f"{name} : {context[name]}$" for name in _names_used(example, context))

    return tuple(structured(PartText, part, context=statements(part["example"])) for part in described[kind])


def _names_used(text: str, context: Mapping[str, str]) -> list[str]:
    """Return the names of the context that a text uses, directly or through values."""
    used = {name for name in context if re.search(rf"(?<!')\b{name}\b(?! =)", text)}
    below = {each for name in used for each in _names_used(context[name], context)}
    return [name for name in context if name in used | below]


@cache
def function_texts() -> tuple[FunctionText, ...]:
    """Return the two functions with their entries.

    Returns
    -------
    tuple of FunctionText
        Texts of both functions.
    """
    described = _described()
    return tuple(_function(name, described[name]) for name in FUNCTIONS)


def _described() -> dict:
    return tomllib.loads(TEXT.read_text(encoding="utf-8"))


def _function(name: str, described: dict) -> FunctionText:
    entries = tuple(structured(EntryText, entry, function=name) for entry in described["entry"])
    return structured(FunctionText, described, name=name, entries=entries)
