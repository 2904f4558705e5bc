"""Measure the tests: make wrong programs at random and count those that no test finds.

A seed draws functions of the sources, in each a kind of change, and a change of that kind. The tests that execute the
function run in a copy of the sources, the nearest first. The mutant is killed when one of them fails or takes too long;
at the end these tests have to pass without a mutant. Mutants that are listed as equivalent are not run. A run that was
interrupted continues from its JSON file; survivors meet changed tests again.

    python tests/mutants/run.py build/mutants.json [--seed SEED] [--count COUNT] [--jobs JOBS]
"""

from __future__ import annotations

import argparse
import difflib
import hashlib
import json
import random
import re
import signal
import sys
import tempfile
import time
import tomllib
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from changes import changes
from copies import LONGEST, Copy, in_copies
from executed import Executed, measure
from scipy.stats import binomtest
from sources import Function, functions, read

from holonom.preloaded import quoted

EQUIVALENT = Path(__file__).with_name("equivalent.toml")
REDEFINED = "redefined.lisp"
REDEFINITION = """
(let (($functions (copy-list $functions)) ($props (copy-list $props)) (*package* (find-package :maxima)))
  (with-input-from-string (stream {})
    (dolist (form (maxima-statements stream)) (meval* (with-maximas-defaults (in-namespace form))))))
"""
SECONDS = 240  # of processor time for each process of a test file; the unchanged program takes less than a third


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


def failing(copy: Copy, *tests: str) -> str:
    """Run tests; return the first test that fails, the last one on timeout, "" if none does."""
    status, printed = copy.run(SECONDS, "-x", "-rfE", *tests)
    if status in (0, 5):  # 5: no tests but long ones
        return ""
    first = re.search(r"^(?:FAILED|ERROR) ([^\s[]+(?:\[.*?\])?)(?: - |$)", printed, re.MULTILINE)
    return first[1] if first else tests[-1]


def allow_redefinition(copy: Copy) -> None:
    """Have each run of Maxima load `REDEFINED` first, if it is there, and make the image."""
    file = copy.directory / "harness" / "maxima.py"
    source, known = file.read_text(encoding="utf-8"), '*known, f"'
    assert source.count(known) == 1
    redefined = f"*known, *(each.read_text() for each in [Path({str(copy.directory / REDEFINED)!r})] if each.is_file())"
    file.write_text(source.replace(known, f'{redefined}, f"'), encoding="utf-8")
    failing(copy, "tests/maxima/rtest_ranks.mac")


def killer(copy: Copy, mutant: Mutant, tests: Sequence[str], executed: Executed) -> str:
    """Return the first of the tests that fails with the mutant, or ""."""
    function = mutant.function
    is_in_image = f'"{function.path.removeprefix("maxima/")}"' in read("maxima/holonom.mac")
    if function.language != "mac" or not is_in_image or executed.while_loading(function):
        return _failing_with(copy, function.path, mutant.source, tests)
    definition = quoted(f"{function.head}{mutant.body}$")
    return _failing_with(copy, REDEFINED, REDEFINITION.format(definition), tests)


def _failing_with(copy: Copy, path: str, text: str, tests: Sequence[str]) -> str:
    file = copy.directory / path
    before = file.read_text(encoding="utf-8") if file.is_file() else ""
    file.write_text(text, encoding="utf-8")
    try:
        return failing(copy, *tests)
    finally:
        file.write_text(before, encoding="utf-8")


def files_of(tests: Iterable[str]) -> list[str]:
    """Return the files of tests."""
    return sorted({test.partition("::")[0] for test in tests})


def require_passing(tests: Iterable[str]) -> None:
    """End if one of these tests fails without a mutant."""
    with tempfile.TemporaryDirectory(prefix="holonom-mutants-") as directory:
        status, printed = Copy(Path(directory, "copy")).run(LONGEST, "-rfE", *sorted(tests))
        if tests and status:
            raise SystemExit(f"These tests fail without a mutant:\n{printed}")


def reasons() -> dict[str, str]:
    """Return the reason of each mutant that is listed as equivalent."""
    listed = tomllib.loads(EQUIVALENT.read_text(encoding="utf-8"))
    return {f"{each['function']}: {each['change']}": each["reason"] for each in listed.get("mutant", [])}


def report(outcomes: dict[Mutant, str]) -> None:
    """Print the survivors, and the score with its Wilson interval of 95 %."""
    listed, alive = reasons(), [str(mutant) for mutant, killer in outcomes.items() if not killer]
    for mutant in alive:
        print(f"equivalent {mutant}: {listed[mutant]}" if mutant in listed else f"SURVIVES {mutant}")
    killed, equivalent = len(outcomes) - len(alive), sum(mutant in listed for mutant in alive)
    if wrong := len(outcomes) - equivalent:
        low, high = binomtest(killed, wrong).proportion_ci(method="wilson")
        print(f"{killed} of {wrong} mutants killed, {killed / wrong:.1%}, 95 % interval {low:.1%} to {high:.1%}; "
              f"{equivalent} more are equivalent.")  # fmt: skip


def outcomes_of_portion(
    number: int, chosen: Mapping[Mutant, Sequence[Sequence[str]]], known: Mapping, jobs: int, executed: Executed
) -> Iterator[tuple[Mutant, str, str]]:
    """Run a portion of their tests for mutants that survive and have not met these files; yield killers and digests."""
    portions = {mutant: tests[number - 1] for mutant, tests in chosen.items() if len(tests) >= number}
    digests = {mutant: f"{number}:{mutant.digest(files_of(tests))}" for mutant, tests in portions.items()}
    left, listed = [], reasons()
    for mutant, digest in digests.items():
        found, met = known.get(mutant.digest(), ("", []))
        if not found and digest not in met and str(mutant) not in listed:
            left.append(mutant)

    def outcome(copy: Copy, mutant: Mutant) -> str:
        return killer(copy, mutant, portions[mutant], executed)

    for mutant, found in in_copies(outcome, left, jobs, allow_redefinition):
        yield mutant, found, digests[mutant]


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
    executed = measure(given.results.parent / "executed", given.jobs)
    chosen = {mutant: executed.by(mutant.function) for mutant in islice(draw(seed), given.count)}
    for number in range(1, max(map(len, chosen.values()), default=0) + 1):  # survivors meet further tests
        for mutant, found, digest in outcomes_of_portion(number, chosen, known, given.jobs, executed):
            own = mutant.digest()
            known[own] = (found, [*known.get(own, ("", []))[1], digest])
            print(f"{number}: {f'killed by {found}' if found else 'SURVIVES'}: {mutant}", flush=True)
            given.results.write_text(json.dumps({"seed": seed, "outcomes": known}, indent=0), encoding="utf-8")
    outcomes = {mutant: known.get(mutant.digest(), ("", []))[0] for mutant in chosen}
    require_passing(set(filter(None, outcomes.values())))
    report(outcomes)


if __name__ == "__main__":
    main()
