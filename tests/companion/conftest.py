"""The companion of the paper and one of somebody's own systems, each made once for all tests."""

from pathlib import Path

import pytest
from own_system import TEXTS, made
from pages import REPOSITORY
from shorter import SHORTER

from holonom.companion.directives import FILES
from holonom.companion.paper import chapters_of_the_paper
from holonom.companion.runs import perform
from holonom.companion.shelf import Shelf
from holonom.companion.site import build


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
    directory = tmp_path_factory.mktemp("made") / "companion"
    shelf = Shelf(chapters_of_the_paper(), "en", directory / FILES, None, dict(results))
    return build((), directory, shelf, {}), shelf.pages


@pytest.fixture(scope="session")
def companion(made_companion):
    """Directory of the companion's pages."""
    return Path(made_companion[0].outdir)


@pytest.fixture(scope="session")
def chapter_pages(made_companion):
    """What the companion's chapters make their pages of, by the last part of their names."""
    return {name.rpartition("/")[2]: page for name, page in made_companion[1].items()}


@pytest.fixture(scope="session")
def own(tmp_path_factory):
    """Directory of the pages of files written for the purpose, of one of free motion, and of one that is long."""
    examples = [REPOSITORY / "examples" / name for name in ("weightless_cabin.mac", "chain.mac")]
    outcome, directory = made(tmp_path_factory.mktemp("own"), TEXTS, *examples)
    assert outcome.return_value == 0
    return directory
