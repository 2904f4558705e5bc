"""The functions of the sources."""

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

    @property
    def head(self) -> str:
        """A definition of Maxima up to its body."""
        return re.search(rf"{re.escape(self.name)}\([^()]*\)\s*:=$", read(self.path)[: self.start])[0]

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
