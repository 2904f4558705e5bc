"""The companion of the paper and one of somebody's own systems, each made once for all tests."""

import shutil
from pathlib import Path

import pytest
from own_system import TEXTS, made
from pages import REPOSITORY
from shorter import SHORTER

from holonom.companion.chapter import SOURCES, chapters_of_the_paper
from holonom.companion.directives import FILES
from holonom.companion.runs import perform
from holonom.companion.shelf import Shelf
from holonom.companion.site import build
from holonom.companion.stored_results import Results
from holonom.language import speaking


@pytest.fixture(scope="session")
def results():
    """What the companion's runs gave, by run; some of them to a smaller extent."""
    runs = {run for chapter in chapters_of_the_paper().values() for run in chapter.runs.values()}
    performed = {run: SHORTER.get(run, run) for run in runs}
    found = perform(performed.values(), lambda: None)
    return {run: found[instead] for run, instead in performed.items()}


@pytest.fixture(scope="session")
def made_companion(results, tmp_path_factory):
    """Sphinx's application that made the companion, and what its chapters made the pages of, by the pages' names."""
    folder = tmp_path_factory.mktemp("made")
    directory, sources = folder / "companion", copied(folder)
    shelf = Shelf(chapters_of_the_paper(), "en", directory / FILES, Results(folder / "results", results))
    return build(sources, directory, shelf, {}), shelf.known


def copied(folder):
    """Copy the texts of the book and the manual, with what they include of the repository. Return their folder."""
    for name in ("tests", "examples", "maxima"):
        (folder / name).symlink_to(REPOSITORY / name)
    texts = Path(shutil.copytree(SOURCES, folder / "harness" / "companion"))
    return texts


@pytest.fixture(scope="session")
def chinese(results, tmp_path_factory):
    """Directory of the companion's pages in Chinese."""
    directory = tmp_path_factory.mktemp("chinese") / "companion"
    shelf = Shelf(chapters_of_the_paper(), "zh", directory / FILES, Results(None, results))
    with speaking("zh"):
        build(SOURCES, directory, shelf, {})
    return directory


@pytest.fixture(scope="session")
def companion(made_companion):
    """Directory of the companion's pages."""
    return Path(made_companion[0].outdir)


@pytest.fixture(scope="session")
def chapter_pages(made_companion):
    """Results and values of the companion's chapters, by the last part of their names."""
    return {name.rpartition("/")[2]: page for name, page in made_companion[1].items()}


@pytest.fixture(scope="session")
def own(tmp_path_factory):
    """Directory of the pages of files written for the purpose, of one of free motion, and of one that is long."""
    examples = [REPOSITORY / "examples" / name for name in ("weightless_cabin.mac", "chain.mac")]
    outcome, directory = made(tmp_path_factory.mktemp("own"), TEXTS, *examples)
    assert outcome.return_value == 0
    return directory
