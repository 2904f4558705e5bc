"""Tests assert kinds, facts and numbers of errors, outputs and pages, and not their words."""

import ast
import re
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
WORDS = re.compile(r"(?<![\w'./-])[A-Za-z][a-z]+,? [a-z]{2,}(?![\w'./-])")  # two words of a sentence
TEXTS = {"stderr", "err", "reason", "detail", "message", "note"}  # attributes with the text of an error
TEXTS |= {"stdout", "out", "output"}  # and with that of results
PAGES = {"words", "prose"}  # functions that return the text of a page
# Number of such texts that a file may have, which may only shrink, with the reason.
ALLOWED = {
    "companion/test_book.py": (1, "a sentence with a count"),
    "companion/test_own_scenes.py": (8, "statements on the pages of a scene, each tested once; a title"),
    "examples/test_paper_on_paper.py": (4, "headings and an answer of the derivation on paper"),
    "faults/test_start.py": (1, "the message of an error outside of the package"),
    "mutants/test_changes.py": (1, "the summary of the mutants, tested once"),
    "simulation/test_simulate_command.py": (1, "the note on a correction, tested once"),
    "test_cli.py": (1, "a place: standard input"),
    "test_free_motion.py": (1, "a value of a document"),
    "test_make.py": (6, "the words of the shell scripts, tested once"),
    "test_maxima.py": (8, "Maxima's own words"),
    "test_maxima_path.py": (2, "Maxima's own words; what a scene prints"),
    "test_readme.py": (1, "a heading that contains the word error"),
}


def literals(node):
    """Yield the strings in an expression, those that it adds and formats included."""
    return (each for each in ast.walk(node) if isinstance(each, ast.Constant) and isinstance(each.value, str))


def parameters(function):
    """Return the strings of each parameter of a parametrized test."""
    found = {}
    for mark in function.decorator_list:
        if not (isinstance(mark, ast.Call) and getattr(mark.func, "attr", "") == "parametrize"):
            continue
        names = [name for each in literals(mark.args[0]) for name in re.findall(r"\w+", each.value)]
        for row in getattr(mark.args[1], "elts", ()):
            values = row.args if isinstance(row, ast.Call) else getattr(row, "elts", [row])
            for name, value in zip(names, values if len(names) > 1 else [row], strict=False):
                found.setdefault(name, []).extend(literals(value))
    return found


def is_text(node, texts):
    """Return True if an expression reads the text of an error, or one of these names."""
    return any(
        (isinstance(each, ast.Attribute) and each.attr in TEXTS)
        or (isinstance(each, ast.Subscript) and getattr(each.slice, "value", "") in TEXTS)
        or (isinstance(each, ast.Name) and each.id in texts)
        or (isinstance(each, ast.Call) and {getattr(each.func, "attr", ""), getattr(each.func, "id", "")} & PAGES)
        for each in ast.walk(node)
    ) or (
        isinstance(node, ast.Call)
        and getattr(node.func, "id", "") == "str"
        and any(isinstance(each, ast.Attribute) and each.attr in ("value", "args") for each in ast.walk(node))
    )


def texts_in(function, helpers):
    """Return the names in a function that stand for the text of an error, and those of helpers that return one."""
    return helpers | {
        target.id
        for each in ast.walk(function)
        if isinstance(each, ast.Assign) and is_text(each.value, helpers)
        for target in each.targets
        if isinstance(target, ast.Name)
    }


def asserted(function, texts):
    """Yield the expressions that a test compares with the text of an error."""
    for each in ast.walk(function):
        if isinstance(each, ast.keyword) and each.arg == "match":
            yield each.value
        elif isinstance(each, ast.Compare):
            sides = [each.left, *each.comparators]
            if any(is_text(side, texts) for side in sides):
                yield from sides
        elif isinstance(each, ast.Call) and isinstance(each.func, ast.Attribute):
            if each.func.attr in {"startswith", "endswith"} and is_text(each.func.value, texts):
                yield each.args[0]
            if each.func.attr in {"search", "fullmatch", "findall"} and any(
                is_text(side, texts) for side in each.args[1:]
            ):
                yield each.args[0]


def wordings(source):
    """Yield the line and the text of each sentence that tests assert of an error."""
    functions = [each for each in ast.walk(ast.parse(source)) if isinstance(each, ast.FunctionDef)]
    helpers = {
        function.name
        for function in functions
        for each in ast.walk(function)
        if isinstance(each, ast.Return) and each.value and is_text(each.value, texts_in(function, set()))
    }
    for function in functions:
        given = parameters(function)
        for each in asserted(function, texts_in(function, helpers)):
            named = [text for name in ast.walk(each) if isinstance(name, ast.Name) for text in given.get(name.id, ())]
            yield from ((text.lineno, text.value) for text in (*literals(each), *named) if WORDS.search(text.value))


def test_tests_assert_no_wording():
    read = {file.relative_to(TESTS).as_posix(): file.read_text(encoding="utf-8") for file in TESTS.rglob("*.py")}
    found = {name: sorted(set(wordings(source))) for name, source in read.items()}
    counted = {name: len(texts) for name, texts in found.items() if texts}
    assert counted == {name: count for name, (count, _) in ALLOWED.items()}, found


@pytest.mark.parametrize(
    "source",
    [
        'with pytest.raises(KeyError, match="no such name"): pass',
        'assert "no such name" in done.stderr',
        'assert "no such name" in done.stdout',
        'assert "no such name" in pages.words(page)',
        'said = capsys.readouterr().err; assert said == f"{file}: no such name"',
        'assert "no such name" in str(caught.value)',
        'assert report["reason"].startswith("no such name")',
        'assert re.search("no such name", refusal.value.detail)',
        'assert "no such name" in helper()\n\ndef helper():\n    return run().stderr',
    ],
)
def test_an_asserted_wording_is_found(source):
    body = source.replace("\n    ", "\n        ").replace("\ndef", "\n    def")
    assert [text for _, text in wordings(f"def test_it():\n    {body}\n")] != []


def test_an_asserted_wording_of_a_parameter_is_found():
    source = """
@pytest.mark.parametrize(("name", "told"), [("a", "no such name"), pytest.param("b", "lambda1")])
def test_it(name, told):
    assert told in done.stderr
"""
    assert list(wordings(source)) == [(2, "no such name")]
