"""A model as a function of MATLAB, run by GNU Octave: the numbers of the program, NaN where they would be complex."""

import shutil
import subprocess

import numpy as np
import pytest
from exported import PROGRAMS, example, law_of, lift_by_a_table, model_of_program, random_arguments, values_of
from hypothesis import HealthCheck, given, settings
from programs import ENDS, ENDS_POINTS, ENDS_VALUES, assume_well_conditioned, program, random_points, random_programs
from reference import assert_within_bounds, reference

from holonom.failures import ErrorKind, HolonomError
from holonom.program.targets import matlab

OCTAVE = shutil.which("octave-cli") or shutil.which("octave")
by_octave = pytest.mark.skipif(OCTAVE is None, reason="no MATLAB was run: GNU Octave is not installed")


def run(model, directory, commands, **data):
    """Rows of numbers that commands print, with matrices at hand."""
    (directory / "scene_model.m").write_text(matlab.write_model(model, "scene_model"), encoding="utf-8")
    for name, values in data.items():
        np.savetxt(directory / f"{name}.txt", values, fmt="%.17g")
    loads = "".join(f"{name} = load('{name}.txt'); " for name in data)
    script = f"model = scene_model(); {loads}{commands}"
    done = subprocess.run(
        [OCTAVE, "--no-gui", "--quiet", "--norc", "--eval", script],
        cwd=directory, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return [np.array(line.split(), dtype=float) for line in done.stdout.splitlines()]


def called(function, arguments):
    """Commands that print what a function returns, one line a point."""
    given = ", ".join(f"{name}(:, i)" if name != "t" else "t(i)" for name in arguments)
    return f"for i = 1:numel(t), printf('%.17g ', model.{function}({given})); printf('\\n'); end; "


@by_octave
def test_there_is_no_value_where_functions_of_the_time_have_ended(tmp_path):
    t, *p = ENDS_POINTS
    commands = "y = zeros(0, numel(t)); u = y; p = p(:)';  " + called("motion", "tyup")
    assert np.ravel(run(model_of_program(ENDS), tmp_path, commands, t=t, p=p[0])).tolist() == ENDS_VALUES


@by_octave
@pytest.mark.parametrize("scene", ["crane", "lift"])
def test_functions(scene, tmp_path):
    model = example("crane.mac", "m", "c") if scene == "crane" else lift_by_a_table(tmp_path / "lift.mac", "m")
    t, y, u, p = random_arguments(model)
    programs = {name: program_of(model) for name, program_of in PROGRAMS.items() if program_of(model)}
    commands = "".join(called(name, "tyup") for name in programs) + called("law", "tp") + called("rhs", "typ")
    rows = iter(run(model, tmp_path, commands, t=t, y=y, u=u, p=p))
    driven = law_of(model, t, p)
    accelerations = values_of(model.motion, t, y, driven, p)[: len(y) // 2]
    expected = [values_of(each, t, y, u, p) for each in programs.values()]
    for values in (*expected, driven, np.concatenate([y[len(y) // 2 :], accelerations])):
        for column in values.T:
            assert next(rows) == pytest.approx(column, rel=1e-13, abs=1e-13)
    assert next(rows, None) is None


@by_octave
@settings(max_examples=4, suppress_health_check=list(HealthCheck))
@given(random_programs())
def test_random_programs(tmp_path_factory, written):
    assume_well_conditioned(written)
    points = random_points(written)
    rows = run(
        model_of_program(written), tmp_path_factory.mktemp("octave"),
        "y = u = zeros(0, numel(t)); " + called("motion", "tyup"), t=points[:1], p=points[1:],
    )  # fmt: skip
    for point, outputs in zip(points.T, rows, strict=True):
        assert_within_bounds("Octave", reference(written, point.tolist()), outputs)


@by_octave
@pytest.mark.parametrize(
    "tree",
    [["Sqrt", "a"], ["Ln", "a"], ["Arcosh", "a"], ["Power", "a", ["Rational", 1, 3]], ["Arcsin", ["Subtract", "a", 1]]],
    ids=lambda tree: tree[0],
)
def test_what_is_complex_in_matlab_is_no_number(tree, tmp_path):
    written = program(["t", "a"], [("w", tree), ("x", ["Multiply", "w", "w"])], {"x": "x"})
    rows = run(model_of_program(written), tmp_path, "printf('%g\\n', model.motion(0, [], [], -2));")
    assert np.isnan(rows[0])


@by_octave
def test_names_cannot_end_what_they_stand_in(tmp_path):
    written = program(["t", "a'; error(1); %\\"], [("w", ["Negate", "a'; error(1); %\\"])], {"'": "w"})
    rows = run(model_of_program(written), tmp_path, "printf('%s\\n', num2str(double(model.parameters{1})));")
    assert "".join(chr(int(code)) for code in rows[0]) == "a'; error(1); %\\"


def test_what_cannot_name_a_function_is_refused():
    written = program(["t"], [], {"w": "t"})
    with pytest.raises(HolonomError) as caught:
        matlab.write_model(model_of_program(written), "my motion")
    assert caught.value.kind is ErrorKind.NOT_AN_IDENTIFIER


@pytest.mark.parametrize("name", ["exp", "motion", "end"])
def test_a_function_named_as_one_that_it_calls_called_itself(name):
    written = program(["t"], [("w", ["Exp", "t"])], {"w": "w"})
    with pytest.raises(HolonomError) as caught:
        matlab.write_model(model_of_program(written), name)
    assert caught.value.kind is ErrorKind.NAME_TAKEN
