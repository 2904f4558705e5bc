"""Docstrings of the public API: sections of NumPy style, and examples that print what they show."""

import doctest
import inspect
from pathlib import Path

import pytest

import holonom

METHODS = {f"Scene.{name}": value for name, value in inspect.getmembers(holonom.Scene) if not name.startswith("_")}
PUBLIC = {name: getattr(holonom, name) for name in holonom.__all__} | METHODS
CALLED = {name: value for name, value in PUBLIC.items() if inspect.isfunction(value)}


@pytest.fixture(scope="module")
def scene():
    return holonom.load("examples/pendulum.mac")


@pytest.fixture(autouse=True)
def at_the_root(monkeypatch):
    monkeypatch.chdir(Path(__file__).parents[1])


@pytest.mark.parametrize("name", CALLED)
def test_a_public_function_documents_its_arguments_its_result_and_its_errors(name):
    sections = {"Returns", "Raises"} | ({"Parameters"} if takes_arguments(CALLED[name]) else set())
    text = inspect.getdoc(CALLED[name])
    assert {section for section in sections if f"\n{section}\n{'-' * len(section)}\n" not in text} == set()


@pytest.mark.parametrize("name", PUBLIC)
def test_a_public_summary_is_one_short_line(name):
    summary = inspect.getdoc(PUBLIC[name]).split("\n\n")[0]
    assert len(summary) <= 80
    assert "\n" not in summary


@pytest.mark.parametrize("name", sorted(PUBLIC))
def test_a_public_example_prints_what_it_shows(name, scene):
    text = inspect.getdoc(PUBLIC[name])
    test = doctest.DocTestParser().get_doctest(text, {"scene": scene}, name, None, 0)
    assert test.examples
    assert doctest.DocTestRunner().run(test).failed == 0


def takes_arguments(function):
    return bool(inspect.signature(function).parameters.keys() - {"self", "solve"})
