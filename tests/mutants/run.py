"""Who checks the check: wrong programs, one at a time, each of which some test has to find.

mutations.toml lists them: a file, the tests beside it, and pairs of texts, what stands there once and what is put in
its place; a third text says why no test can tell the two apart. Each mutation is made in a copy of the sources, its
tests run there, and it is killed when one of them fails. What has been found is kept in a JSON file, under all that it
depends on, so that a run that was broken off goes on where it was, and after a change only what it touches is run again.

    python tests/mutants/run.py build/mutants.json
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LIST = Path(__file__).with_name("mutations.toml")
FOLDERS = ("harness", "maxima", "tests", "examples")
SECONDS = 300
"""A test that takes longer than this has noticed something: the unchanged program takes a tenth of it."""

LEAST_SCORE = 0.95
"""Share of the mutations that are not equivalent which the tests have to kill."""


@dataclass(frozen=True)
class Mutation:
    """One wrong program.

    Attributes
    ----------
    file : str
        Its path in the repository.
    before, after : str
    tests : tuple of str
        What pytest is given; one of them has to fail.
    equivalent : str
        Why none can; empty where one must.
    """

    file: str
    before: str
    after: str
    tests: tuple[str, ...]
    equivalent: str = ""

    @property
    def applies(self) -> bool:
        """Whether the text to be replaced stands in the file, once."""
        return (ROOT / self.file).read_text(encoding="utf-8").count(self.before) == 1

    @property
    def key(self) -> str:
        """Digest of what the outcome depends on: the mutation, its file, its tests."""
        files = [self.file, *sorted({test.partition("::")[0] for test in self.tests}), *_rtests(self.tests)]
        parts = [self.before, self.after, *self.tests, *((ROOT / file).read_text(encoding="utf-8") for file in files)]
        return hashlib.sha256("\0".join(parts).encode()).hexdigest()

    def __str__(self) -> str:
        return f"{self.file}: {self.before!r} -> {self.after!r}"


def mutations() -> list[Mutation]:
    """All mutations of the list."""
    listed = tomllib.loads(LIST.read_text(encoding="utf-8"))["file"]
    return [
        Mutation(each["path"], before, after, tuple(each["tests"]), *reason)
        for each in listed
        for before, after, *reason in each["mutations"]
    ]


def _rtests(tests: Iterable[str]) -> list[str]:
    """The file of Maxima text behind each test that runs one."""
    return [f"tests/maxima/{test.partition('[')[2][:-1]}.mac" for test in tests if "test_rtest[" in test]


class Copy:
    """A copy of the sources, which may be changed."""

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        for folder in FOLDERS:
            shutil.copytree(ROOT / folder, directory / folder, ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copy(ROOT / "pyproject.toml", directory)
        (directory / "site").mkdir()
        (directory / "site" / "holonom").symlink_to(directory / "harness")  # before the package that is installed

    def passes(self, tests: Iterable[str]) -> bool:
        """Whether the tests pass, in time."""
        environment = os.environ | {"PYTHONPATH": str(self.directory / "site"), "PYTHONDONTWRITEBYTECODE": "1"}
        command = [sys.executable, "-m", "pytest", "-q", "-x", "-n", "0", "-p", "no:cacheprovider", *tests]
        try:
            done = subprocess.run(
                command, cwd=self.directory, env=environment, capture_output=True, timeout=SECONDS, check=False
            )
        except subprocess.TimeoutExpired:
            return False
        return done.returncode == 0

    def survives(self, mutation: Mutation) -> bool:
        """Whether the tests pass although the mutation has been made."""
        file = self.directory / mutation.file
        text = file.read_text(encoding="utf-8")
        file.write_text(text.replace(mutation.before, mutation.after), encoding="utf-8")
        try:
            return self.passes(mutation.tests)
        finally:
            file.write_text(text, encoding="utf-8")


def judged(wanted: Iterable[Mutation], found: dict[str, bool], copy: Copy) -> Iterator[Mutation]:
    """Find out of each mutation that is new whether it survives, after its tests have passed without it."""
    passed: set[tuple[str, ...]] = set()
    for mutation in wanted:
        if mutation.tests not in passed and not copy.passes(mutation.tests):
            raise SystemExit(f"These fail without a mutation: {' '.join(mutation.tests)}")
        passed.add(mutation.tests)
        found[mutation.key] = copy.survives(mutation)
        yield mutation


def main(results: Path) -> int:
    """Run what has not been run, print what survives and the score; 1 where the score is too low."""
    wanted = mutations()
    stale = [mutation for mutation in wanted if not mutation.applies]
    if stale:
        print("Not in the sources as listed, or more than once:", *stale, sep="\n  ")
        return 2
    found = json.loads(results.read_text(encoding="utf-8")) if results.is_file() else {}
    found = {mutation.key: found[mutation.key] for mutation in wanted if mutation.key in found}
    left = [mutation for mutation in wanted if mutation.key not in found]
    with tempfile.TemporaryDirectory(prefix="holonom-mutants-") as directory:
        for i, mutation in enumerate(judged(left, found, Copy(Path(directory))), start=1):
            print(f"{i}/{len(left)} {'SURVIVES' if found[mutation.key] else 'killed'} {mutation}", flush=True)
            results.parent.mkdir(parents=True, exist_ok=True)
            results.write_text(json.dumps(found, indent=0), encoding="utf-8")
    return report(wanted, found)


def report(wanted: Iterable[Mutation], found: dict[str, bool]) -> int:
    """Print the survivors, those that are equivalent with the reason, and the score."""
    counts = Counter((found[mutation.key], bool(mutation.equivalent)) for mutation in wanted)
    for mutation in wanted:
        if found[mutation.key]:
            print(f"equivalent, {mutation.equivalent}:" if mutation.equivalent else "SURVIVES", mutation)
        elif mutation.equivalent:
            print("KILLED, although it is said to be equivalent:", mutation)
    killed, survived = counts[False, False], counts[True, False]
    score = killed / (killed + survived)
    print(f"{killed} of {killed + survived} mutations killed, {score:.1%}; {counts[True, True]} more are equivalent.")
    return 0 if score >= LEAST_SCORE and not counts[False, True] else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
