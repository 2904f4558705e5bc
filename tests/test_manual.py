"""Every snippet of the manual's how-tos runs as shown; blocks of bash, for machines to install, are not run."""

import shlex
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import pytest
from snippets import in_a_process, require_parts, snippets_of

ROOT = Path(__file__).parents[1]
MANUAL = ROOT / "harness" / "companion" / "manual"
SCENE = next(text for kind, text in snippets_of(ROOT / "README.md") if kind == "maxima")
SNIPPETS = {file.stem: snippets_of(file) for file in sorted(MANUAL.glob("*.md"))}
PAGES = {page: found for page, found in SNIPPETS.items() if any(kind == "text" for kind, _ in found)}


@pytest.fixture
def place(tmp_path, monkeypatch) -> Path:
    """A directory with the README's scene and the examples, which is the current one."""
    (tmp_path / "my_pendulum.mac").write_text(SCENE, encoding="utf-8")
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_how_tos_are_among_the_pages_that_are_run():
    assert {"user-guide", "sweeps", "c-library", "fmu", "maxima-prompt"} <= {*PAGES}


def test_the_user_guide_begins_with_the_scene_of_the_readme():
    assert ("maxima", SCENE) in SNIPPETS["user-guide"]


@pytest.mark.parametrize("page", PAGES)
def test_the_snippets_of_a_page_print_what_it_shows(page, place, holonom_here, c_compiler):
    printed = ""
    for kind, text in PAGES[page]:
        if kind == "sh":
            printed = [result_of(shlex.split(line), holonom_here) for line in text.splitlines()][-1]
        elif kind == "python":
            with redirect_stdout(StringIO()) as out:
                exec(compile(text, page, "exec"), {})
            printed = out.getvalue()
        elif kind == "maxima" and text != SCENE:
            (place / "steps.mac").write_text(text.replace("load(holonom)", f'load("{ROOT}/maxima/holonom.mac")'))
            printed = result_of(["maxima", "--very-quiet", "-b", "steps.mac"], holonom_here)
        elif kind == "c":
            (place / "run.c").write_text(text, encoding="utf-8")
        elif kind == "text":
            require_parts(text, printed.split())


def result_of(command: list[str], holonom_here) -> str:
    """Return what a command prints."""
    program, *arguments = command
    done = holonom_here(*arguments) if program == "holonom" else in_a_process(*command)
    assert done.returncode == 0, done.stderr
    return done.stdout
