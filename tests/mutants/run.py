"""Who checks the check: wrong programs, one at a time, each of which some test has to find.

mutations.toml lists them: a file, the tests beside it, and pairs of texts, what stands there once and what is put in
its place; a third text says why no test can tell the two apart. Each mutation is made in a copy of the sources, its
tests run there, and it is killed when one of them fails. What has been found is kept in a JSON file, under what it
depends on, so that a run that was broken off goes on where it was, and after a change what that touches is run again.

    python tests/mutants/run.py build/mutants.json
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
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
        file = ROOT / self.file
        return file.is_file() and file.read_text(encoding="utf-8").count(self.before) == 1

    @property
    def key(self) -> str:
        """Digest of what the outcome depends on: the mutation, its file, its tests."""
        files = [self.file, *(test.partition("::")[0] for test in self.tests)]
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


def for_pytest(test: str) -> str:
    """Name a test as pytest knows it: what runs a file of Maxima's own tests goes by that file."""
    return f"tests/test_rtests.py::test_rtest[{Path(test).stem}]" if test.endswith(".mac") else test


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
        environment = os.environ | {
            "PYTHONPATH": str(self.directory / "site"),
            "PYTHONDONTWRITEBYTECODE": "1",  # which two files of one size and second would share
            "XDG_CACHE_HOME": str(
                self.directory / "pyproject.toml"
            ),  # no directory: an image for one test does not pay
        }
        command = [sys.executable, "-m", "pytest", "-q", "-x", "-n", "0", "-p", "no:cacheprovider"]
        command += map(for_pytest, tests)
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


def judged(wanted: Mapping[str, Mutation], copy: Copy) -> Iterator[tuple[str, bool]]:
    """Find out of each mutation, by its key, whether it survives, after its tests have passed without it."""
    passed: set[tuple[str, ...]] = set()
    for key, mutation in wanted.items():
        if mutation.tests not in passed and not copy.passes(mutation.tests):
            raise SystemExit(f"These fail without a mutation: {' '.join(mutation.tests)}")
        passed.add(mutation.tests)
        yield key, copy.survives(mutation)


def main(results: Path) -> int:
    """Run what has not been run, print what survives and the score; 1 where the score is too low."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))  # the copy goes, whatever ends the run
    stale = [mutation for mutation in mutations() if not mutation.applies]
    wanted = {mutation.key: mutation for mutation in mutations() if mutation.applies}
    known = json.loads(results.read_text(encoding="utf-8")) if results.is_file() else {}
    found = {key: survived for key, survived in known.items() if key in wanted}
    left = {key: mutation for key, mutation in wanted.items() if key not in found}
    results.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="holonom-mutants-") as directory:
        for i, (key, survived) in enumerate(judged(left, Copy(Path(directory))), start=1):
            print(f"{i}/{len(left)} {'SURVIVES' if survived else 'killed'} {wanted[key]}", flush=True)
            found[key] = survived
            results.write_text(json.dumps(found, indent=0), encoding="utf-8")
    for mutation in stale:
        print(f"Not in the sources as it is listed, or more than once: {mutation}")
    return report([(mutation, found[key]) for key, mutation in wanted.items()], len(stale))


def report(outcomes: Sequence[tuple[Mutation, bool]], stale: int) -> int:
    """Print the survivors, those that are equivalent with the reason, and the score, to which stale ones count."""
    for mutation, survived in outcomes:
        if survived:
            print(f"equivalent: {mutation}: {mutation.equivalent}" if mutation.equivalent else f"SURVIVES {mutation}")
        elif mutation.equivalent:
            print(f"killed, although it is said to be equivalent: {mutation}")
    counts = Counter((survived, bool(mutation.equivalent)) for mutation, survived in outcomes)
    killed, alive = counts[False, False], counts[True, False] + stale
    score = killed / (killed + alive)
    print(f"{killed} of {killed + alive} mutations killed, {score:.1%}; {counts[True, True]} more are equivalent.")
    return 0 if score >= LEAST_SCORE and not counts[False, True] else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
