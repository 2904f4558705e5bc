"""Copies of the sources, in which tests run while the copy is changed."""

from __future__ import annotations

import os
import queue
import re
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from subprocess import TimeoutExpired
from typing import TypeVar

import psutil
from sources import ROOT

CHOSEN = ["-q", "-p", "no:cacheprovider", "-m", "not long or measured", "-n0"]
Item, Result = TypeVar("Item"), TypeVar("Result")
LONGEST = 3600  # seconds by the clock, for what waits without computing
LARGEST = 8 << 30  # bytes that a process may write to


class Copy:
    """A copy of the sources, which may be changed.

    Parameters
    ----------
    directory : Path
        A folder that does not exist yet.
    """

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

    def run(self, seconds: int, *arguments: str) -> tuple[int | None, str]:
        """Run pytest.

        Parameters
        ----------
        seconds : int
            Most processor time of each process.
        *arguments : str
            Tests and options. An rtest is the name of its file.

        Returns
        -------
        status : int or None
            pytest's exit status. None if it was ended because it did not end.
        printed : str
            Its output.
        """
        named = [re.sub(r".*/(rtest_\w+)\.mac$", r"tests/test_rtests.py::test_rtest[\1]", each) for each in arguments]
        limits = [f"--cpu={seconds}", f"--data={LARGEST}"]
        command = ["prlimit", *limits, sys.executable, "-m", "pytest", *CHOSEN, *named]
        with psutil.Popen(command, cwd=self.directory, env=self.environment, stdout=-1, stderr=-1) as running:
            try:
                printed, _ = running.communicate(timeout=LONGEST)
            except TimeoutExpired:
                for process in [*running.children(recursive=True), running]:
                    process.kill()
                return None, ""
        return running.returncode, printed.decode()


def in_copies(
    work: Callable[[Copy, Item], Result], items: Sequence[Item], jobs: int, prepare: Callable[[Copy], None] = id
) -> Iterator[tuple[Item, Result]]:
    """Do work in several copies at once.

    Parameters
    ----------
    work : callable
        Given a copy and an item. It leaves the copy as it was.
    items : sequence
        What the work is done for.
    jobs : int
        Number of copies.
    prepare : callable
        Changes each copy first.

    Yields
    ------
    item, result
        As they come.
    """
    copies: queue.SimpleQueue[Copy] = queue.SimpleQueue()

    def outcome(item: Item) -> Result:
        copy = copies.get()
        try:
            return work(copy, item)
        finally:
            copies.put(copy)

    with tempfile.TemporaryDirectory(prefix="holonom-mutants-") as directory, ThreadPoolExecutor(jobs) as pool:
        for i in range(min(jobs, len(items))):
            copy = Copy(Path(directory, str(i)))
            prepare(copy)
            copies.put(copy)
        running = {pool.submit(outcome, item): item for item in items}
        try:
            yield from ((running[done], done.result()) for done in as_completed(running))
        finally:
            pool.shutdown(cancel_futures=True)
