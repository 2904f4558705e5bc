"""Pages of the reference, as data: what they hold is what the program itself says of its parts.

Entries come from `entries.toml`, commands from their options, documents from their schemas, Python from docstrings.
"""

import inspect
import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import click

from ..cli import group
from ..formats import SCHEMAS
from .entries import EntryText, PartText, Refusal, function_texts, part_texts, step_texts
from .topic import Code, Table, Topic

DESCRIPTION, BODIES, STEPS, COMMANDS, DOCUMENTS, PYTHON = (
    "Describing a system",
    "Bodies and joints",
    "The steps, called by hand",
    "The command line",
    "Documents",
    "Python",
)
COMBINED = ("oneOf", "anyOf", "allOf")  # of schemas
COMPLETION = """\
eval "$(_HOLONOM_COMPLETE=bash_source holonom)"     # in ~/.bashrc
eval "$(_HOLONOM_COMPLETE=zsh_source holonom)"      # in ~/.zshrc
_HOLONOM_COMPLETE=fish_source holonom | source      # in ~/.config/fish/config.fish"""


def topics() -> list[Topic]:
    """Return all pages, group by group."""
    return [
        *entry_topics(),
        *part_topics(),
        *step_topics(),
        *command_topics(),
        *document_topics(),
        *python_topics(),
    ]


# ---- entries ----------------------------------------------------------------------------------------------------


def entry_topics() -> Iterator[Topic]:
    """Yield a page for holonomic_system and for holonomic_scene, and one for each of their entries."""
    for function in function_texts():
        rows = tuple((entry.name, entry.type, entry.default) for entry in function.entries)
        parts = (
            Code("How it is called", function.call),
            Code("For instance", f"{function.complete_call()}$"),
            Table("Its entries, in any order", ("entry", "what it is", "without it"), rows),
        )
        yield Topic(DESCRIPTION, function.name, function.name, function.summary, parts)
        yield from (_entry_topic(entry) for entry in function.entries)


def _entry_topic(entry: EntryText) -> Topic:
    facts = Table("In short", ("", ""), (("what it is", entry.type), ("without it", entry.default)))
    parts: list[Table | Code] = [facts, Code("For instance", ",\n".join([entry.example, *entry.also]))]
    if entry.system:
        parts.append(Code("of a system with", ",\n".join(entry.system)))
    if entry.refused:
        parts.append(_refusals(entry.refused))
    slug = f"{entry.function}-{entry.name}"
    return Topic(DESCRIPTION, slug, f"{entry.name} of {entry.function}", entry.text, tuple(parts))


def _refusals(refused: Sequence[Refusal]) -> Table:
    rows = tuple((refusal.given, refusal.said) for refusal in refused)
    return Table("What is refused", ("given", "the sentence has in it"), rows)


# ---- bodies and joints ------------------------------------------------------------------------------------------


def part_topics() -> Iterator[Topic]:
    """Yield a page for each function that writes entries for a body, a joint or a load."""
    yield from (_part_topic(BODIES, "part", part) for part in part_texts())


def step_topics() -> Iterator[Topic]:
    """Yield a page for each step of the derivation."""
    yield from (_part_topic(STEPS, "step", step) for step in step_texts())


def _part_topic(group: str, kind: str, part: PartText) -> Topic:
    parts: list[Table | Code] = [
        Code("How it is called", part.call),
        Code("For instance", "\n".join([*part.context, f"{part.example};"])),
    ]
    if part.gives:
        parts.append(Code("which gives", part.gives))
    return Topic(group, f"{kind}-{part.name}", part.name, part.text, (*parts, _refusals(part.refused)))


# ---- commands ---------------------------------------------------------------------------------------------------


def command_topics() -> Iterator[Topic]:
    """Yield a page for the command line, and one for each command."""
    commands = tuple((name, _first_line(command)) for name, command in sorted(group.holonom.commands.items()))
    overview = (
        *_usage(group.holonom, "holonom", ("COMMAND",)),
        Table("Commands", ("command", "what it does"), commands),
        Code("Completion in a shell", COMPLETION),
        Code("The manual page", "man ./build/holonom.1    # made by make"),
    )
    status = _sentence((group.__doc__ or "").split("\n\n")[1])
    summary = f"{_help(group.holonom)} {status}"
    yield Topic(COMMANDS, "holonom", "holonom", summary, overview)
    for name, command in sorted(group.holonom.commands.items()):
        yield Topic(COMMANDS, f"holonom-{name}", f"holonom {name}", _help(command), _usage(command, f"holonom {name}"))


def _usage(command: click.Command, name: str, more: Sequence[str] = ()) -> tuple[Table | Code, ...]:
    arguments = [_argument(each) for each in command.params if isinstance(each, click.Argument)]
    called = " ".join([name, "[OPTIONS]", *arguments, *more])
    examples = [f"holonom {each}" for each in getattr(command, "examples", ())]
    usage = Code("How it is called", "\n".join([called, *examples]))
    rows = tuple(map(option_row, command_options(command)))
    return (usage, Table("Options", ("option", "what it does", "without it"), rows)) if rows else (usage,)


def command_options(command: click.Command) -> list[click.Option]:
    """Options of a command that are not hidden, in their order."""
    return [each for each in command.params if isinstance(each, click.Option) and not each.hidden]


def option_row(option: click.Option) -> tuple[str, str, str]:
    """Return an option as it is written, what it does, and what holds without it."""
    written = ", ".join([*option.opts, *option.secondary_opts])
    if not option.is_flag:
        written += f" {option.metavar or _choices(option)}"
    default = "" if option.default in (None, False, ()) or callable(option.default) else str(option.default)
    return written, option.help or "", default


def _choices(option: click.Option) -> str:
    kind = option.type
    return "|".join(kind.choices) if isinstance(kind, click.Choice) else kind.name.upper()


def _argument(argument: click.Argument) -> str:
    return argument.metavar or (argument.name or "").upper()


def _help(command: click.Command) -> str:
    return _sentence(command.help)


def _first_line(command: click.Command) -> str:
    return _sentence((command.help or "").partition("\n\n")[0])


def _sentence(text: str | None) -> str:
    return " ".join((text or "").split())


# ---- documents --------------------------------------------------------------------------------------------------


def document_topics() -> Iterator[Topic]:
    """Yield a page for each JSON document: its fields, and its schema."""
    for file in sorted(SCHEMAS.glob("*.json")):
        text = file.read_text(encoding="utf-8")
        schema = json.loads(text)
        found = [*_fields(schema, "")]
        for name, definition in schema.get("$defs", {}).items():
            found += _fields(definition, name)
        fields = Table("Its fields, those of a kind under its name", ("field", "what it is", "kind"), tuple(found))
        summary = schema.get("description", schema["title"])
        title = f"holonom-{file.stem.replace('_', '-')}"
        yield Topic(
            DOCUMENTS,
            f"document-{file.stem}",
            title,
            summary,
            (fields, Code("The schema (JSON Schema 2020-12)", text.rstrip())),
        )


def _fields(schema: Mapping[str, Any], path: str) -> Iterator[tuple[str, str, str]]:
    """Fields of an object and of what it holds, by their paths; [] stands for the elements of an array."""
    for below, part in _inside(schema):
        for name, field in part.get("properties", {}).items():
            place = f"{path}{below}.{name}" if path + below else name
            stated = field if isinstance(field, dict) else {}  # true: anything
            yield place, stated.get("description", ""), _kind(stated)
            yield from _fields(stated, place)


def _inside(schema: Any) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield a schema, its alternatives and the elements of an array, with additions to their paths."""
    if not isinstance(schema, dict):
        return  # true: anything
    yield "", schema
    if isinstance(schema.get("items"), dict):
        yield from ((f"[]{below}", part) for below, part in _inside(schema["items"]))
    if isinstance(schema.get("additionalProperties"), dict):
        yield from ((f".*{below}", part) for below, part in _inside(schema["additionalProperties"]))
    for alternative in (*schema.get("prefixItems", ()), *(a for key in COMBINED for a in schema.get(key, ()))):
        yield from _inside(alternative)


def _kind(field: Any) -> str:
    if not isinstance(field, dict):
        return "anything"
    if "const" in field:
        return json.dumps(field["const"])
    if "enum" in field:
        return " | ".join(map(json.dumps, field["enum"]))
    if "$ref" in field:
        return field["$ref"].rpartition("/")[2]
    alternatives = (*field.get("oneOf", ()), *field.get("anyOf", ()))
    if alternatives:
        return " | ".join(map(_kind, alternatives))
    kind = field.get("type", "")
    return " | ".join(kind) if isinstance(kind, list) else kind


# ---- Python -----------------------------------------------------------------------------------------------------


def python_topics() -> Iterator[Topic]:
    """Yield a page for each public name."""
    import holonom
    from holonom.dae import Dae
    from holonom.program.right_hand_side import RightHandSide
    from holonom.simulation.result import Simulation
    from holonom.stability.equilibria import Equilibria, Equilibrium
    from holonom.stability.linearization import Linearization

    public = {name: getattr(holonom, name) for name in holonom.__all__}
    returned = (Simulation, Linearization, Equilibria, Equilibrium, RightHandSide, Dae)
    for name, value in (public | {each.__name__: each for each in returned}).items():
        members = [] if inspect.isfunction(value) else list(_members(value))
        parts = (Code("", f"{_signature(name, value)}\n\n{inspect.getdoc(value)}"), *members)
        title = f"holonom.{name}" if name in public else name
        yield Topic(PYTHON, f"python-{name}", title, _sentence((inspect.getdoc(value) or "").split("\n\n")[0]), parts)


def _members(value: type) -> Iterator[Code]:
    for name, member in vars(value).items():
        if name.startswith("_") and name not in ("__getitem__", "__call__"):
            continue
        documented = getattr(member, "func", None) or getattr(member, "fget", None) or member
        if callable(documented) and (text := inspect.getdoc(documented)):
            called = inspect.isfunction(member)
            yield Code(name, f"{_signature(name, documented) if called else name}\n\n{text}")


def _signature(name: str, value: Any) -> str:
    try:
        return f"{name}{inspect.signature(value)}"
    except (TypeError, ValueError):
        return name
