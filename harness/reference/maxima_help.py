"""Maxima help files from the entry texts: info file, examples and demonstration.

Maxima finds a topic by the byte where it begins and the number of its characters. The text is ASCII, so that both
counts agree.
"""

import textwrap
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from ..files import shared
from .entries import EntryText, ErrorExample, FunctionText, PartText, function_texts, part_texts, step_texts, tool_texts

BY_HAND = shared("examples") / "paper" / "by_hand.mac"
INFO = "holonom.info"
DEFINITIONS = "Definitions for holonom"
WIDTH = 79
INDEX = """(in-package :cl-info)
(load-info-hashtables (maxima::maxima-load-pathname-directory)
 '({topics})
 '({section}))
"""
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
    text = f"This is {INFO}: how a system and its scenes are described.\n\n"
    text += NODE.format(info=INFO, node="Top", links=f"Next: {DEFINITIONS},  Up: (dir)")
    text += f"* Menu:\n\n* {DEFINITIONS}::  for example {function_texts()[0].name}\n\n"
    text += NODE.format(info=INFO, node=DEFINITIONS, links="Prev: Top,  Up: Top")
    start, places = len(text), []
    for topic, explained in _topics():
        name = topic.replace("\\", "\\\\").replace('"', '\\"')
        places.append(f'("{name}" . ("{INFO}" {len(text)} {len(explained)} "{DEFINITIONS}"))')
        text += explained + "\n"
    section = f'("{DEFINITIONS}" . ("{INFO}" {start} {len(text) - start}))'
    return text, INDEX.format(topics="\n  ".join(sorted(places)), section=section)


def _topics() -> Iterator[tuple[str, str]]:
    """Yield names of topics and their texts.

    If several topics share a name, Maxima shows title <1> and title <2>.
    """
    topics = [(function.name, _function(function)) for function in function_texts()]
    topics += [(entry.name, _entry(entry)) for function in function_texts() for entry in function.entries]
    topics += [(part.name, _part(part)) for part in (*part_texts(), *step_texts(), *tool_texts())]
    shared, met = Counter(name for name, _ in topics), Counter()
    for name, text in topics:
        met[name] += 1
        yield f"{name} <{met[name]}>" if shared[name] > 1 else name, text


def _function(function: FunctionText) -> str:
    entries = "".join(_filled(f"{entry.name}: {entry.type}", 10, 14) for entry in function.entries)
    shown = {"Form:": function.call, "Example:": _assignment(function)}
    heading = _filled("Its entries, in any order; each has a topic of its own:")
    return f"{_topic(f'Function: {function.name}', function.summary, shown)}\n{heading}\n{entries}"


def _entry(entry: EntryText) -> str:
    title, example = f"Entry of {entry.function}: {entry.name}", ",\n".join([entry.example, *entry.also])
    text = f"{entry.text} What it is: {entry.type}. Without it: {entry.default}."
    return _topic(title, text, {"Example:": example, "of a system with": ",\n".join(entry.system)}, entry.errors)


def _part(part: PartText) -> str:
    example = "\n".join([*part.context, f"{part.example};"])
    return _topic(f"Function: {part.call}", part.text, {"Example:": example, "which gives": part.gives}, part.errors)


def _topic(title: str, text: str, shown: Mapping[str, str], errors: Sequence[ErrorExample] = ()) -> str:
    """Return a topic: title, text, lines of Maxima under their labels, and errors."""
    blocks = [f" -- {title}\n{_filled(text)}"]
    blocks += [f"{_filled(label)}\n{textwrap.indent(lines, ' ' * 10)}\n" for label, lines in shown.items() if lines]
    if errors:
        given = "".join(_filled(f"{error.given}: {error.message}", 10, 14) for error in errors)
        blocks.append(f"{_filled('Errors, and words of their messages:')}\n{given}")
    return "\n".join(blocks)


def _filled(text: str, first: int = 5, later: int = 5) -> str:
    return textwrap.fill(text, WIDTH, initial_indent=" " * first, subsequent_indent=" " * later) + "\n"


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
