"""Languages of motion programs are the modules of a folder."""

import pytest
from exported import POINTS, lift_by_a_table
from particle import PARTICLE
from programs import program

from holonom.program import targets
from holonom.program.forms import MotionProgram
from holonom.program.request import Request
from holonom.program.targets import FORMS, target
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


def test_names_are_themselves_in_python():
    """Those of more than 16 bits were two halves, which cannot be printed."""
    names = ["t", "𝜃", "θ", "*/", "\\'\"\n"]
    module: dict = {}
    exec(target("python").write(program(names, [], dict(zip(names, names, strict=True)))), module)
    assert module["INPUTS"] == module["OUTPUTS"] == tuple(names)


@pytest.mark.parametrize("name", ["c", "matlab", "python_numpy", "python_jax"])
def test_the_last_time_of_a_table_is_in_the_code_and_in_its_programs(name, tmp_path):
    model = lift_by_a_table(tmp_path / "lift.mac")
    assert {tuple(map(float, each.law_span)) for each in (model, model.law, model.motion)} == {
        (POINTS[0][0], POINTS[-1][0])
    }
    written = target(name).write_model(model, "lift")
    assert f"from t = {POINTS[0][0]:.10g} to {POINTS[-1][0]:.10g}" in (
        written if isinstance(written, str) else written["lift.h"]
    )


@pytest.mark.parametrize("name", ["javascript", "python"])
@pytest.mark.parametrize(("force", "ends"), [("bessel_j(0, t)", True), ("bessel_j(0, 1)", False)])
def test_the_last_time_of_a_special_function_was_not_in_code_of_the_motion(name, force, ends, write_scene):
    scene = write_scene(f"""load("holonom.mac")$
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [{force}])$
scene : holonomic_scene(system, initial_state = [x = 0, dot(x) = 0], time_span = [0, 7/2])$""")
    assert ("from t = 0 to 3.5" in MotionProgram(scene, Request(None), Limits()).written(name)) is ends
