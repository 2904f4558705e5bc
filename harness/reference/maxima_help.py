"""Maxima help files from the entry texts: info file, examples and demonstration.

Maxima finds a topic by the byte where it begins and the number of its characters. The text is ASCII, so that both
counts agree.
"""

import textwrap
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from ..files import shared
from .entries import EntryText, ErrorExample, FunctionText, PartText, function_texts, part_texts, step_texts

BY_HAND = shared("examples") / "paper" / "by_hand.mac"
INFO = "holonom.info"
DEFINITIONS = "Definitions for holonom"
WIDTH = 79
NODE = "\x1f\nFile: {info},  Node: {node},  {links}\n\n"
SYSTEM, SCENE = "system", "paid_out"  # what the examples assign


def help_files() -> Mapping[str, str]:
    """Return the text of each file, by its name.

    ``maxima/help.lisp`` describes the files.

    Returns
    -------
    mapping of str to str
        Texts by file name.
    """
    info, index = _info_with_index()
    return {
        INFO: info,
        "holonom-index.lisp": index,
        "examples.demo": examples(),
        "holonom.dem": _demonstration(),
    }


# ---- ? holonomic_system -----------------------------------------------------------------------------------------


def _info_with_index() -> tuple[str, str]:
    """Return the info file, and the Lisp index with the position of each topic."""
    first = function_texts()[0].name
    text = f"This is {INFO}: how a system and its scenes are described.\n\n"
    text += NODE.format(info=INFO, node="Top", links=f"Next: {DEFINITIONS},  Up: (dir)")
    text += f"* Menu:\n\n* {DEFINITIONS}::  for example {first}\n\n"
    text += NODE.format(info=INFO, node=DEFINITIONS, links="Prev: Top,  Up: Top")
    start, places = len(text), []
    for topic, explained in _topics():
        places.append(f'({_lisp(topic)} . ("{INFO}" {len(text)} {len(explained)} "{DEFINITIONS}"))')
        text += explained + "\n"
    section = f'("{DEFINITIONS}" . ("{INFO}" {start} {len(text) - start}))'
    listed = "\n  ".join(sorted(places))
    index = (
        f"(in-package :cl-info)\n(load-info-hashtables (maxima::maxima-load-pathname-directory)\n"
        f" '({listed})\n '({section}))\n"
    )
    return text, index


def _topics() -> Iterator[tuple[str, str]]:
    """Yield names of topics and their texts.

    If several topics share a name, Maxima shows title <1> and title <2>.
    """
    topics = [*_named_topics()]
    shared, met = Counter(name for name, _ in topics), Counter()
    for name, text in topics:
        met[name] += 1
        yield f"{name} <{met[name]}>" if shared[name] > 1 else name, text


def _named_topics() -> Iterator[tuple[str, str]]:
    for function in function_texts():
        yield function.name, _function(function)
        yield from ((entry.name, _entry(entry)) for entry in function.entries)
    yield from ((part.name, _part(part)) for part in (*part_texts(), *step_texts()))


def _function(function: FunctionText) -> str:
    entries = "".join(_filled(f"{entry.name}: {entry.type}", 10, 14) for entry in function.entries)
    return (
        f" -- Function: {function.name}\n{_filled(function.summary)}\n{_shown(function.call)}\n"
        f"{_filled('Example:')}\n{_shown(_assignment(function))}\n"
        f"{_filled('Its entries, in any order; each has a topic of its own:')}\n{entries}"
    )


def _entry(entry: EntryText) -> str:
    example = ",\n".join([entry.example, *entry.also])
    text = (
        f" -- Entry of {entry.function}: {entry.name}\n{_filled(entry.text)}\n"
        f"{_filled(f'What it is: {entry.type}.')}{_filled(f'Without it: {entry.default}.')}\n"
        f"{_filled('Example:')}\n{_shown(example)}"
    )
    if entry.system:
        system = ",\n".join(entry.system)
        text += f"{_filled('of a system with')}\n{_shown(system)}"
    return text + (_errors(entry.errors) if entry.errors else "")


def _part(part: PartText) -> str:
    example = "\n".join([*part.context, f"{part.example};"])
    gives = f"\n{_filled('which gives')}\n{_shown(part.gives)}" if part.gives else ""
    return (
        f" -- Function: {part.call}\n{_filled(part.text)}\n{_filled('Example:')}\n{_shown(example)}{gives}"
        f"{_errors(part.errors)}"
    )


def _errors(errors: Sequence[ErrorExample]) -> str:
    lines = "".join(_filled(f"{error.given}: {error.message}", 10, 14) for error in errors)
    return f"\n{_filled('Errors, and words of their messages:')}\n{lines}"


def _filled(text: str, first: int = 5, later: int = 5) -> str:
    return textwrap.fill(text, WIDTH, initial_indent=" " * first, subsequent_indent=" " * later) + "\n"


def _shown(lines: str) -> str:
    return textwrap.indent(lines, " " * 10) + "\n"


def _lisp(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


# ---- example(holonomic_system), demo(holonom) --------------------------------------------------------------------


def examples() -> str:
    """Return the input of ``example(topic)``, in the form of Maxima's manual.demo.

    Returns
    -------
    str
        Text of the file.
    """
    system, scene = map(_assignment, function_texts())
    steps = "".join("\n".join([f"\n&& {step.name}\n", *step.context, f"{step.example};\n"]) for step in step_texts())
    return (
        "/* Run by example(topic). */\n\n"
        f"&& holonomic_system\n\n{system}\nprint_derivation({SYSTEM})$\n\n"
        f"&& holonomic_scene\n\n{system}\n{scene}\nprint_derivation({SYSTEM}, {SCENE})$\n"
        f"{steps}"
    )


def _demonstration() -> str:
    """Return the input of ``demo(holonom)``.

    It derives the paper's example step by step. The library is already loaded.
    """
    return "".join(
        line for line in BY_HAND.read_text(encoding="utf-8").splitlines(True) if not line.startswith("load(")
    )


def _assignment(function: FunctionText) -> str:
    """Return the complete example of a function as a statement."""
    name = SYSTEM if function.name == "holonomic_system" else SCENE
    return f"{name} : {function.complete_call()}$"
