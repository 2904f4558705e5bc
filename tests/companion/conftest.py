"""The companion of the paper and one of somebody's own systems, each made once for all tests."""

import pytest
from own_system import TEXTS, made
from shorter import SHORTER

from holonom.companion import book
from holonom.companion.paper import REPOSITORY, book_of_the_paper
from holonom.companion.runs import perform
from holonom.files import write_whole_directory


@pytest.fixture(scope="session")
def results():
    """What the companion's runs gave, by run; some of them to a smaller extent."""
    performed = {run: SHORTER.get(run, run) for run in book_of_the_paper().runs}
    found = perform(performed.values(), lambda: None)
    return {run: found[instead] for run, instead in performed.items()}


@pytest.fixture(scope="session")
def made_companion(results, tmp_path_factory):
    """Directory of its pages, and what its chapters made them of, by slug."""
    directory, kept, page_of = tmp_path_factory.mktemp("made") / "companion", {}, book._page
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(book, "_page", lambda chapter, found: kept.setdefault(chapter.slug, page_of(chapter, found)))
        write_whole_directory(directory, book.pages(book_of_the_paper(), results))
    return directory, kept


@pytest.fixture(scope="session")
def companion(made_companion):
    """Directory of the companion's pages."""
    return made_companion[0]


@pytest.fixture(scope="session")
def chapter_pages(made_companion):
    """What the companion's chapters make their pages of, by slug."""
    return made_companion[1]


@pytest.fixture(scope="session")
def own(tmp_path_factory):
    """Directory of the pages of files written for the purpose, of one of free motion, and of one that is long."""
    examples = [REPOSITORY / "examples" / name for name in ("weightless_cabin.mac", "chain.mac")]
    outcome, directory = made(tmp_path_factory.mktemp("own"), TEXTS, *examples)
    assert outcome.return_value == 0
    return directory
