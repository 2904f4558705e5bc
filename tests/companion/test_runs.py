"""The runs of a book, performed by processes, and builds that take what an earlier one has."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from holonom.companion.chapter import chapters_of_the_paper
from holonom.companion.directives import FILES
from holonom.companion.runs import Run, perform
from holonom.companion.shelf import Shelf
from holonom.companion.site import build
from holonom.companion.stored_results import Results
from holonom.failures import ErrorKind, HolonomError


def test_a_process_that_is_ended_is_one_sentence_and_the_fault_of_the_machine():
    with pytest.raises(HolonomError) as raised:
        perform([Run(os._exit, (9,)), Run(abs, (-1,))], lambda: None)
    assert raised.value.kind is ErrorKind.WORKER_ENDED
    assert raised.value.kind.status == 3


def test_a_second_build_reads_only_the_chapter_that_has_changed(made_companion, results):
    app, _ = made_companion
    sources, pages, trees = Path(app.srcdir), Path(app.outdir), Path(app.doctreedir)
    before = {tree: tree.stat().st_mtime_ns for tree in trees.rglob("*.doctree")}
    chapter = sources / "book" / "free-motion.md"
    chapter.write_text(chapter.read_text(encoding="utf-8") + "\n% a comment\n", encoding="utf-8")
    shelf = Shelf(chapters_of_the_paper(), "en", pages / FILES, Results(sources.parents[1] / "results", results))
    build(sources, pages, shelf, {})
    assert {tree for tree, time in before.items() if tree.stat().st_mtime_ns != time} == {
        trees / "book" / "free-motion.doctree"
    }
    assert list(shelf.known) == ["book/free-motion"]


def test_chapters_import_nothing_that_only_runs_and_figures_need():
    """A second build with one chapter changed is to be short, and imports were a third of it."""
    asked = (
        "import sys, holonom.companion.site\n"
        "from holonom.companion.chapter import chapters_of_the_paper\n"
        "assert 'hard-cases' in chapters_of_the_paper()\n"
        "print(*{'matplotlib', 'scipy.integrate', 'scipy.optimize', 'sympy.physics', 'heyoka'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []
