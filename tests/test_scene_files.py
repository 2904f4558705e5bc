"""The files that a scene may read are opened, and closed again."""

import os
from pathlib import Path

import pytest
from confinement import SANDBOXED

from holonom import scene_files
from holonom.failures import ErrorKind, HolonomError
from holonom.sandbox import Limits, Place, run_process


def descriptors():
    return len(os.listdir("/proc/self/fd"))


@pytest.fixture
def scene(write_scene):
    scene = write_scene('load("below/part.txt")$ read_csv("other.csv")$ load("nothing.mac")$')
    (scene.parent / "below").mkdir()
    for name in ("below/part.txt", "other.csv", "beside.mac", "notes.txt", ".hidden.mac"):
        (scene.parent / name).write_text(name, encoding="utf-8")
    (scene.parent / "linked.mac").symlink_to(scene)
    return scene


def test_named_files_and_maximas_own_are_open_and_no_others(scene):
    before, allowed = descriptors(), scene.parent / "notes.txt"
    with scene_files.opened_scene_files(scene, [allowed, allowed]) as found:
        contents = {path.relative_to(scene.parent).as_posix(): os.read(each, 99) for path, each in found.items()}
        assert descriptors() == before + len(found)
    names = ("notes.txt", "below/part.txt", "other.csv", "beside.mac")
    assert contents == {name: name.encode() for name in names} | {"scene.mac": scene.read_bytes()}
    assert descriptors() == before


@pytest.mark.parametrize(("limit", "least"), [("MOST_FILES", 3), ("MOST_BYTES", 30)])
def test_too_many_files_are_refused_and_closed(limit, least, scene, monkeypatch):
    monkeypatch.setattr(scene_files, limit, least)
    before = descriptors()
    with pytest.raises(HolonomError) as refused, scene_files.opened_scene_files(scene, []):
        pass
    assert (refused.value.kind, descriptors()) == (ErrorKind.TOO_MUCH_BESIDE, before)


@pytest.mark.skipif(not SANDBOXED, reason="no sandbox")
def test_each_process_gets_the_whole_content(tmp_path):
    file = tmp_path / "file.txt"
    file.write_text("content", encoding="utf-8")
    descriptor = os.open(file, os.O_RDONLY)
    place = Place(tmp_path, {"PATH": os.environ["PATH"]}, Limits(), copies={Path("/copy"): descriptor})
    for _ in range(2):
        printed = bytearray()
        assert (run_process(["/bin/cat", "/copy"], place, printed), printed) == (0, b"content")
    os.close(descriptor)
