"""The API that version 1 promises, as `test_api.toml` lists it: entries may be added, none removed or renamed."""

import inspect
import tomllib
from pathlib import Path

import click
import pytest

import holonom
from holonom.cli.group import holonom as commands
from holonom.formats import FORMATS, VERSION

PROMISED = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))


def test_the_package_exports_what_is_promised():
    assert set(PROMISED["exports"]) <= set(holonom.__all__)


def test_scene_has_the_methods_that_are_promised():
    assert set(PROMISED["scene"]) <= set(dir(holonom.Scene))


@pytest.mark.parametrize("name", PROMISED["arguments"])
def test_arguments_are_those_that_are_promised(name):
    owner = holonom if name in holonom.__all__ else holonom.Scene
    function = getattr(owner, name)
    assert set(PROMISED["arguments"][name]) <= set(inspect.signature(function).parameters)


@pytest.mark.parametrize("name", PROMISED["options"])
def test_commands_have_the_options_that_are_promised(name):
    command = commands.get_command(click.Context(commands), name)
    found = {spelt for each in command.params if isinstance(each, click.Option) for spelt in each.opts}
    assert set(PROMISED["options"][name]) <= found


def test_documents_are_those_that_are_promised():
    assert PROMISED["version"] == VERSION
    assert set(PROMISED["documents"]) <= set(FORMATS)
