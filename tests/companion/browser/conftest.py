"""A browser for all tests, and all pages of the companion as it shows them."""

import shutil

import pages
import pytest
from chromium import chromium, missing_programs
from observation import keep_screenshot, observe
from views import VIEWS

SCREENSHOTS = pages.REPOSITORY / "build" / "screenshots"
# A look at some hundred pages takes more than a minute.
LOOKS = [pytest.param(view, marks=pytest.mark.long) for view in VIEWS]


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    if missing := missing_programs():
        pytest.skip(f"no page was looked at in a browser: {' and '.join(missing)} not installed")
    with chromium(tmp_path_factory.mktemp("profile")) as driver:
        yield driver


@pytest.fixture(scope="session", params=LOOKS, ids=str)
def seen(request, browser, companion, chinese, own):
    """What is met on every page, in one of the views; screenshots are stored."""
    view = request.param
    folder = SCREENSHOTS / str(view).replace(", ", "-")
    shutil.rmtree(folder, ignore_errors=True)
    observations = []
    for book in (companion, chinese, own):
        for page in pages.pages(book):
            observations.append(observe(browser, page, view))
            keep_screenshot(browser, (folder / book.parent.name / page.relative_to(book)).with_suffix(".png"))
    return observations
