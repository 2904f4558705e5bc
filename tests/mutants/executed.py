"""Measure which tests execute a function of Python: those that can kill its mutants."""

from __future__ import annotations

import hashlib
import os
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import cached_property
from pathlib import Path

from sources import ROOT, Function, functions, read

CHOSEN = ["-q", "-p", "no:cacheprovider", "-m", "not long or measured"]
APART = {"companion", "faults", "figures", "mutants", "reference", "typeset"}  # tests of what no mutant is drawn from
QUICK = 0.05  # seconds of a test whose time pytest does not list
SECONDS = 60.0  # of tests that are run for a mutant, as measured: without the measurement they take half of it
LONGEST = 600  # seconds of a file's tests


class Executed:
    """The tests that execute each function, and the time that each test takes.

    Parameters
    ----------
    folder : Path
        Where the measurement of each test file is stored.
    jobs : int
        Number of test files that run at once.
    """

    def __init__(self, folder: Path, jobs: int) -> None:
        sources = b"\0".join(read(path).encode() for path in sorted({each.path for each in functions()}))
        self._folder = folder / f"executed-{hashlib.sha256(sources).hexdigest()[:16]}"
        self._folder.mkdir(parents=True, exist_ok=True)
        with ThreadPoolExecutor(jobs) as pool:
            list(pool.map(self._measure, self._files()))

    def _files(self) -> Iterator[Path]:
        for each in sorted((ROOT / "tests").rglob("test_*.py")):
            if not APART.intersection(each.relative_to(ROOT / "tests").parts):
                yield each

    def _data(self, file: Path) -> Path:
        text = f"{file.relative_to(ROOT)}\0{file.read_text(encoding='utf-8')}"
        return self._folder / f"{file.stem}-{hashlib.sha256(text.encode()).hexdigest()[:16]}"

    def _measure(self, file: Path) -> None:
        """Run the tests of a file, unless they were; write what they execute, and their times when they have ended."""
        data = self._data(file)
        if data.with_suffix(".txt").is_file():
            return
        options = ["-n0", "--cov=harness", "--cov-context=test", "--cov-report=", "--durations=0"]
        command = ["prlimit", f"--cpu={LONGEST}", sys.executable, "-m", "pytest", *CHOSEN, *options, str(file)]
        environment = os.environ | {"COVERAGE_FILE": str(data)}
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
        if done.returncode not in (0, 5):  # 5: no tests but long ones
            print(f"These tests fail without a mutant: {file}\n{done.stdout[-1000:]}", flush=True)
        data.with_suffix(".txt").write_text(done.stdout, encoding="utf-8")

    @cached_property
    def times(self) -> Mapping[str, float]:
        """Seconds of each test that takes more than a moment."""
        found: Counter[str] = Counter()
        for file in self._files():
            for line in self._data(file).with_suffix(".txt").read_text(encoding="utf-8").splitlines():
                if listed := re.match(r"([\d.]+)s (?:call|setup) +(\S.*)", line):
                    found[listed[2]] += float(listed[1])
        return found

    @cached_property
    def tests(self) -> Mapping[Function, frozenset[str]]:
        """The tests that execute a line of each function."""
        from coverage import CoverageData  # `make mutants` alone needs it

        ran: dict[str, dict[int, set[str]]] = {}
        for data in filter(Path.is_file, map(self._data, self._files())):
            measured = CoverageData(str(data))
            measured.read()
            for path in measured.measured_files():
                lines = ran.setdefault(Path(path).relative_to(ROOT).as_posix(), {})
                for line, contexts in measured.contexts_by_lineno(path).items():
                    lines.setdefault(line, set()).update(each.rpartition("|")[0] for each in contexts if "|" in each)
        return {each: _tests_in(each, ran.get(each.path, {})) for each in functions() if each.language == "py"}

    @cached_property
    def _breadth(self) -> Mapping[str, int]:
        return Counter(test for tests in self.tests.values() for test in tests)

    def by(self, function: Function) -> list[str]:
        """Return tests that execute a function: of each file the one that executes the fewest functions, then the next.

        Parameters
        ----------
        function : Function
            A function of Python.

        Returns
        -------
        list of str
            Tests that take a minute together, one at least.
        """
        ranked, before = [], Counter()
        for test in sorted(self.tests[function], key=lambda each: (self._breadth[each], each)):
            file = test.partition("::")[0]
            ranked.append((before[file], self._breadth[test], test))
            before[file] += 1
        chosen, left = [], SECONDS
        for *_, test in sorted(ranked):
            left -= self.times.get(test, QUICK)
            if left < 0 and chosen:
                break
            chosen.append(test)
        return chosen


def _tests_in(function: Function, ran: Mapping[int, set[str]]) -> frozenset[str]:
    first = read(function.path).count("\n", 0, function.start) + 1
    inside = range(first, first + function.body.count("\n") + 1)
    return frozenset(test for line in inside for test in ran.get(line, ()))
