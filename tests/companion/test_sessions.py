"""The sessions of Maxima that go with the chapters run to their end, and say what the chapters say."""

import subprocess

import pytest

from holonom.companion import table
from holonom.companion.paper import REPOSITORY
from holonom.companion.sessions import session_text

SESSIONS = table("sessions")
BOOK = REPOSITORY / "harness" / "companion"
QUICK = ("worked-example", "free-motion")


def run(slug: str, tmp_path) -> str:
    """What a session prints, the library being where it is here."""
    file = tmp_path / f"{slug}.mac"
    file.write_text(
        session_text(REPOSITORY, slug).replace("load(holonom)", f'load("{REPOSITORY / "maxima" / "holonom.mac"}")')
    )
    command = ["maxima", "--very-quiet", "-b", str(file)]
    done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=120)
    return done.stdout.replace("\\\n", "")  # where Maxima breaks a line within a name


def test_every_session_is_on_its_page():
    shown = {page.stem for page in BOOK.glob("*/*.md") if "```{session}" in page.read_text(encoding="utf-8")}
    assert set(SESSIONS) == shown


@pytest.mark.parametrize(
    "slug", [slug if slug in QUICK else pytest.param(slug, marks=pytest.mark.long) for slug in SESSIONS]
)
def test_a_session_runs_to_its_end(slug, tmp_path):
    printed = run(slug, tmp_path)
    assert printed.rstrip().endswith(f"{slug}.mac")  # Maxima names the file when all of it is done
    assert "error" not in printed.lower()


def test_the_pencil_session_ends_with_nothing_left_of_the_multiplier(tmp_path):
    assert run("worked-example", tmp_path).split()[-2] == "0"
