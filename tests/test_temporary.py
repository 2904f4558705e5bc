"""Private directories for temporary files."""

import errno
import os

import pytest

from holonom.failures import ErrorKind, HolonomError
from holonom.temporary import PREFIX, private_directory, remove_abandoned_directories, remove_tree


def test_private_directory_is_removed_with_closed_folders():
    with private_directory() as directory:
        (directory / "closed" / "within").mkdir(parents=True)
        (directory / "closed" / "within" / "file").touch()
        (directory / "closed" / "within").chmod(0)
        (directory / "closed").chmod(0)
    assert not directory.exists()


def test_remove_tree_follows_no_link(tmp_path):
    victim, tree = tmp_path / "victim", tmp_path / "tree"
    victim.mkdir()
    (victim / "file").touch()
    victim.chmod(0o750)
    tree.mkdir()
    for name in ("draft-1", "link"):
        (tree / name).symlink_to(victim)
    (tree / "below").mkdir()
    (tree / "below" / "link").symlink_to(victim)
    (tree / "below" / "relative").symlink_to("../../victim")
    remove_tree(tree)
    assert not tree.exists()
    assert (victim / "file").exists()
    assert victim.stat().st_mode & 0o777 == 0o750


def test_remove_tree_of_a_link_leaves_its_target(tmp_path):
    (tmp_path / "victim").mkdir()
    (tmp_path / "victim" / "file").touch()
    (tmp_path / "link").symlink_to(tmp_path / "victim")
    remove_tree(tmp_path / "link")
    assert (tmp_path / "victim" / "file").exists()


def test_remove_tree_has_no_limit_of_depth(tmp_path):
    (tmp_path / "tree").mkdir()
    here = os.open(tmp_path / "tree", os.O_RDONLY)
    for _ in range(3000):
        os.mkdir("deeper", dir_fd=here)
        deeper = os.open("deeper", os.O_RDONLY, dir_fd=here)
        os.close(here)
        here = deeper
    os.close(here)
    remove_tree(tmp_path / "tree")
    assert os.listdir(tmp_path) == []


def test_directory_removed_before_it_is_locked_is_made_again(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    opened, sweeps = os.open, [remove_abandoned_directories]

    def after_a_sweep(*arguments, **options):
        if sweeps:
            sweeps.pop()()
        return opened(*arguments, **options)

    monkeypatch.setattr("os.open", after_a_sweep)
    with private_directory() as directory:
        assert list(tmp_path.iterdir()) == [directory]


def test_abandoned_directories_are_removed_and_used_ones_stay(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    (tmp_path / f"{PREFIX}abcdefgh").mkdir()
    victim, link, foreign, file = (
        tmp_path / name for name in ("victim", f"{PREFIX}ijklmnop", f"{PREFIX}x", f"{PREFIX}12345678")
    )
    victim.mkdir()
    link.symlink_to(victim)
    foreign.mkdir()
    file.touch()
    with private_directory() as used:
        remove_abandoned_directories()
        assert sorted(tmp_path.iterdir()) == sorted([used, victim, link, foreign, file])


def test_file_system_without_locks_is_refused(monkeypatch, tmp_path):
    def refuse(*_: object) -> None:
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))

    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr("fcntl.flock", refuse)
    with pytest.raises(HolonomError) as raised:
        private_directory().__enter__()
    assert raised.value.kind is ErrorKind.NO_PRIVATE_DIRECTORY
    assert list(tmp_path.iterdir()) == []
