"""The sessions of Maxima that go with the chapters run to their end, and say what the chapters say."""

import subprocess

import pytest

from holonom.companion.paper import REPOSITORY, book_of_the_paper
from holonom.companion.sessions import session_text

BOOK = book_of_the_paper()
QUICK = ("worked-example", "free-motion")


def run(slug: str, tmp_path) -> str:
    """What a session prints, the library being where it is here."""
    file = tmp_path / f"{slug}.mac"
    file.write_text(
        session_text(BOOK.sessions[slug]).replace("load(holonom)", f'load("{REPOSITORY / "maxima" / "holonom.mac"}")')
    )
    command = ["maxima", "--very-quiet", "-b", str(file)]
    done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=120)
    return done.stdout.replace("\\\n", "")  # where Maxima breaks a line within a name


def test_every_chapter_has_one_and_no_other():
    numbered = [chapter.slug for title, chapters in BOOK.parts for chapter in chapters if title != "Appendices"]
    assert set(BOOK.sessions) == set(numbered)


@pytest.mark.parametrize(
    "slug", [slug if slug in QUICK else pytest.param(slug, marks=pytest.mark.long) for slug in BOOK.sessions]
)
def test_a_session_runs_to_its_end(slug, tmp_path):
    printed = run(slug, tmp_path)
    assert printed.rstrip().endswith(f"{slug}.mac")  # Maxima names the file when all of it is done
    assert "error" not in printed.lower()


def test_the_pencil_session_ends_with_nothing_left_of_the_multiplier(tmp_path):
    assert run("worked-example", tmp_path).split()[-2] == "0"
