"""Files that appear whole or not at all."""

import errno
import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from holonom.failures import ErrorKind, HolonomError
from holonom.files import (
    require_own_files,
    whole_file,
    write_files,
    write_whole,
    written_before,
)


def test_replaces_what_was_there_and_leaves_nothing_else(tmp_path):
    file = tmp_path / "file"
    file.write_text("old")
    write_whole(file, "new")
    assert file.read_text() == "new"
    assert os.listdir(tmp_path) == ["file"]


def test_what_was_there_stays_when_the_new_cannot_be_written(tmp_path):
    file = tmp_path / "file"
    file.write_text("old")
    with pytest.raises(UnicodeEncodeError):
        write_whole(file, "half \udc80")
    assert file.read_text() == "old"
    assert os.listdir(tmp_path) == ["file"]


@pytest.mark.parametrize("place", ["nowhere/file", "."])
def test_a_place_that_cannot_be_written_is_refused(place, tmp_path):
    with pytest.raises(HolonomError) as raised:
        write_whole(tmp_path / place, "text")
    assert raised.value.kind is ErrorKind.UNWRITABLE


def test_a_link_is_followed_and_a_device_stays(tmp_path):
    link = tmp_path / "link"
    link.symlink_to(tmp_path / "target")
    write_whole(link, "text")
    assert link.is_symlink()
    assert (tmp_path / "target").read_text() == "text"
    write_whole(Path(os.devnull), "text")
    assert Path(os.devnull).is_char_device()


@pytest.mark.parametrize("mode", [0o600, 0o640, 0o755])
def test_permissions_of_what_is_replaced_stay(mode, tmp_path):
    file = tmp_path / "file"
    file.write_text("old")
    file.chmod(mode)
    write_whole(file, "new")
    assert stat.S_IMODE(file.stat().st_mode) == mode
    assert file.read_text() == "new"


@pytest.mark.parametrize(("mask", "mode"), [(0o022, 0o644), (0o077, 0o600), (0o002, 0o664)])
def test_a_new_file_has_the_permissions_that_the_umask_leaves(mask, mode, tmp_path):
    before = os.umask(mask)
    try:
        write_whole(tmp_path / "file", "new")
        assert os.umask(mask) == mask
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "file").stat().st_mode) == mode


def without_unnamed_files(monkeypatch):
    """As on a file system that knows no O_TMPFILE."""
    opened = os.open

    def refuse(path, flags, *arguments, **options):
        if flags & os.O_TMPFILE == os.O_TMPFILE:
            raise OSError(errno.EOPNOTSUPP, os.strerror(errno.EOPNOTSUPP))
        return opened(path, flags, *arguments, **options)

    monkeypatch.setattr("os.open", refuse)


@pytest.mark.parametrize("prepare", [lambda monkeypatch: None, without_unnamed_files])
def test_while_a_file_is_written_its_folder_holds_nothing_new(prepare, tmp_path, monkeypatch):
    """So nothing is left of it by whatever ends the process."""
    prepare(monkeypatch)
    file = tmp_path / "file"
    file.write_text("old")
    with whole_file(file) as writing:
        writing.write(b"new")
        writing.flush()
        assert os.listdir(tmp_path) == ["file"]
        assert file.read_text() == "old"
    assert file.read_text() == "new"
    assert os.listdir(tmp_path) == ["file"]


def test_no_file_is_opened_that_somebody_put_in_the_way(tmp_path, monkeypatch):
    """Even where the random name of a draft is known beforehand."""
    without_unnamed_files(monkeypatch)
    victim, folder = tmp_path / "victim", tmp_path / "folder"
    victim.write_text("secret")
    folder.mkdir()
    monkeypatch.setattr("os.urandom", bytes)
    trap = folder / f".holonom-{'0' * 16}.new"
    trap.symlink_to(victim)
    with pytest.raises(HolonomError):
        write_whole(folder / "out.json", "forged")
    assert victim.read_text() == "secret"


def test_a_link_of_somebody_else_is_not_followed(tmp_path):
    if os.geteuid() != 0:
        pytest.skip("only root can make a link for somebody else")
    victim, link, own = tmp_path / "victim", tmp_path / "link", tmp_path / "own"
    victim.write_text("secret")
    link.symlink_to(victim)
    os.lchown(link, 65534, 65534)
    own.symlink_to(link)
    for path in (link, own):
        with pytest.raises(HolonomError) as raised:
            write_whole(path, "forged")
        assert raised.value.kind is ErrorKind.UNWRITABLE
    assert victim.read_text() == "secret"


def test_two_processes_that_write_one_file_leave_one_of_the_two(tmp_path):
    write = "from pathlib import Path; from holonom.files import write_whole\n"
    write += f"for _ in range(100): write_whole(Path({str(tmp_path / 'file')!r}), {{}} * 10000)"
    commands = [[sys.executable, "-c", write.format(repr(letter))] for letter in "ab"]
    for process in [subprocess.Popen(command) for command in commands]:
        assert process.wait() == 0
    assert set((tmp_path / "file").read_text()) in ({"a"}, {"b"})
    assert os.listdir(tmp_path) == ["file"]


def test_a_foreign_file_of_the_same_name_is_refused(tmp_path):
    directory = tmp_path / "library"
    write_files(directory, {"crane.c": "first"})
    (directory / "CMakeLists.txt").write_text("mine")
    require_own_files(directory, ["crane.c"])
    with pytest.raises(HolonomError) as raised:
        require_own_files(directory, ["crane.c", "CMakeLists.txt"])
    assert raised.value.kind is ErrorKind.UNRELATED_FILE
    write_files(directory, {"crane.h": "second"})
    assert (directory / "CMakeLists.txt").read_text() == "mine"
    assert written_before(directory) == {"crane.c", "crane.h"}
