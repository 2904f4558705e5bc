"""Entries of holonomic_system and holonomic_scene, and what writes them for bodies, as `entries.toml` explains them."""

import re
import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

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
    also: tuple[str, ...]  # entries that the example needs beside it
    refused: tuple[Refusal, ...]
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
        """The entries of the example, those given in the place of the ones of the same names."""
        by_name = {_name_of(entry): entry for entry in (*self.context, *replacing)}
        return ",\n  ".join(by_name.values())

    def complete_call(self) -> str:
        """The complete example, an expression of Maxima."""
        first = "system, " if self.name == "holonomic_scene" else ""
        return f"{self.name}({first}\n  {self.with_entries()})"


@dataclass(frozen=True)
class PartText:
    """What there is to know about a function that writes entries for a body, a joint or a load."""

    name: str
    call: str
    text: str
    example: str
    context: tuple[str, ...]  # the bodies that the example uses, as statements
    refused: tuple[Refusal, ...]


@cache
def part_texts() -> tuple[PartText, ...]:
    """The functions that write entries for bodies, joints and loads."""
    described = _described()
    bodies = {name: f"{name} : {body}$" for name, body in described["part_context"].items()}
    return tuple(
        PartText(
            context=tuple(line for name, line in bodies.items() if re.search(rf"\b{name}\b", part["example"])),
            refused=tuple(Refusal(**refusal) for refusal in part.pop("refused")),
            **part,
        )
        for part in described["part"]
    )


@cache
def function_texts() -> tuple[FunctionText, ...]:
    """The two functions with their entries."""
    described = _described()
    return tuple(_function(name, described[name]) for name in FUNCTIONS)


def _described() -> dict:
    return tomllib.loads(TEXT.read_text(encoding="utf-8"))


def _function(name: str, described: dict) -> FunctionText:
    entries = tuple(
        EntryText(
            function=name,
            also=tuple(entry.pop("also", ())),
            system=tuple(entry.pop("system", ())),
            refused=tuple(Refusal(r["given"], r["said"], tuple(r.get("also", ()))) for r in entry.pop("refused")),
            **entry,
        )
        for entry in described["entry"]
    )
    return FunctionText(name, described["summary"], described["call"], tuple(described["context"]), entries)


def _name_of(entry: str) -> str:
    return entry.partition("=")[0].strip()
