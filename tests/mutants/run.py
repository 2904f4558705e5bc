"""Measure the tests: make wrong programs at random and count those that no test finds.

A seed draws functions of the sources, in each a kind of change, and a change of that kind. The nearest tests of each
mutant run in a copy of the sources. It is killed when one of them fails or takes too long; at the end these tests have
to pass without a mutant. A run that was interrupted continues from its JSON file; survivors meet changed tests again.

    python tests/mutants/run.py build/mutants.json [--seed SEED] [--count COUNT] [--jobs JOBS]
"""

from __future__ import annotations

import argparse
import difflib
import hashlib
import json
import os
import queue
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
import warnings
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import psutil
from changes import changes
from executed import CHOSEN, Executed
from scipy.stats import binomtest
from sources import END_TO_END, ROOT, Function, functions, nearest_tests, read

EQUIVALENT = Path(__file__).with_name("equivalent.toml")
PYTEST = [*CHOSEN, "-x", "-n0", "-rfE"]
SECONDS = 240  # of processor time for each process of a test file; the unchanged program takes less than a third
LONGEST = 3600  # seconds by the clock, for what waits without computing


@dataclass(frozen=True)
class Mutant:
    """A function and the body that replaces its own."""

    function: Function
    body: str

    def __str__(self) -> str:
        lines = difflib.ndiff(self.function.body.splitlines(), self.body.splitlines())
        changed = [f"{line[0]} {line[2:].strip()}" for line in lines if line[0] in "-+"]
        return f"{self.function}: {' '.join(changed)}"

    @property
    def source(self) -> str:
        text = read(self.function.path)
        return text[: self.function.start] + self.body + text[self.function.end :]

    def digest(self, tests: Iterable[str] = ()) -> str:
        """Return the digest of the mutated source and of test files."""
        return hashlib.sha256("\0".join([self.source, *map(read, tests)]).encode()).hexdigest()[:16]


def draw(seed: str) -> Iterator[Mutant]:
    """Draw mutants, at most one of each function; the functions come in an order that the seed decides."""
    lisp = frozenset(each.name for each in functions() if each.language == "lisp")
    for function in sorted(functions(), key=lambda each: hashlib.sha256(f"{seed} {each}".encode()).digest()):
        chance = random.Random(f"{seed} {function}")
        kinds = changes(function.language, function.body, lisp)
        while kinds:
            kind = chance.choice(sorted(kinds))
            body = kinds[kind].pop(chance.randrange(len(kinds[kind])))()
            kinds = {name: left for name, left in kinds.items() if left}
            if words_of(body) != words_of(function.body) and is_a_program(function.language, body):
                yield Mutant(function, body)
                break


def words_of(body: str) -> list[str]:
    """Return the words of a body without zip's `strict`, which states what holds anyway."""
    return re.sub(r"strict=\w+", "", body).split()


def is_a_program(language: str, body: str) -> bool:
    """Return False for a body that Python cannot compile; the other languages' changes keep to the grammar."""
    try:
        with warnings.catch_warnings(action="ignore"):
            return language != "py" or bool(compile(f"def _():\n{body}", "", "exec"))
    except (SyntaxError, ValueError):
        return False


class Copy:
    """A copy of the sources, which may be changed."""

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        for folder in ("harness", "maxima", "tests", "examples"):
            shutil.copytree(ROOT / folder, directory / folder, ignore=shutil.ignore_patterns("__pycache__"))
        for file in filter(Path.is_file, ROOT.iterdir()):  # some tests read the README
            shutil.copy(file, directory)
        (directory / "site").mkdir()
        (directory / "site" / "holonom").symlink_to(directory / "harness")  # before the package that is installed
        own = {"PYTHONPATH": str(directory / "site"), "PYTHONDONTWRITEBYTECODE": "1"}
        own["XDG_CACHE_HOME"] = str(directory / "cache")  # images of Maxima with mutants
        self.environment = os.environ | own

    def failing(self, *tests: str) -> str:
        """Run tests; return the first test that fails, the last one on timeout, "" if none does."""
        named = [re.sub(r".*/(rtest_\w+)\.mac$", r"tests/test_rtests.py::test_rtest[\1]", test) for test in tests]
        command = ["prlimit", f"--cpu={SECONDS}", sys.executable, "-m", "pytest", *PYTEST, *named]
        with psutil.Popen(command, cwd=self.directory, env=self.environment, stdout=-1, stderr=-1) as running:
            try:
                printed, _ = running.communicate(timeout=LONGEST)
            except subprocess.TimeoutExpired:
                for process in [*running.children(recursive=True), running]:
                    process.kill()
                return tests[-1]
        if running.returncode in (0, 5):  # 5: no tests but long ones
            return ""
        first = re.search(r"^(?:FAILED|ERROR) ([^\s[]+(?:\[.*?\])?)(?: - |$)", printed.decode(), re.MULTILINE)
        return first[1] if first else tests[-1]

    def killer(self, mutant: Mutant, batches: Iterable[list[str]]) -> str:
        """Return the first test that fails with the mutant, or "" if it survives."""
        file = self.directory / mutant.function.path
        file.write_text(mutant.source, encoding="utf-8")
        try:
            return next(filter(None, (self.failing(*batch) for batch in batches)), "")
        finally:
            file.write_text(read(mutant.function.path), encoding="utf-8")


def batches_of(mutant: Mutant, executed: Executed) -> list[list[str]]:
    """Return the tests of a mutant, those of one process together: quick ones, then a file at a time."""
    if mutant.function.language == "py":
        quick, files = executed.by(mutant.function), END_TO_END
    else:
        files = nearest_tests(mutant.function)
        quick = [test for test in files if test.endswith(".mac")]
    return [each for each in (quick, *([file] for file in files if file not in quick)) if each]


def files_of(batches: Iterable[list[str]]) -> list[str]:
    """Return the files of tests."""
    return sorted({test.partition("::")[0] for batch in batches for test in batch})


def with_verdicts(mutants: Mapping[Mutant, list[list[str]]], jobs: int) -> Iterator[tuple[Mutant, str]]:
    """Yield each mutant with the test that kills it, as they come."""
    copies: queue.SimpleQueue[Copy] = queue.SimpleQueue()

    def outcome(mutant: Mutant) -> str:
        copy = copies.get()
        try:
            return copy.killer(mutant, mutants[mutant])
        finally:
            copies.put(copy)

    with tempfile.TemporaryDirectory(prefix="holonom-mutants-") as directory, ThreadPoolExecutor(jobs) as pool:
        for i in range(jobs):
            copies.put(Copy(Path(directory, str(i))))
        running = {pool.submit(outcome, mutant): mutant for mutant in mutants}
        try:
            yield from ((running[done], done.result()) for done in as_completed(running))
        finally:
            pool.shutdown(cancel_futures=True)


def report(outcomes: dict[Mutant, str]) -> None:
    """Print the survivors, and the score with its Wilson interval of 95 %."""
    listed = tomllib.loads(EQUIVALENT.read_text(encoding="utf-8"))
    reasons = {f"{each['function']}: {each['change']}": each["reason"] for each in listed.get("mutant", [])}
    alive = [str(mutant) for mutant, killer in outcomes.items() if not killer]
    for mutant in alive:
        print(f"equivalent {mutant}: {reasons[mutant]}" if mutant in reasons else f"SURVIVES {mutant}")
    killed, equivalent = len(outcomes) - len(alive), sum(mutant in reasons for mutant in alive)
    if wrong := len(outcomes) - equivalent:
        low, high = binomtest(killed, wrong).proportion_ci(method="wilson")
        print(f"{killed} of {wrong} mutants killed, {killed / wrong:.1%}, 95 % interval {low:.1%} to {high:.1%}; "
              f"{equivalent} more are equivalent.")  # fmt: skip


def main() -> None:
    """Run what has not been run."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("--seed", help="the clock chooses it unless a run continues")
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--jobs", type=int, default=1)
    given = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))  # the copy goes, whatever ends the run
    earlier = json.loads(given.results.read_text(encoding="utf-8")) if given.results.is_file() else {}
    seed = given.seed or earlier.get("seed") or str(time.time_ns())
    known = earlier.get("outcomes", {}) if earlier.get("seed") == seed else {}
    print(f"seed {seed}, {given.count} mutants of {len(functions())} functions")
    given.results.parent.mkdir(parents=True, exist_ok=True)
    executed = Executed(given.results.parent, given.jobs)
    batches = {mutant: batches_of(mutant, executed) for mutant in islice(draw(seed), given.count)}
    mutants = {mutant: (mutant.digest(), mutant.digest(files_of(tests))) for mutant, tests in batches.items()}
    outcomes = {}
    for mutant, (own, with_tests) in mutants.items():
        killer, met = known.get(own, ("", ""))
        if killer or met == with_tests:
            outcomes[mutant] = killer
    left = {mutant: tests for mutant, tests in batches.items() if mutant not in outcomes}
    for mutant, killer in with_verdicts(left, given.jobs):
        outcomes[mutant] = killer
        print(f"{len(outcomes)}/{len(mutants)} {f'killed by {killer}' if killer else 'SURVIVES'}: {mutant}", flush=True)
        own, with_tests = mutants[mutant]
        known[own] = (killer, with_tests)
        given.results.write_text(json.dumps({"seed": seed, "outcomes": known}, indent=0), encoding="utf-8")
    with tempfile.TemporaryDirectory(prefix="holonom-mutants-") as directory:
        copy = Copy(Path(directory))
        for test in sorted(set(filter(None, outcomes.values()))):
            if copy.failing(test):
                raise SystemExit(f"This test fails without a mutant: {test}")
    report({mutant: outcomes[mutant] for mutant in mutants})


if __name__ == "__main__":
    main()
