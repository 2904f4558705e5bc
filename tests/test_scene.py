"""High-level API: one object for all that a scene can be asked."""

import copy
import gc
import pickle
import re
import subprocess
import sys
import zipfile
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import scipy.integrate
import sympy
from refusing import failing, refused

import holonom
from holonom.crosscheck.report import Verdict
from holonom.failures import ErrorKind, HolonomError

EXAMPLES = Path(__file__).parents[1] / "examples"
OSCILLATOR = """
oscillator : holonomic_system(
  coordinates      = [x],
  parameters       = [m, k],
  kinetic_energy   = m*dot(x)^2/2,
  potential_energy = k*x^2/2,
  constraints      = [])$
released : holonomic_scene(oscillator,
  parameter_values = [m = 1, k = 4],
  initial_state    = [x = 1, dot(x) = 0],
  time_span        = [0, 3])$
pushed : holonomic_scene(oscillator,
  parameter_values = [m = 1, k = 4],
  initial_state    = [x = 0, dot(x) = 2],
  time_span        = [0, 3])$
"""


@pytest.fixture(scope="module")
def pendulum() -> holonom.Scene:
    return holonom.load(EXAMPLES / "pendulum.mac", scene="lengthening_scene")


@pytest.fixture(scope="module")
def released() -> holonom.Scene:
    return holonom.system(OSCILLATOR, scene="released")


def run_python(code: str) -> str:
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout


def test_importing_the_package_imports_and_changes_nothing():
    code = """
import os, sys
before, environment = set(sys.modules), dict(os.environ)
import holonom
print({"numpy", "sympy", "click", "heyoka"} & (set(sys.modules) - before))
print(os.environ == environment)
"""
    assert run_python(code).split() == ["set()", "True"]


def test_heyoka_still_takes_sympy_after_a_simulation():
    code = f"""
import holonom
holonom.load({str(EXAMPLES / "pendulum.mac")!r}).simulate(until=1, samples=2)
import heyoka, sympy
print(heyoka.from_sympy(sympy.Symbol("x") + 1))
"""
    assert "x" in run_python(code)


def test_simulating_leaves_blas_its_threads(released):
    from threadpoolctl import ThreadpoolController, threadpool_limits

    blas = ThreadpoolController().select(user_api="blas")
    with threadpool_limits(2, "blas"):
        released.simulate(samples=2)
        assert {pool["num_threads"] for pool in blas.info()} == {2}


def test_all_public_names_are_there():
    assert set(holonom.__all__) <= set(dir(holonom))
    assert all(getattr(holonom, name) for name in holonom.__all__)
    with pytest.raises(AttributeError, match="nothing"):
        _ = holonom.nothing


def test_equations_are_found_by_number_and_by_id(pendulum):
    assert len(pendulum.equations["8"]) == 2
    [multipliers] = pendulum.equations["multipliers"]
    assert multipliers in list(pendulum.equations)
    with pytest.raises(KeyError, match="multipliers"):
        pendulum.equations["multiplicators"]


def test_the_multiplier_is_the_closed_form(pendulum):
    m, g, x, y, vx, vy, u, du, ddu = (
        pendulum.symbols[name] for name in ["m", "g", "x", "y", "dot(x)", "dot(y)", "u", "dot(u)", "ddot(u)"]
    )
    expected = m * (g * y + u * ddu + du**2 - vx**2 - vy**2) / (2 * (x**2 + y**2))
    assert sympy.simplify(pendulum.equations.solved_for("lambda1") - expected) == 0


def test_an_acceleration_is_that_of_eq_11(pendulum):
    found = pendulum.equations.solved_for("ddot(x)")
    assert found == pendulum.equations["11"].solved_for("ddot(x)")
    assert "lambda1" not in map(str, found.free_symbols)
    assert "lambda1" in map(str, pendulum.equations["4"].solved_for("ddot(x)").free_symbols)


def test_symbols_print_as_dotted_letters(pendulum):
    rate = pendulum.symbols["dot(x)"]
    assert sympy.latex(rate + 1) == r"\dot{x} + 1"
    assert sympy.pretty(rate) == sympy.pretty(sympy.Symbol("xdot"))
    assert str(rate) == "dot(x)"
    assert rate.is_real


def test_a_notebook_shows_typeset_equations(pendulum):
    equations = pendulum.equations["multipliers"]
    assert r"\lambda_{1} = \frac" in equations._repr_latex_()
    assert '<math xmlns="http://www.w3.org/1998/Math/MathML"' in equations._repr_html_()
    assert pendulum._repr_html_() == pendulum.equations._repr_html_()


def test_without_latex2mathml_a_notebook_takes_the_latex(pendulum, monkeypatch):
    monkeypatch.setitem(sys.modules, "latex2mathml.converter", None)
    assert pendulum.equations["multipliers"]._repr_html_() is None


def test_check_and_free_answer_what_the_commands_answer(pendulum):
    assert pendulum.check().disagreements == 0
    assert "proved" in pendulum.check()._repr_html_()
    assert pendulum.free().scene == "lengthening_scene"
    assert "condition of free motion" in pendulum.free()._repr_html_()
    assert pendulum.free().condition is not None


def test_load_limits_closed_forms_of_all_results():
    scene = holonom.load("examples/pendulum.mac", closed_form_size=2)
    assert scene.record.derivations[0].left_out.limit == 2
    assert not {"4", "5", "8", "9", "10", "11"} & {each.number for each in scene.equations}
    report = scene.check()
    assert report.disagreements == 0
    assert report.count(Verdict.LEFT_OUT) > 6
    assert scene.free().condition is None
    assert scene.with_settings(closed_form_size=500).free().condition is not None


def test_results_print_as_the_command_line_prints_them(pendulum, released):
    printed = repr(pendulum.check())
    assert "multipliers" in printed
    assert "no disagreements" in printed
    assert "condition of free motion" in str(pendulum.free())
    assert "energy error" in repr(released.simulate(until=1, samples=2))
    assert "\x1b[" not in printed


def test_effects_names_gravity(pendulum):
    costs = pendulum.effects()
    assert "gravity" in {effect.name for effect in costs.effects}
    assert "gravity" in costs._repr_html_()


def test_the_series_of_the_oscillator_is_the_cosine(released):
    found = released.series(order=8).coordinates["x"]
    assert [Fraction(c) for c in found] == [Fraction(c) for c in (1, 0, -2, 0, "2/3", 0, "-4/45", 0, "2/315")]
    assert "order" in released.series(order=2)._repr_html_()


def test_the_motion_of_the_oscillator_is_the_cosine(released):
    motion = released.simulate(until=3, samples=31)
    assert motion["x"] == pytest.approx(np.cos(2 * motion["t"]), abs=1e-13)
    assert motion.to_pandas()["x"].iloc[-1] == motion["x"][-1]
    assert motion.keys() == ("t", *motion.to_pandas())
    assert "energy error" in motion._repr_html_()
    with pytest.raises(KeyError, match="t, x"):
        motion["y"]


def test_a_parameter_takes_the_place_of_the_scenes(released):
    assert released.simulate(until=1, samples=2, k=9)["x"][-1] == pytest.approx(np.cos(3), abs=1e-13)
    assert released.simulate(until=1, samples=2, k=2.25)["x"][-1] == pytest.approx(np.cos(1.5), abs=1e-13)
    assert released.with_settings({"m": 4}).simulate(until=1, samples=2)["x"][-1] == pytest.approx(np.cos(1), abs=1e-13)


def test_a_scene_is_chosen_by_its_name_and_the_last_one_without():
    assert holonom.system(OSCILLATOR).simulate(until=1, samples=2)["x"][-1] == pytest.approx(np.sin(2), abs=1e-13)
    with refused("unknown_scene"):
        holonom.system(OSCILLATOR, scene="nowhere").simulate()
    with failing(ErrorKind.NO_SUCH_SCENE, "nowhere"):
        _ = holonom.system(OSCILLATOR, scene="nowhere").equations


def test_a_scene_that_prescribes_reactions_has_the_equations_of_the_described_system():
    last, first = (holonom.load(EXAMPLES / "prescribed_tension.mac", scene=name) for name in (None, "thrown_scene"))
    assert {"2", "8", "11"} <= {equation.number for equation in last.equations}
    assert list(last.equations.titles()) == list(first.equations.titles())
    with failing(ErrorKind.NO_SUCH_SCENE, "thrown_scene, steady_scene, growing_scene"):
        _ = holonom.load(EXAMPLES / "prescribed_tension.mac", scene="thrown").equations


def test_settings_reach_the_file():
    chain = holonom.load(EXAMPLES / "chain.mac", N=3)
    assert "ddot(y3)" in chain.program().outputs


@pytest.mark.parametrize("value", ["quit()", float("inf"), "1 + 1"])
def test_a_setting_that_is_no_number_is_refused(value):
    with failing(ErrorKind.NOT_A_SETTING, f"k={value}"):
        holonom.system(OSCILLATOR, k=value)


@pytest.mark.parametrize("choice", [{"engine": "warp"}, {"stabilization": "tape"}, {"solve": "guess"}])
def test_what_is_no_choice_is_reported_the_choices(released, choice):
    with failing(ErrorKind.NOT_A_CHOICE, *choice.values()):
        released.simulate(**choice)


@pytest.mark.parametrize("until", ["noon", float("nan"), "1/0"])
def test_an_end_that_is_no_time_is_refused(released, until):
    with failing(ErrorKind.NOT_A_TIME, str(until)):
        released.simulate(until=until)


def test_a_single_sample_is_refused(released):
    with failing(ErrorKind.NOT_IN_RANGE, "1"):
        released.simulate(samples=1)


def test_more_samples_than_memory_are_refused_at_once(released):
    with failing(ErrorKind.TOO_MANY_SAMPLES):
        released.simulate(samples=10**10)


def test_a_missing_file_is_refused_at_once():
    with failing(ErrorKind.FILE_MISSING):
        holonom.load("nowhere.mac")


def test_an_example_that_travels_with_the_package_is_found_from_anywhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert holonom.load("examples/pendulum.mac").file.read_text().startswith("/*")
    (tmp_path / "examples").mkdir()
    own = Path("examples", "pendulum.mac")
    own.write_text("mine : 1$")
    assert holonom.load(own).file == own
    with failing(ErrorKind.FILE_MISSING):
        holonom.load("examples/none.mac")


def test_the_right_hand_side_serves_another_integrator(pendulum):
    f = pendulum.rhs()
    assert f.names == ("x", "y", "dot(x)", "dot(y)")
    found = scipy.integrate.solve_ivp(f, (f.t0, 2), f.y0, method="DOP853", rtol=1e-12, atol=1e-12)
    motion = pendulum.simulate(until=2, samples=2)
    assert found.y[0, -1] == pytest.approx(motion["x"][-1], abs=1e-8)
    assert f(0.0, np.stack([f.y0, f.y0], axis=1))[:, 1] == pytest.approx(f(0.0, f.y0), rel=1e-15)
    for other in (f.y0[1:], [*f.y0, 0.0], 1.0):
        with pytest.raises(ValueError, match="needed"):
            f(0.0, other)


def test_redundant_constraints_have_the_right_hand_side_of_the_independent_ones():
    f = holonom.system("""
        twice : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
                                 forces = [push = [1, 0]], constraints = [x - y, (x - y)*(1 + x^2)])$
        slide : holonomic_scene(twice, initial_state = [x = 0, dot(x) = 1])$""").rhs()
    assert f(0.0, [0.0, 0.0, 1.0, 1.0]) == pytest.approx([1, 1, 1 / 2, 1 / 2], abs=1e-15)


def test_every_form_of_the_program_gives_the_same_numbers(pendulum, tmp_path):
    program = pendulum.program(solve="orthogonal")
    point = np.random.default_rng(3).uniform(1, 2, size=len(program.inputs))
    module = {}
    exec(program.to_python(), module)
    assert program.compile()(point) == pytest.approx(program.lambdify()(point), rel=1e-12)
    assert module["motion"](point.tolist()) == pytest.approx(program.lambdify()(point), rel=1e-12)
    program.to_c(tmp_path / "crane", name="crane", parameters=["m"])
    assert {file.name for file in (tmp_path / "crane").iterdir()} >= {"crane.c", "crane.h", "CMakeLists.txt"}


def test_a_program_s_forms_are_those_of_the_targets(pendulum, tmp_path):
    program = pendulum.program()
    assert program.to_matlab(["m"], "swing") == program.written("matlab", "swing", ["m"])
    assert "swing" in program.to_matlab(name="swing")
    assert program.to_javascript() == program.written("javascript")
    assert len({program.to_python(), program.to_matlab(), program.to_javascript(), program.document}) == 4
    program.to_fmu(tmp_path / "swing.fmu", name="swing", parameters=["m"])
    with zipfile.ZipFile(tmp_path / "swing.fmu") as unit:
        assert {"modelDescription.xml", "sources/swing.c"} & set(unit.namelist())
    assert [str(n) for n in (len(program.inputs), len(program.outputs), program.operations)] == re.findall(
        r"\d+", repr(program)
    )
    assert program.operations == program.program.operations > 0


def test_a_motion_is_drawn_for_notebooks_and_files(pendulum, tmp_path):
    picture = pendulum.simulate(until=1, samples=11).plot()
    assert picture._repr_svg_().startswith("<?xml")
    pendulum.simulate(until=1, samples=5).plot("dot(x)").save(tmp_path / "velocity.svg")
    assert "dot(y)" not in (tmp_path / "velocity.svg").read_text()
    picture.save(tmp_path / "motion.png")
    assert (tmp_path / "motion.png").read_bytes().startswith(b"\x89PNG")


def test_the_text_of_a_system_is_removed_with_its_last_scene():
    scene = holonom.system(OSCILLATOR)
    file, other = scene.file, scene.with_settings(k=9)
    del scene
    assert file.exists()
    del other
    gc.collect()
    assert not file.exists()


def test_a_program_reads_the_text_of_its_system_without_the_scene():
    program = holonom.system(OSCILLATOR).program()
    assert program.inputs[0] == "t"


def test_a_copy_of_a_scene_reads_the_text_of_its_system_too():
    scene = holonom.system(OSCILLATOR)
    other = copy.deepcopy(scene)
    del scene
    gc.collect()
    assert other.system.coordinates == ("x",)


def test_a_scene_is_pickled_with_its_results(released):
    released.linearize(), released.simulate(samples=2), released.dae()
    other = pickle.loads(pickle.dumps(released))
    assert other.simulate(samples=2)["x"].tolist() == released.simulate(samples=2)["x"].tolist()
    assert other.linearize().A.tolist() == released.linearize().A.tolist()


def test_settings_of_a_scene_do_not_change(released):
    released.settings["k"] = "9"
    assert released.settings == {}


def test_results_with_arrays_are_compared_and_stored_in_sets(released):
    for result in (released.simulate(samples=2), released.linearize(), *released.equilibria()):
        assert result == result
        assert result != copy.copy(result)
        assert len({result, result}) == 1


def test_results_of_two_texts_were_mixed(tmp_path):
    file = tmp_path / "scene.mac"
    file.write_text(f'load("holonom.mac")$ {OSCILLATOR}')
    scene = holonom.load(file)
    assert scene.system.parameters == ("m", "k")
    file.write_text(f'load("holonom.mac")$ {OSCILLATOR.replace("k*x^2/2", "k*x^4/4")}')
    with failing(ErrorKind.FILE_CHANGED):
        scene.with_settings(k=9).system  # noqa: B018


def test_a_scene_stays_in_its_folder(tmp_path, monkeypatch):
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "scene.mac").write_text(f'load("holonom.mac")$ {OSCILLATOR}')
    monkeypatch.chdir(tmp_path)
    scene = holonom.load("scene.mac")
    monkeypatch.chdir("elsewhere")
    assert scene.system.coordinates == ("x",)


def test_samples_beyond_double_precision_are_a_table(released):
    table = released.simulate(until=1, samples=2, precision="quadruple").to_pandas()
    assert table["x"].astype(float).iloc[-1] == pytest.approx(np.cos(2))


def test_in_python_advice_names_arguments_and_no_options(released):
    with failing(ErrorKind.NOT_AFTER_START) as early:
        released.simulate(until=-1)
    with failing(ErrorKind.TOO_LONG) as late:
        holonom.load(released.file, limits=holonom.Limits(seconds=1e-3)).free()
    for error, argument, option in ((early, "until", "--until"), (late, "limits", "--time-limit")):
        assert argument in str(error.value).split()[-1]
        assert option in error.value.message()
        assert option not in str(error.value)


@pytest.mark.parametrize("asked", ["simulate", "effects", "program().lambdify"])
def test_without_numpy_a_scene_says_which_extra_brings_it(asked, released):
    hidden = f"import sys; sys.modules['numpy'] = None; import holonom; holonom.load({str(released.file)!r}).{asked}()"
    done = subprocess.run([sys.executable, "-c", hidden], capture_output=True, text=True)
    told = HolonomError(ErrorKind.EXTRA_MISSING, package="numpy", named="holonom[motion]")
    assert f"HolonomError: {told.reason}" in done.stderr
    assert "holonom[motion]" in done.stderr
