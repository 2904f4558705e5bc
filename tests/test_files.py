"""Files that appear whole or not at all."""

import os
from pathlib import Path

import pytest

from holonom.failures import Failure, HolonomError
from holonom.files import write_whole


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
