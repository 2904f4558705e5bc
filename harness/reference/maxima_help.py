"""Help for Maxima, of the text on entries: an info file with its index, examples and a demonstration.

Maxima finds a topic by the byte where it begins and the number of its characters. All is ASCII, where the two agree.
"""

import textwrap
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from .entries import EntryText, FunctionText, PartText, Refusal, function_texts, part_texts

INFO = "holonom.info"
DEFINITIONS = "Definitions for holonom"
WIDTH = 79
NODE = "\x1f\nFile: {info},  Node: {node},  {links}\n\n"
SYSTEM, SCENE = "system", "paid_out"  # what the examples assign


def help_files() -> Mapping[str, str]:
    """The text of each file, by its name; ``maxima/help.lisp`` says what each is for."""
    info, index = info_with_index()
    return {
        INFO: info,
        "holonom-index.lisp": index,
        "examples.demo": examples(),
        "holonom.dem": demonstration(),
    }


# ---- ? holonomic_system -----------------------------------------------------------------------------------------


def info_with_index() -> tuple[str, str]:
    """The info file, and the Lisp that tells Maxima where each topic stands in it."""
    first = function_texts()[0].name
    text = f"This is {INFO}: how a system and its scenes are described.\n\n"
    text += NODE.format(info=INFO, node="Top", links=f"Next: {DEFINITIONS},  Up: (dir)")
    text += f"* Menu:\n\n* {DEFINITIONS}::  for instance {first}\n\n"
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
    """Names of topics and their texts. Where both functions have an entry, Maxima shows title <1> and title <2>."""
    functions = function_texts()
    shared = Counter(entry.name for function in functions for entry in function.entries)
    for number, function in enumerate(functions, 1):
        yield function.name, _function(function)
        for entry in function.entries:
            yield f"{entry.name} <{number}>" if shared[entry.name] > 1 else entry.name, _entry(entry)
    yield from ((part.name, _part(part)) for part in part_texts())


def _function(function: FunctionText) -> str:
    entries = "".join(_filled(f"{entry.name}: {entry.type}", 10, 14) for entry in function.entries)
    return (
        f" -- Function: {function.name}\n{_filled(function.summary)}\n{_shown(function.call)}\n"
        f"{_filled('For instance:')}\n{_shown(assignment(function))}\n"
        f"{_filled('Its entries, in any order; each has a topic of its own:')}\n{entries}"
    )


def _entry(entry: EntryText) -> str:
    example = ",\n".join([entry.example, *entry.also])
    text = (
        f" -- Entry of {entry.function}: {entry.name}\n{_filled(entry.text)}\n"
        f"{_filled(f'What it is: {entry.type}.')}{_filled(f'Without it: {entry.default}.')}\n"
        f"{_filled('For instance:')}\n{_shown(example)}"
    )
    if entry.system:
        system = ",\n".join(entry.system)
        text += f"{_filled('of a system with')}\n{_shown(system)}"
    return text + (_refused(entry.refused) if entry.refused else "")


def _part(part: PartText) -> str:
    example = "\n".join([*part.context, f"{part.example};"])
    return (
        f" -- Function: {part.call}\n{_filled(part.text)}\n{_filled('For instance:')}\n{_shown(example)}"
        f"{_refused(part.refused)}"
    )


def _refused(refusals: Sequence[Refusal]) -> str:
    refused = "".join(_filled(f"{refusal.given}: {refusal.said}", 10, 14) for refusal in refusals)
    return f"\n{_filled('What is refused, and words of the sentence that says why:')}\n{refused}"


def _filled(text: str, first: int = 5, later: int = 5) -> str:
    return textwrap.fill(text, WIDTH, initial_indent=" " * first, subsequent_indent=" " * later) + "\n"


def _shown(lines: str) -> str:
    return textwrap.indent(lines, " " * 10) + "\n"


def _lisp(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


# ---- example(holonomic_system), demo(holonom) --------------------------------------------------------------------


def examples() -> str:
    """What ``example(topic)`` runs, in the form of Maxima's manual.demo."""
    system, scene = map(assignment, function_texts())
    return (
        "/* Run by example(topic). */\n\n"
        f"&& holonomic_system\n\n{system}\nprint_derivation({SYSTEM})$\n\n"
        f"&& holonomic_scene\n\n{system}\n{scene}\nprint_derivation({SYSTEM}, {SCENE})$\n"
    )


def demonstration() -> str:
    """What ``demo(holonom)`` runs."""
    system, scene = map(assignment, function_texts())
    return (
        f"/* A system: what it is made of. */\n{system}\n"
        f"/* Its equations, under the numbers of the paper. */\nprint_derivation({SYSTEM})$\n"
        f"/* The system put to work. */\n{scene}\n"
        f"/* The initial motion. */\nprint_derivation({SYSTEM}, {SCENE})$\n"
    )


def assignment(function: FunctionText) -> str:
    """The complete example of a function as a statement."""
    name = SYSTEM if function.name == "holonomic_system" else SCENE
    return f"{name} : {function.complete_call()}$"
