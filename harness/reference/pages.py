"""Sphinx extension that fills the templates of the reference pages.

Entries come from `entries.toml` and documents from their types. Sphinx itself reads commands and docstrings.
"""

import json
import re
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from click import Context
from jinja2 import Environment, FileSystemLoader
from sphinx.application import Sphinx

from ..cli import group
from ..document_types import TYPES, schema
from .entries import function_texts, part_texts, step_texts, tool_texts

FOLDER = "reference/"
SPECIAL = re.compile(r"`[^`]+`|([\\*_\[\]<>$|{}#~])")  # of Markdown; code, which keeps them
COMMON = {"format": "Kind of the document.", "version": "Version of this kind of document."}  # of all schemas
COMBINED = ("oneOf", "anyOf", "allOf")  # of schemas


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the object types of Maxima and the events that fill the pages.

    Parameters
    ----------
    app : Sphinx
        Application.

    Returns
    -------
    dict of str to bool
        Properties of the extension.
    """
    for kind in ("function", "entry"):
        app.add_object_type(f"maxima-{kind}", f"maxima-{kind}", indextemplate=f"pair: %s; Maxima {kind}")
    app.connect("builder-inited", _write_schemas)
    app.connect("source-read", _fill_page)
    app.connect("sphinx-click-process-usage", _show_defaults)
    app.connect("sphinx-click-process-epilog", _add_examples)
    app.connect("autodoc-process-signature", _hide_constructor)
    return {"parallel_read_safe": True}


def _write_schemas(app: Sphinx) -> None:
    """Write the schemas that the page about documents links to."""
    if app.builder.format == "html":
        folder = Path(app.outdir, "_static", "schemas")
        folder.mkdir(parents=True, exist_ok=True)
        for name, found in _schemas().items():
            (folder / f"{name}.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


def _schemas() -> dict[str, dict[str, Any]]:
    return {name: schema(name) for name in sorted(TYPES)}


def _fill_page(app: Sphinx, name: str, source: list[str]) -> None:
    """Fill the template of a page of the reference."""
    if name.startswith(FOLDER):
        source[0] = _templates().from_string(source[0]).render()


@cache
def _templates() -> Environment:
    """Return the environment of the templates."""
    loader = FileSystemLoader(Path(__file__).parent)
    environment = Environment(loader=loader, trim_blocks=True, lstrip_blocks=True, autoescape=False)
    environment.globals |= {
        "functions": {each.name: each for each in function_texts()},
        "bodies": part_texts(),
        "steps": step_texts(),
        "tools": tool_texts(),
        "schemas": _schemas(),
        "statuses": (group.__doc__ or "").split("\n\n")[1],
        "fields": fields_of,
    }
    environment.filters |= {"plain": _plain, "cell": _cell}
    return environment


def _show_defaults(app: Sphinx, ctx: Context, lines: list[str]) -> None:
    """Show the default of each option of a command."""
    ctx.show_default = True


def _add_examples(app: Sphinx, ctx: Context, lines: list[str]) -> None:
    """Append the examples of a command's help."""
    if examples := getattr(ctx.command, "examples", ()):
        lines += ["Examples::", "", *(f"    holonom {each}" for each in examples), ""]


def _hide_constructor(app: Sphinx, kind: str, name: str, *others: Any) -> tuple[str, str] | None:
    """Hide the arguments of classes that a user does not call."""
    return ("", "") if kind == "class" and name.count(".") > 1 else None


def _plain(text: str) -> str:
    """Return Markdown that shows a text as is, words between grave accents as code."""
    return SPECIAL.sub(lambda found: f"\\{found[1]}" if found[1] else found[0], text)


def _cell(code: str) -> str:
    """Return a code span for the cell of a table."""
    return f"`{code}`".replace("|", "\\|") if code else ""


def fields_of(schema: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Return path, kind and description of each field of a document.

    The fields of its definitions follow.

    Parameters
    ----------
    schema : mapping
        JSON Schema of the document.

    Returns
    -------
    list of tuple of str
        Path, kind and description.
    """
    found: dict[str, tuple[str, str, str]] = {}  # of alternatives, the first
    for name, part in (("", schema), *schema.get("$defs", {}).items()):
        for field in _fields(part, name):
            found.setdefault(field[0], field)
    return list(found.values())


def _fields(schema: Mapping[str, Any], path: str) -> Iterator[tuple[str, str, str]]:
    """Yield the fields of an object and of its parts.

    In a path, [] is an element of an array, * any name.
    """
    for below, part in _inside(schema):
        for name, field in part.get("properties", {}).items():
            place = f"{path}{below}.{name}" if path + below else name
            stated = field if isinstance(field, dict) else {}  # true: anything
            yield place, _kind(stated), stated.get("description", COMMON.get(place, ""))
            yield from _fields(stated, place)


def _inside(schema: Any) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield a schema, its alternatives and the elements of an array, with their paths."""
    if not isinstance(schema, dict):
        return  # true: anything
    yield "", schema
    for key, below in (("items", "[]"), ("additionalProperties", ".*")):
        yield from ((below + deeper, part) for deeper, part in _inside(schema.get(key)))
    for alternative in (*schema.get("prefixItems", ()), *(each for key in COMBINED for each in schema.get(key, ()))):
        yield from _inside(alternative)


def _kind(field: Mapping[str, Any]) -> str:
    if "const" in field:
        return json.dumps(field["const"])
    if "enum" in field:
        return " | ".join(map(json.dumps, field["enum"]))
    if "$ref" in field:
        return field["$ref"].rpartition("/")[2]
    if field.get("type") == "array" and "$ref" in (item := field.get("items") or {}):
        return f"array of {_kind(item)}"
    if alternatives := (*field.get("oneOf", ()), *field.get("anyOf", ())):
        return " | ".join(map(_kind, alternatives))
    kind = field.get("type", "anything")
    return " | ".join(kind) if isinstance(kind, list) else kind
