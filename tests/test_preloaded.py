"""The image of Maxima with the library loaded."""

import fcntl
import os
import shutil
import time
from pathlib import Path

import pytest

from holonom import maxima, preloaded
from holonom.documents import ask
from holonom.formats import Document
from holonom.sandbox import Limits, Sandbox

EXAMPLES = Path(__file__).parents[1] / "examples"


def asked(library: Path = maxima.LIBRARY) -> tuple[str, Path, frozenset]:
    return shutil.which("maxima"), library, frozenset({("PATH", "/usr/bin:/bin")})


def image(library: Path = maxima.LIBRARY) -> Path | None:
    return preloaded.preloaded_image(*asked(library))


@pytest.fixture(scope="module")
def first_made(tmp_path_factory) -> Path:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        patch.setattr(preloaded, "_known", {})
        if (found := image()) is None:
            pytest.skip("this Maxima's Lisp cannot save itself")
    return found.parent


@pytest.fixture
def cache(tmp_path, monkeypatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(preloaded, "_known", {})
    return tmp_path / "holonom"


@pytest.fixture
def made(first_made, cache) -> Path:
    shutil.copytree(first_made, cache)
    return image()


@pytest.mark.parametrize(
    ("document", "example", "arguments", "settings"),
    [
        (Document.RECORD, "paper/paper.mac", (), {}),
        pytest.param(Document.FREE_MOTION, "pendulum.mac", (None, None), {}, marks=pytest.mark.long),
        # calls in GCL take 63 arguments
        pytest.param(Document.PROGRAM, "chain.mac", (None, "direct"), {"N": "70"}, marks=pytest.mark.long),
    ],
)
def test_with_the_image_and_without_the_documents_are_the_same(monkeypatch, document, example, arguments, settings):
    with_image = ask(document, EXAMPLES / example, *arguments, settings=settings)
    monkeypatch.setattr(maxima, "preloaded_image", lambda *_: None)
    assert ask(document, EXAMPLES / example, *arguments, settings=settings) == with_image


def test_a_scene_that_loads_the_library_in_the_image_runs_its_compiled_functions(tmp_path):
    if maxima._image(shutil.which("maxima")) is None:
        pytest.skip("this Maxima's Lisp cannot save itself")
    file = tmp_path / "scene.mac"
    compiled = r"?compiled\-function\-p(?symbol\-function(?read\-name))"
    file.write_text(f'load("holonom.mac")$ write_it(file) := with_stdout(file, print({compiled}))$')
    assert maxima.run_batch(file, "write_it") == "true \n"


@pytest.mark.long
def test_image_that_does_not_run_is_made_again(first_made, made, particle_scene, monkeypatch):
    monkeypatch.setattr(maxima, "preloaded_image", lambda *_: made if made.exists() else None)
    monkeypatch.setattr(preloaded, "_saves", lambda saved, *_: shutil.copy(first_made / made.name, saved))
    made.chmod(0o700)
    made.write_bytes(made.read_bytes()[:100])
    assert ask(Document.RECORD, particle_scene)
    assert not made.exists()
    assert image() == made
    assert made.read_bytes() == (first_made / made.name).read_bytes()


@pytest.mark.parametrize("content", [None, "#!/bin/sh\nexit 134\n"])
def test_an_image_that_another_command_removes_is_done_without(content, particle_scene, tmp_path, monkeypatch):
    """GCL reads its own file again as it starts, and aborts where that is gone."""
    image = tmp_path / "gone.image"
    if content is not None:
        image.write_text(content)
        image.chmod(0o755)
    monkeypatch.setattr(maxima, "_image", lambda _: image)
    assert ask(Document.RECORD, particle_scene)


def test_image_in_a_folder_that_others_may_write_to_is_not_used(made, monkeypatch):
    monkeypatch.setattr(preloaded, "_known", {})
    made.parent.chmod(0o777)
    assert image() is None


def test_no_image_is_made_on_a_nearly_full_disk(cache, monkeypatch):
    monkeypatch.setattr(preloaded, "FREE_SPACE", shutil.disk_usage("/").total)
    assert image() is None
    assert list(cache.iterdir()) == []


def test_maxima_that_cannot_save_itself_is_asked_once(cache, tmp_path):
    stubborn = tmp_path / "maxima"
    stubborn.write_text(f"#!/bin/sh\necho asked >> {tmp_path}/asked\n")
    stubborn.chmod(0o755)
    for _ in range(2):
        assert preloaded.preloaded_image(str(stubborn), maxima.LIBRARY, frozenset()) is None
    assert (tmp_path / "asked").read_text() == "asked\n"


def test_maxima_that_takes_too_long_to_save_itself_is_asked_again_after_an_hour(cache, tmp_path, monkeypatch):
    slow, started, run = tmp_path / "maxima", [], preloaded.run_process
    slow.write_text("#!/bin/sh\nexec sleep 1000\n")
    slow.chmod(0o755)
    monkeypatch.setattr(preloaded, "MAKING", Limits(seconds=0.2, sandbox=Sandbox.TRUSTED))
    monkeypatch.setattr(preloaded, "run_process", lambda *asked: started.append(asked) or run(*asked))
    for _ in range(2):
        assert preloaded.preloaded_image(str(slow), maxima.LIBRARY, frozenset()) is None
    assert len(started) == 1
    (record,) = cache.glob("*.image")
    os.utime(record, (time.time() - 3601,) * 2)
    assert preloaded.preloaded_image(str(slow), maxima.LIBRARY, frozenset()) is None
    assert len(started) == 2


def test_while_one_process_makes_an_image_others_run_without(made, tmp_path):
    made.rename(tmp_path / "finished")
    lock = os.open(made.parent, os.O_RDONLY)
    fcntl.flock(lock, fcntl.LOCK_EX)
    assert image() is None
    os.close(lock)
    (tmp_path / "finished").rename(made)
    assert image() == made


def test_oldest_images_are_removed_when_there_are_too_many(tmp_path, monkeypatch):
    monkeypatch.setattr(preloaded, "MOST_IMAGES", 3)
    for i in range(5):
        saved, cached = tmp_path / "saved", tmp_path / f"{i}.image"
        saved.write_text("an image")
        preloaded._put(saved, cached)
        os.utime(cached, (i, i))
    assert sorted(each.name for each in tmp_path.glob("*.image")) == ["2.image", "3.image", "4.image"]


def test_image_serves_shells_with_other_search_paths_and_no_other_maxima(made):
    maxima, library, _ = asked()
    assert preloaded.preloaded_image(maxima, library, frozenset({("PATH", "/another:/usr/bin:/bin")})) == made
    other = preloaded._name(maxima, library, frozenset({("PATH", "/usr/bin"), ("MAXIMA_PREFIX", "/another")}))
    assert f"{other}.image" != made.name


@pytest.mark.long
def test_another_library_has_another_image(made, tmp_path):
    second = image(shutil.copytree(maxima.LIBRARY, tmp_path / "library"))
    assert second != made
    assert {*made.parent.glob("*.image")} == {made, second}
