"""Languages of motion programs are the modules of a folder."""

from particle import PARTICLE

from holonom.program import targets
from holonom.program.forms import MotionProgram
from holonom.program.request import Request
from holonom.program.targets import FORMS
from holonom.program.templates import filled, template
from holonom.sandbox import Limits

TOY = '''
"""A program as a list of its outputs' names."""

def write(program):
    return " ".join(program.outputs)
'''


def test_a_module_more_is_a_language_more(tmp_path, monkeypatch, write_scene):
    (tmp_path / "toy.py").write_text(TOY, encoding="utf-8")
    monkeypatch.setattr(targets, "__path__", [*targets.__path__, str(tmp_path)])
    scene = write_scene(PARTICLE)
    taken = MotionProgram(scene, Request(None), Limits())
    assert taken.written("toy").split() == list(taken.outputs)


def test_the_forms_are_json_and_the_modules():
    assert FORMS == ("json", "c", "fmu", "javascript", "matlab", "python")
    assert all(
        hasattr(targets.target(name), "write") != hasattr(targets.target(name), "write_model") for name in FORMS[1:]
    )


def test_places_of_a_template_are_filled_and_nothing_else():
    assert "@{" in template("library.h")
    assert "@" not in filled("CMakeLists.txt", name="crane")
    assert "${CMAKE_CURRENT_SOURCE_DIR}" in filled("CMakeLists.txt", name="crane")
