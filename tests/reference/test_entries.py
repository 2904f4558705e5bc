"""The text on the entries is true: Maxima accepts each example, and refuses what is refused in the words given."""

import re
import subprocess
from pathlib import Path

import pytest

from holonom.maxima import LIBRARY
from holonom.reference.entries import (
    EntryText,
    FunctionText,
    PartText,
    function_texts,
    part_texts,
    step_texts,
    tool_texts,
)

SYSTEM, SCENE = function_texts()


def call(function: FunctionText, *replacing: str, system: tuple[str, ...] = ()) -> str:
    first = "base, " if function is SCENE else ""
    if system:
        first = f"{call(SYSTEM, *system)}, "
    return f"{function.name}({first}{function.with_entries(*replacing)})"


def in_context(step: PartText, called: str) -> str:
    """Return a call of Maxima's in which the names of the example have their values."""
    names = (line.partition(" : ")[0] for line in step.context)
    statements = (line.rstrip("$") for line in step.context)
    return f"block([{', '.join(names)}], {', '.join([*statements, called])})"


def misused(step: PartText) -> list[tuple[str, str]]:
    """Return calls of a step with too few arguments and with texts in their place, and what is message of them."""
    texts = ", ".join('"no"' for _ in step.call.split(","))
    return [(f"{step.name}()", "arguments"), (f"{step.name}({texts})", step.name)]


BODIES = ", ".join(dict.fromkeys(line.rstrip("$") for part in part_texts() for line in part.context))
CASES = [
    *(
        (call(function, entry.example, *entry.also, system=entry.system), None)
        for function in (SYSTEM, SCENE)
        for entry in function.entries
    ),
    *(
        (call(function, error.given, *error.also, system=entry.system), error.message)
        for function in (SYSTEM, SCENE)
        for entry in function.entries
        for error in entry.errors
    ),
    *((f"block([{BODIES}], {part.example})", None) for part in part_texts()),
    *((f"block([{BODIES}], {error.given})", error.message) for part in part_texts() for error in part.errors),
    *(
        (in_context(step, f'if ratsimp({step.example}) # ratsimp({step.gives}) then error("gives another")'), None)
        for step in step_texts()
    ),
    *((in_context(step, error.given), error.message) for step in step_texts() for error in step.errors),
    *(case for step in step_texts() for case in misused(step)),
    *((in_context(tool, tool.example), None) for tool in tool_texts()),
    *((in_context(tool, error.given), error.message) for tool in tool_texts() for error in tool.errors),
]


@pytest.fixture(scope="module")
def answers(tmp_path_factory) -> list[str]:
    """What Maxima says of each case, all in one run."""
    lines = [f'load("{LIBRARY}/holonom.mac")$ linel : 100000$ base : {call(SYSTEM)}$']
    lines += [
        f'print("CASE")$ print(if errcatch({case}) = [] then "refused" else "accepted")$ kill(done)$'
        for case, _ in CASES
    ]
    file = tmp_path_factory.mktemp("entries") / "cases.mac"
    file.write_text("\n".join(lines) + '\nprint("CASE")$', encoding="utf-8")
    command = ["maxima", "--very-quiet", "--init=/dev/null", f'--batch-string=batchload("{file}")$']
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120, check=True)
    return [" ".join(part.split()) for part in done.stdout.split("CASE")[1:-1]]


@pytest.mark.parametrize("number", range(len(CASES)), ids=lambda number: " ".join(str(CASES[number][1]).split()[:6]))
def test_maxima_answers_as_the_text_says(answers, number):
    case, message = CASES[number]
    assert len(answers) == len(CASES)
    if message is None:
        assert answers[number].endswith("accepted"), case
    else:
        assert answers[number].endswith("refused"), case
        assert message in answers[number]


@pytest.mark.parametrize("function", [SYSTEM, SCENE], ids=lambda function: function.name)
def test_every_entry_that_maxima_reads_is_explained(function):
    source = "\n".join(file.read_text(encoding="utf-8") for file in Path(LIBRARY).rglob("*.mac"))
    reading = re.search(rf'read_entries\("{function.name}", entries,\s*\[(.*?)\],\s*\[(.*?)\]\)', source, re.DOTALL)
    known = re.findall(r"'(\w+) =", reading[1]) + re.findall(r"'(\w+)", reading[2])
    assert sorted(entry.name for entry in function.entries) == sorted(known)


def test_an_entry_says_all_that_there_is_to_say():
    assert all(isinstance(entry, EntryText) for entry in SYSTEM.entries)
    for entry in (*SYSTEM.entries, *SCENE.entries):
        assert all((entry.type, entry.default, entry.text, entry.example))


def test_every_public_step_is_explained():
    loaded = (Path(LIBRARY) / "holonom.mac").read_text(encoding="utf-8")
    public = re.search(r"public_steps\((.*?)\)\$", loaded, re.DOTALL)[1]
    assert sorted(step.name for step in step_texts()) == sorted([*re.findall(r"(\w+)\(", public), "derive"])


def test_every_function_for_bodies_is_explained():
    loaded = (Path(LIBRARY) / "holonom.mac").read_text(encoding="utf-8")
    public = re.search(r"/\* bodies and joints.*?\*/(.*?)/\*", loaded, re.DOTALL)[1]
    assert {part.name for part in part_texts()} == set(re.findall(r"\w+", public)) - {"ground"}
