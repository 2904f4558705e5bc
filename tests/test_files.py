"""Files that appear whole or not at all."""

import errno
import os
from pathlib import Path

import pytest

from holonom.failures import Failure, HolonomError
from holonom.files import (
    PRIVATE,
    private_directory,
    require_own_files,
    sweep_private_directories,
    write_files,
    write_whole,
    write_whole_directory,
)


def write_and_require(directory: Path, files: dict[str, str]) -> None:
    require_own_files(directory, files)
    write_files(directory, files)


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
    assert raised.value.failure is Failure.UNWRITABLE


def test_a_link_is_followed_and_a_device_kept(tmp_path):
    link = tmp_path / "link"
    link.symlink_to(tmp_path / "target")
    write_whole(link, "text")
    assert link.is_symlink()
    assert (tmp_path / "target").read_text() == "text"
    write_whole(Path(os.devnull), "text")
    assert Path(os.devnull).is_char_device()


def test_a_directory_keeps_what_was_not_written_by_us(tmp_path):
    directory = tmp_path / "pages"
    write_whole_directory(directory, {"index.html": "first", "part/old.html": "first"})
    (directory / "part" / "own.mac").write_text("mine")
    write_whole_directory(directory, {"index.html": "second"})
    assert (directory / "index.html").read_text() == "second"
    assert (directory / "part" / "own.mac").read_text() == "mine"
    assert not (directory / "part" / "old.html").exists()
    assert os.listdir(tmp_path) == ["pages"]


@pytest.mark.parametrize("write", [write_whole_directory, write_and_require])
def test_a_foreign_file_of_the_same_name_is_refused(write, tmp_path):
    directory = tmp_path / "pages"
    write_whole_directory(directory, {"index.html": "first"})
    (directory / "CMakeLists.txt").write_text("mine")
    with pytest.raises(HolonomError) as raised:
        write(directory, {"index.html": "second", "CMakeLists.txt": "ours"})
    assert raised.value.failure is Failure.FOREIGN_FILE
    assert (directory / "CMakeLists.txt").read_text() == "mine"
    assert (directory / "index.html").read_text() == "first"


def test_a_private_directory_goes_whatever_is_in_it():
    with private_directory() as directory:
        (directory / "closed").mkdir()
        (directory / "closed" / "file").touch()
        (directory / "closed").chmod(0)
    assert not directory.exists()


def test_a_directory_that_another_run_sweeps_before_it_is_locked_is_made_again(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    opened, sweeps = os.open, [sweep_private_directories]

    def after_a_sweep(*arguments, **options):
        if sweeps:
            sweeps.pop()()
        return opened(*arguments, **options)

    monkeypatch.setattr("os.open", after_a_sweep)
    with private_directory() as directory:
        assert list(tmp_path.iterdir()) == [directory]


def test_what_a_killed_run_left_is_swept_and_what_is_in_use_stays(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    left, draft, foreign = tmp_path / f"{PRIVATE}abcdefgh", tmp_path / ".output.7.new", tmp_path / f"{PRIVATE}mine"
    left.mkdir()
    foreign.mkdir()
    draft.touch()
    (left / "draft-1").symlink_to(draft)
    with private_directory() as used:
        sweep_private_directories()
        assert sorted(tmp_path.iterdir()) == sorted([used, foreign])


def test_a_file_system_without_locks_for_temporary_files_is_one_sentence(monkeypatch, tmp_path):
    def refuse(*_: object) -> None:
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))

    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr("fcntl.flock", refuse)
    with pytest.raises(HolonomError, match="no directory for temporary files can be made: No locks available"):
        private_directory().__enter__()
    assert list(tmp_path.iterdir()) == []
