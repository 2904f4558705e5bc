"""The image of Maxima with the library: it changes no result, and is trusted only while it is what was made."""

import os
import shutil
import time
from pathlib import Path

import pytest

from holonom import maxima, preloaded
from holonom.confined import Limits, Sandbox
from holonom.documents import Document, ask

EXAMPLES = Path(__file__).parents[1] / "examples"
make_image = preloaded._image


def asked(library: Path = maxima.LIBRARY) -> tuple[str, Path, frozenset]:
    return shutil.which("maxima"), library, frozenset({("PATH", "/usr/bin:/bin")})


def image(library: Path = maxima.LIBRARY) -> Path | None:
    return make_image(*asked(library))


@pytest.fixture(scope="module")
def first_made(tmp_path_factory) -> Path:
    """A cache with an image, and with what its functions were compiled to."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        if (found := image()) is None:
            pytest.skip("this Maxima's Lisp cannot save itself")
    return found.parent


@pytest.fixture
def cache(tmp_path, monkeypatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "holonom"


@pytest.fixture
def made(first_made, cache) -> Path:
    shutil.copytree(first_made, cache)
    return image()


@pytest.mark.parametrize(
    ("document", "example"), [(Document.RECORD, "paper/paper.mac"), (Document.FREE_MOTION, "pendulum.mac")]
)
def test_with_the_image_and_without_the_documents_are_the_same(monkeypatch, document, example):
    arguments = (None,) if document is Document.RECORD else (None, None)
    with_image = ask(document, EXAMPLES / example, *arguments)
    monkeypatch.setattr(maxima, "preloaded_image", lambda *_: None)
    assert ask(document, EXAMPLES / example, *arguments) == with_image


def test_an_image_that_is_torn_or_has_a_flipped_bit_is_made_anew(made):
    data = made.read_bytes()
    made.chmod(0o700)
    for harmed in (data[:-1], data[:99] + bytes([data[99] ^ 1]) + data[100:]):
        made.write_bytes(harmed)
        assert not preloaded._is_sound(made)
    assert image() == made
    assert preloaded._is_whole(made)


def test_the_checksum_is_taken_again_after_a_change_or_a_start_of_the_machine_alone(made, tmp_path, monkeypatch):
    taken = []
    checksum = preloaded._checksum
    monkeypatch.setattr(preloaded, "_checksum", lambda files: taken.append(files) or checksum(files))
    assert image() == made
    assert taken == []
    made.chmod(0o700)
    assert image() == made
    assert len(taken) == 1
    monkeypatch.setattr(preloaded, "BOOT", tmp_path / "boot")
    (tmp_path / "boot").write_text("another")
    assert [image(), image()] == [made, made]
    assert len(taken) == 2


def test_a_flipped_bit_is_found_even_where_the_time_of_writing_was_set_back(made):
    before = made.stat()
    made.chmod(0o700)
    with made.open("r+b") as file:
        file.seek(99)
        byte = file.read(1)[0]
        file.seek(99)
        file.write(bytes([byte ^ 1]))
    os.utime(made, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert not preloaded._is_as_seen(made)
    assert not preloaded._is_whole(made)


def test_a_folder_that_others_may_write_to_is_not_used(made):
    made.parent.chmod(0o777)
    assert image() is None


def test_a_nearly_full_disk_is_not_filled(cache, monkeypatch):
    monkeypatch.setattr(preloaded, "FREE_SPACE", shutil.disk_usage("/").total)
    assert image() is None
    assert list(cache.iterdir()) == []


def test_a_maxima_that_cannot_save_itself_is_asked_once_a_day(cache, tmp_path, monkeypatch):
    stubborn = tmp_path / "maxima"
    stubborn.write_text(f"#!/bin/sh\necho asked >> {tmp_path}/asked\n")
    stubborn.chmod(0o755)
    for _ in range(2):
        assert make_image(str(stubborn), maxima.LIBRARY, frozenset()) is None
    assert (tmp_path / "asked").read_text() == "asked\n"
    monkeypatch.setattr(preloaded, "DAY", -1.0)
    assert make_image(str(stubborn), maxima.LIBRARY, frozenset()) is None
    assert (tmp_path / "asked").read_text() == "asked\nasked\n"


def test_an_image_that_is_taken_away_is_done_without(made, monkeypatch):
    monkeypatch.setattr(preloaded, "_known", {})
    assert preloaded.preloaded_image(*asked()) == made
    made.unlink()
    assert preloaded.preloaded_image(*asked()) is None


def test_while_one_process_makes_an_image_others_do_without_and_ask_again(made, tmp_path, monkeypatch):
    monkeypatch.setattr(preloaded, "_known", {})
    made.rename(tmp_path / "finished")
    with preloaded._alone_in(made.parent):
        assert preloaded.preloaded_image(*asked()) is None
        (tmp_path / "finished").rename(made)
    assert preloaded.preloaded_image(*asked()) == made


def test_a_maxima_that_takes_too_long_to_save_itself_is_not_waited_for_twice(cache, tmp_path, monkeypatch):
    slow, started, run = tmp_path / "maxima", [], preloaded.run_confined
    slow.write_text("#!/bin/sh\nexec sleep 1000\n")
    slow.chmod(0o755)
    monkeypatch.setattr(preloaded, "MAKING", Limits(seconds=0.2, sandbox=Sandbox.TRUSTED))
    monkeypatch.setattr(preloaded, "run_confined", lambda *asked: started.append(asked) or run(*asked))
    for _ in range(2):
        assert make_image(str(slow), maxima.LIBRARY, frozenset()) is None
    assert len(started) == 1


@pytest.fixture
def images(tmp_path):
    """Ten images, each last used so many seconds before the one before it, the first one just now."""

    def used(step: float, content: str = "an image") -> list[Path]:
        files = [tmp_path / f"{i}.image" for i in range(10)]
        for i, file in enumerate(files):
            for each in (file, preloaded._sight_file(file), preloaded._checksum_file([file])):
                each.write_text(content if each == file else "")
                os.utime(each, (time.time() - i * step,) * 2)
        return files

    return used


@pytest.mark.parametrize(
    ("step", "left"),
    [(60.0, preloaded.MOST), (1000.0, 4), (preloaded.IN_USE + 1.0, preloaded.KEPT), (6 * preloaded.DAY, 2)],
)
def test_images_that_nobody_uses_go(images, step, left):
    files = images(step)
    preloaded._remove_unused_ones(files[0].parent)
    assert {each.stem for each in files[0].parent.iterdir()} == {file.stem for file in files[:left]}


def test_what_says_that_no_image_can_be_made_goes_after_a_day_and_keeps_no_place(images):
    files = images(preloaded.DAY / 4 + 1.0, "")
    preloaded._remove_unused_ones(files[0].parent)
    assert [file.exists() for file in files] == [i < 4 for i in range(10)]


def test_an_image_that_a_process_uses_stays(images):
    files = images(preloaded.UNUSED)
    assert preloaded._hold(files[9])
    preloaded._remove_unused_ones(files[0].parent)
    assert [file.exists() for file in files] == [i in (0, 9) for i in range(10)]
    os.close(preloaded._held.pop())
    preloaded._remove_unused_ones(files[0].parent)
    assert not files[9].exists()


@pytest.mark.long
def test_another_library_has_another_image_and_compiled_functions_serve_until_they_are_torn_or_changed(made, tmp_path):
    compiled = made.with_name("functions.o")
    before = compiled.stat().st_mtime_ns
    library = shutil.copytree(maxima.LIBRARY, tmp_path / "library")
    second = image(library)
    assert second != made
    assert {*made.parent.glob("*.image")} == {made, second}
    assert compiled.stat().st_mtime_ns == before
    compiled.write_bytes(compiled.read_bytes()[:-1])
    with (library / "notation.mac").open("a") as file:
        file.write("/* another text */\n")
    image(library)
    assert compiled.stat().st_mtime_ns != before
    assert preloaded._is_whole(made.with_name("functions.lisp"), compiled)
