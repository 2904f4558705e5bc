"""The functions of the sources, and the tests nearest to each, found by rule."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

from changes import blanked

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("crosscheck", "program", "series", "simulation", "sweeps")
MOST, FEW = 5, 4  # test files that name the function or its module, that are named after its subject
END_TO_END = ["tests/examples/test_closed_forms.py", "tests/crosscheck/test_check.py"]
END_TO_END += ["tests/program/test_same_numbers.py"]
END_TO_END_OF_MAXIMA = ("tests/test_errata.py", "tests/test_free_motion.py")


@dataclass(frozen=True)
class Function:
    """A function: where its body, without signature and docstring, is in its file."""

    path: str
    name: str
    start: int
    end: int

    @property
    def language(self) -> str:
        return self.path.rpartition(".")[2]

    @property
    def body(self) -> str:
        return read(self.path)[self.start : self.end]

    @cached_property
    def words(self) -> frozenset[str]:
        return frozenset(re.findall(r"[\w%?*+<>=-]+" if self.language == "lisp" else r"[\w%?]+", self.body))

    def __str__(self) -> str:
        return f"{self.path}::{self.name}"


@cache
def read(path: str) -> str:
    return (ROOT / path).read_text(encoding="utf-8")


@cache
def functions() -> tuple[Function, ...]:
    """Return all functions from which mutants are drawn."""
    files = [*(ROOT / "maxima").rglob("*.mac"), *(ROOT / "maxima").rglob("*.lisp")]
    files += [file for package in PACKAGES for file in (ROOT / "harness" / package).rglob("*.py")]
    kinds = {".mac": _of_maxima, ".lisp": _of_lisp, ".py": _of_python}
    paths = sorted(file.relative_to(ROOT).as_posix() for file in files)
    return tuple(each for path in paths for each in kinds[Path(path).suffix](path))


def _of_maxima(path: str) -> Iterator[Function]:
    hidden = blanked("mac", read(path))
    for statement in re.finditer(r"[^$;]+", hidden):
        if found := re.match(r"\s*([\w%?]+)\([^()]*\)\s*:=", statement[0]):
            yield Function(path, found[1], statement.start() + found.end(), statement.end())


def _of_lisp(path: str) -> Iterator[Function]:
    hidden = blanked("lisp", read(path))
    for found in re.finditer(r"^\(defun (\S+) (\((?:[^()]|\([^()]*\))*\))(\s+_+(?:\n_+)*\n)?", hidden, re.MULTILINE):
        end = re.compile(r"\)\s*(?=^\(|\Z)", re.MULTILINE).search(hidden, found.end() - 1)
        yield Function(path, found[1], found.end(), end.start())


def _of_python(path: str) -> Iterator[Function]:
    source = read(path)
    starts = [0]
    for line in source.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    tree = ast.parse(source)
    owners = [("", tree), *((f"{node.name}.", node) for node in ast.walk(tree) if isinstance(node, ast.ClassDef))]
    for owner, node in owners:
        for each in node.body:
            if isinstance(each, ast.FunctionDef):
                body = each.body[1:] if ast.get_docstring(each) else each.body
                if body:
                    yield Function(path, owner + each.name, starts[body[0].lineno - 1], starts[each.end_lineno])


def nearest_tests(function: Function) -> list[str]:
    """Return test files of a function of Maxima, the nearest first, those that call it, some by subject."""
    refusing = ["tests/test_refusals.py"] if "refuse" in function.body else []
    found = [*_mirrors(Path(function.path)), *_by_call(function), *refusing, *_by_subject(function)]
    found += [*END_TO_END, *END_TO_END_OF_MAXIMA]
    return list(dict.fromkeys(found))


def _mirrors(path: Path) -> list[str]:
    tests = ROOT / "tests"
    package = tests.joinpath(*path.parts[1:-1][:1])
    choices = [tests / f"maxima/rtest_{path.stem}.mac", *sorted(package.rglob(f"test_{path.stem}.py"))]
    choices += [tests / f"test_{path.stem}.py", tests / f"test_{package.name}.py"]
    return [choice.relative_to(ROOT).as_posix() for choice in choices if choice.is_file()]


@cache
def _words_of_rtests() -> dict[str, frozenset[str]]:
    files = sorted(file.relative_to(ROOT).as_posix() for file in (ROOT / "tests").rglob("rtest_*.mac"))
    return {file: frozenset(re.findall(r"[\w%?]+", read(file))) for file in files}


def _by_subject(function: Function) -> list[str]:
    """Find the tests of Python whose file is named after something in the function, the rarest names first."""
    found = {subject: path for subject, path in _subjects().items() if function in _functions_about(subject)}
    return [found[subject] for subject in sorted(found, key=lambda each: len(_functions_about(each)))[:FEW]]


@cache
def _subjects() -> dict[str, str]:
    files = [file for package in (*PACKAGES, "stability") for file in (ROOT / "tests" / package).rglob("test_*.py")]
    return {file.stem.removeprefix("test_").rstrip("s"): file.relative_to(ROOT).as_posix() for file in sorted(files)}


@cache
def _functions_about(subject: str) -> frozenset[Function]:
    others = (each for each in functions() if each.language != "py")
    words = subject.split("_")
    return frozenset(each for each in others if all(map(f"{each}{each.body}".lower().__contains__, words)))


def _by_call(function: Function) -> list[str]:
    """Find the rtests that call a function, then those that call its callers, and so on."""
    others = [each for each in functions() if each.language != "py"]
    names, seen, found = {function.name}, set(), []
    while names and len(found) < MOST:
        called = {name.lstrip("$") for name in names}
        tests = {test: len(words) for test, words in _words_of_rtests().items() if words & called}
        found += [test for test in sorted(tests, key=tests.get) if test not in found]
        seen |= names
        names = {each.name for each in others if each.words & (names | called)} - seen
    return found[:MOST]
