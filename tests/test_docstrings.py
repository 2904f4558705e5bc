"""Docstrings: examples that print what they say, short summaries, and complete sections."""

import ast
import doctest
import re
from importlib import import_module
from pathlib import Path

import pytest

import holonom

PACKAGE = Path(holonom.__file__).parent
PUBLIC = {PACKAGE / "scene.py", PACKAGE / "equations.py", PACKAGE / "program/forms.py"}  # see test_public_docstrings.py
WITH_EXAMPLES = [
    file for file in sorted({*PACKAGE.rglob("*.py")} - PUBLIC) if ">>> " in file.read_text(encoding="utf-8")
]
PROPERTIES = {"property", "cached_property"}


@pytest.mark.parametrize("file", WITH_EXAMPLES, ids=lambda file: file.relative_to(PACKAGE).as_posix())
def test_examples_print_what_they_say(file):
    name = ".".join(("holonom", *file.relative_to(PACKAGE).with_suffix("").parts))
    found = doctest.testmod(import_module(name))
    assert found.attempted > 0
    assert found.failed == 0


def docstrings(file):
    documented = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    nodes = (node for node in ast.walk(parsed(file)) if isinstance(node, documented))
    return [text for text in map(ast.get_docstring, nodes) if text]


def parsed(file):
    return ast.parse(file.read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def summaries():
    return [(file.name, text.split("\n\n")[0]) for file in sorted(PACKAGE.rglob("*.py")) for text in docstrings(file)]


def test_a_summary_is_one_short_line(summaries):
    assert summaries
    assert [each for each in summaries if len(each[1]) > 80 or "\n" in each[1]] == []


def test_docstrings_are_sentences_without_semicolons():
    """Except in code, matrices and lists of literature in parentheses."""
    quoted = re.compile(r"``[^`]*``|`[^`]*`|\([^()]*\)|\[[^\]]*\]")
    texts = [(file.name, quoted.sub("", text)) for file in sorted(PACKAGE.rglob("*.py")) for text in docstrings(file)]
    found = [(name, line) for name, text in texts for line in text.splitlines() if ";" in line]
    assert found == []


def test_modules_and_files_that_docstrings_name_are_there():
    root = PACKAGE.parent
    texts = [text for file in sorted(PACKAGE.rglob("*.py")) for text in docstrings(file)]
    named = {name for text in texts for name in re.findall(r"`(holonom(?:\.\w+)+)`", text)}
    files = {name for text in texts for name in re.findall(r"`((?:maxima|tests|examples|harness)/[\w/.]+\.\w+)`", text)}
    assert named
    assert files
    assert [name for name in sorted(named) if not names_something(name)] == []
    assert [name for name in sorted(files) if not (root / name).exists()] == []


def names_something(name: str) -> bool:
    """Return True for a module of the package, or for what is in one."""
    module, _, attribute = name.rpartition(".")
    file = PACKAGE.joinpath(*name.split(".")[1:])
    return file.is_dir() or file.with_suffix(".py").exists() or hasattr(import_module(module), attribute)


def test_a_summary_names_its_subject(summaries):
    clause = re.compile(r"((Return|Yield) )?(what|whatever|whether|where|when|how|why|those|the same) ", re.IGNORECASE)
    assert [each for each in summaries if clause.match(each[1])] == []


def test_public_functions_document_parameters_and_results():
    files = sorted(PACKAGE.rglob("*.py"))
    found = [(file, each) for file in files for each in public_functions(parsed(file).body)]
    assert found
    missing = [(file.name, each.name, lacking) for file, each in found if (lacking := undocumented(each))]
    assert missing == []


REFERENCE = re.compile(r"\(see `(\w+)\.(\w+)`\)\.$", re.MULTILINE)


def test_a_method_that_refers_to_another_one_for_its_sections_takes_the_same():
    classes = [
        each for file in sorted(PACKAGE.rglob("*.py")) for each in parsed(file).body if isinstance(each, ast.ClassDef)
    ]
    methods = {(owner.name, each.name): each for owner in classes for each in public_functions([owner])}
    texts = {place: ast.get_docstring(each) or "" for place, each in methods.items()}
    found = {place: match.groups() for place, text in texts.items() if (match := REFERENCE.search(text))}
    assert found
    assert [place for place, of in found.items() if of[1] != place[1] or of in found] == []
    assert [place for place, of in found.items() if arguments(methods[place]) != arguments(methods[of])] == []


def public_functions(body):
    for node in body:
        public = isinstance(node, ast.ClassDef | ast.FunctionDef) and not node.name.startswith("_")
        if public and not has_no_sections(node):
            yield from public_functions(node.body) if isinstance(node, ast.ClassDef) else [node]


def has_no_sections(node):
    """Return True for a command of Click, documented by its help, and for a setter, documented by its property."""
    form = re.compile(r"(holonom\.command|click\.group)\(|\w+\.setter$")
    return any(form.match(ast.unparse(each)) for each in node.decorator_list)


def undocumented(function):
    """Return what the sections Parameters and Returns of a docstring lack or have in another order."""
    text = ast.get_docstring(function) or ""
    if REFERENCE.search(text):
        return []
    heads = re.findall(r"^\S.*", section(text, "Parameters"), re.MULTILINE)
    named = [name for head in heads for name in re.findall(r"\w+", head.partition(" : ")[0])]
    names = arguments(function)
    decorators = {ast.unparse(each) for each in function.decorator_list}
    returns = function.returns and ast.unparse(function.returns) != "None" and not decorators & PROPERTIES
    described = section(text, "Returns") or section(text, "Yields")
    return (names if named != names else []) + (["Returns"] if returns and not described else [])


def arguments(function):
    taken = function.args
    found = [*taken.posonlyargs, *taken.args, taken.vararg, *taken.kwonlyargs, taken.kwarg]
    return [argument.arg for argument in found if argument and argument.arg not in ("self", "cls")]


def section(text, title):
    found = re.search(rf"^{title}\n-+\n(.*?)(?=\n\n\w+\n---|\Z)", text, re.MULTILINE | re.DOTALL)
    return found[1] if found else ""
