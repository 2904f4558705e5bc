"""The companion of the paper and one of somebody's own systems, each made once for all tests."""

import pytest
from own_system import SMOOTH, made

from holonom.companion.book import pages
from holonom.companion.paper import REPOSITORY, book_of_the_paper
from holonom.companion.runs import perform
from holonom.files import write_whole_directory


@pytest.fixture(scope="session")
def results():
    """What the companion's runs gave, by run."""
    return perform(book_of_the_paper().runs, lambda: None)


@pytest.fixture(scope="session")
def companion(results, tmp_path_factory):
    """Directory of its pages."""
    directory = tmp_path_factory.mktemp("made") / "companion"
    write_whole_directory(directory, pages(book_of_the_paper(), results))
    return directory


@pytest.fixture(scope="session")
def own(tmp_path_factory):
    """Directory of the pages of three files: one written for the purpose, one of free motion, one that is long."""
    examples = [REPOSITORY / "examples" / name for name in ("weightless_cabin.mac", "chain.mac")]
    outcome, directory = made(tmp_path_factory.mktemp("own"), SMOOTH, *examples)
    assert outcome.return_value == 0
    return directory
