"""Measure which tests execute a function: those that can kill its mutants.

The tests run in a copy of the sources in which each function begins with a mark, which writes down the test that runs.
What Maxima executed it prints when it ends. A test that fails there is named: it may execute more than was marked.
"""

from __future__ import annotations

import ast
import hashlib
import json
import re
from collections import ChainMap, Counter, defaultdict
from collections.abc import Iterator, Mapping
from functools import cache
from itertools import chain
from pathlib import Path

from copies import Copy, in_copies
from sources import ROOT, Function, functions, read

APART = {"companion", "figures", "mutants", "reference", "typeset"}  # tests of what no mutant is drawn from,
APART |= {"test_escapes.py", "test_escapes_of_a_user.py", "test_hostile.py", "test_kills.py"}  # of the sandbox
APART |= {"test_lisps.py", "test_preloaded.py"}  # and of Maxima without the image, in which functions are defined anew
QUICK = 0.05  # seconds of a test whose time pytest does not list
SECONDS = 120.0  # of the tests that are run at once for a mutant, as measured
SHARES = (1, 3, 6)  # tests in a row of a file, by its nearness to the function
MARKS = "marks.txt"  # what the marks write in a copy
LONGEST = 600  # seconds of processor time of a file's tests

MARKS_OF_PYTHON = """
import os, re

met = set()


def mark(*numbers):
    test = os.environ.get("PYTEST_CURRENT_TEST", "")
    new = [number for number in numbers if (number, test) not in met]
    if new:
        met.update((number, test) for number in new)
        with open({file!r}, "a") as out:
            out.write("".join(f"{{number}} {{test}}\\n" for number in new))


def run_process(command, place, printed):
    from holonom.sandbox import run_process as run

    status = run(command, place, printed)
    for found in re.findall(rb"^MARKS([ 0-9]*)$", printed, re.MULTILINE):
        mark(*map(int, found.split()))
    return status
"""
MARKS_OF_LISP = """
(defvar *marked* (make-array {count} :initial-element nil))
(defun holonom_mark (number) (setf (aref *marked* number) t))
(defun print-marks () (format t "~%MARKS~{{ ~D~}}~%" (loop for i below {count} if (aref *marked* i) collect i)))
"""
INSERTED = {
    "maxima/namespace.lisp": ("(in-package :maxima)\n", "{0}" + MARKS_OF_LISP),
    "harness/headless.lisp": ("(defun leave (status)", "{0} (if (fboundp 'print-marks) (funcall 'print-marks))"),
    "harness/maxima.py": ("run_process([*program", "__import__('marks').{0}"),
}


def marked_body(function: Function, number: int) -> str:
    """Return the body of a function with a mark at its start."""
    if function.language == "mac":
        return f"(?holonom_mark({number}), {function.body})"
    if function.language == "lisp":
        declared = re.match(r"\s*(\(declare .*\)\s*\n)?", function.body).end()
        return f"{function.body[:declared]}(holonom_mark {number}) {function.body[declared:]}"
    indent = re.match(r"\s*", function.body)[0]
    return f"{indent}__import__('marks').mark({number})\n{function.body}"


def add_marks(copy: Copy) -> None:
    """Mark all functions of a copy."""
    texts = defaultdict(str)
    for number, function in sorted(enumerate(functions()), key=lambda each: -each[1].start):  # from the end
        text = texts[function.path] or read(function.path)
        marked = text[: function.start] + marked_body(function, number) + text[function.end :]
        texts[function.path] = marked if function.language != "py" or _parses(marked) else text
    for path, (old, new) in INSERTED.items():
        text = texts[path] or read(path)
        assert text.count(old) == 1, path
        texts[path] = text.replace(old, new.format(old, count=len(functions())))
    for path, text in texts.items():
        (copy.directory / path).write_text(text, encoding="utf-8")
    text = MARKS_OF_PYTHON.format(file=str(copy.directory / MARKS))
    (copy.directory / "site" / "marks.py").write_text(text, encoding="utf-8")


def _parses(text: str) -> bool:
    try:
        ast.parse(text)
    except SyntaxError:  # between a decorator and what it decorates
        return False
    return True


def _executed_by(copy: Copy, file: Path) -> dict[str, dict]:
    """Run the tests of a file; return the seconds and functions of each. What a fixture does, its file does."""
    marks = copy.directory / MARKS
    marks.write_text("", encoding="utf-8")
    name = file.relative_to(ROOT).as_posix()
    _, printed = copy.run(LONGEST, "--durations=0", name)
    print(*re.findall(r"^(?:FAILED|ERROR) .*", printed, re.MULTILINE), sep="\n", end="")
    ran, times = defaultdict(set), Counter()
    for line in marks.read_text(encoding="utf-8").splitlines():
        number, _, test = line.partition(" ")
        test, _, phase = test.rpartition(" ")
        if test:
            of_file = phase == "(setup)" or file.suffix == ".mac"
            ran[name if of_file else test].add(str(functions()[int(number)]))
    for seconds, test in re.findall(r"^([\d.]+)s (?:call|setup) +(\S.*)", printed, re.MULTILINE):
        times[test] += float(seconds)
        times[name] += float(seconds)
    return {test: {"seconds": times[test], "functions": sorted(ran[test])} for test in ran}


def measure(folder: Path, jobs: int) -> Executed:
    """Measure the test files that are new or have changed.

    Parameters
    ----------
    folder : Path
        Where the measurement of each test file is stored.
    jobs : int
        Number of test files that run at once.

    Returns
    -------
    Executed
    """
    folder.mkdir(parents=True, exist_ok=True)
    stored = {file: folder / f"{file.stem}-{_digest(file)}.json" for file in _test_files()}
    left = [file for file in stored if not stored[file].is_file()]
    for file, found in in_copies(_executed_by, left, jobs, add_marks):
        stored[file].write_text(json.dumps(found, indent=0), encoding="utf-8")
    texts = (each.read_text(encoding="utf-8") for each in stored.values())
    return Executed(dict(ChainMap(*map(json.loads, texts))))


def _test_files() -> Iterator[Path]:
    yield from sorted((ROOT / "tests").rglob("rtest_*.mac"))
    for each in sorted((ROOT / "tests").rglob("test_*.py")):
        if not APART.intersection(each.relative_to(ROOT / "tests").parts) and each.name != "test_rtests.py":
            yield each


def _digest(file: Path) -> str:
    text = f"{file.relative_to(ROOT)}\0{file.read_text(encoding='utf-8')}"
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def nearness(file: str, function: Function) -> int:
    """Return 2 if a test file is named after the file of a function, 1 if it names the function, 0 otherwise.

    Parameters
    ----------
    file : str
        Path of the test file.
    function : Function
        A function.

    Returns
    -------
    int
    """
    subject, name = Path(file).stem.partition("_")[2], function.name.rpartition(".")[2].lstrip("$")
    return 2 if subject == Path(function.path).stem.strip("_") else int(name in _words_of(file))


@cache
def _words_of(file: str) -> frozenset[str]:
    return frozenset(re.findall(r"[\w%?-]+", read(file)))


class Executed:
    """The tests that execute each function.

    Functions that were written after the measurement have the tests of the functions that call them.

    Parameters
    ----------
    tests : mapping of str to mapping
        The ``seconds`` of each test and the ``functions`` that it executes.
    """

    def __init__(self, tests: Mapping[str, Mapping]) -> None:
        self._tests = tests
        self._of: dict[str, set[str]] = defaultdict(set)
        for test, measured in tests.items():
            for function in measured["functions"]:
                self._of[function].add(test)

    def by(self, function: Function) -> list[list[str]]:
        """Return tests that execute a function, in portions, those of the nearest files first.

        A file named after that of the function is nearest, then one that names the function, whatever it is about. Of
        each file come the tests that execute the fewest functions: nearest files have `SHARES` of tests in a row.

        Parameters
        ----------
        function : Function
            A function.

        Returns
        -------
        list of list of str
            Each portion takes `SECONDS` at most, or is one test. In a portion, those of a file are together.
        """
        breadth = {test: len(self._tests[test]["functions"]) for test in self._executing(function)}
        ranked, before = [], Counter()
        for test in sorted(breadth, key=lambda each: (breadth[each], each)):
            file = test.partition("::")[0]
            near = nearness(file, function)
            ranked.append((before[file] // SHARES[near], -near, breadth[test], test))
            before[file] += 1
        portions: list[dict[str, list[str]]] = []
        left, whole = 0.0, breadth.keys() & {test.partition("::")[0] for test in breadth}
        for *_, test in sorted(ranked):
            file, seconds = test.partition("::")[0], self._tests[test]["seconds"] or QUICK
            if file in whole and test != file:
                continue
            if seconds > left:
                portions.append(defaultdict(list))
                left = SECONDS
            portions[-1][file].append(test)
            left -= seconds
        return [[*chain.from_iterable(portion.values())] for portion in portions]

    def while_loading(self, function: Function) -> bool:
        """Return True if a function of Maxima runs while the library is loaded.

        Parameters
        ----------
        function : Function
            A function.

        Returns
        -------
        bool
        """
        files = (measured["functions"] for test, measured in self._tests.items() if test.endswith(".mac"))
        return all(str(function) in functions_executed for functions_executed in files)

    def _executing(self, function: Function) -> set[str]:
        name = function.name.rpartition(".")[2].lstrip("$")
        python = function.language == "py"
        beside = (each for each in functions() if (each.language == "py") is python)
        callers = (str(each) for each in beside if each.words & {name, f"${name}"})
        return self._of.get(str(function)) or set().union(*(self._of.get(each, ()) for each in callers))
