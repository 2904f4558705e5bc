"""`holonom program`: what is asked of Maxima, and what comes back."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner
from programs import random_points
from reference import IllConditioned, reference
from refusing import failing
from test_same_numbers import assert_same_numbers

from holonom.cli import holonom
from holonom.failures import ErrorKind, HolonomError
from holonom.program.forms import MotionProgram
from holonom.program.motion_program import Program, read_program
from holonom.program.request import Request, Solve, read_settings
from holonom.sandbox import Limits

EXAMPLES = Path(__file__).parents[2] / "examples"
SCENES = {
    "pendulum": "pendulum.mac",
    "bead": "bead.mac",
    "weightless cabin": "weightless_cabin.mac",
    "paper": "paper/paper.mac",
    "chain": "chain.mac",
    "linkage": "linkage.mac",
    "squeezer": "andrews.mac",
}


def motion_program(file: str, **request) -> MotionProgram:
    return MotionProgram(EXAMPLES / file, Request(**request), Limits())


@pytest.fixture(scope="module", params=[(name, solve) for name in SCENES for solve in Solve], ids=" ".join)
def asked(request: pytest.FixtureRequest) -> MotionProgram:
    name, solve = request.param
    return motion_program(SCENES[name], solve=solve)


@pytest.fixture(scope="module")
def written(asked: MotionProgram) -> Program:
    return asked.program


def test_operations_are_what_an_independent_count_finds(asked):
    assert json.loads(asked.document)["operations"] == asked.program.operations


def test_every_form_gives_the_same_numbers(written):
    try:
        for point in random_points(written).T:
            reference(written, point.tolist())
    except IllConditioned:
        pytest.skip("its pivots nearly vanish at a random point")
    assert_same_numbers(written)


def test_settings_reach_the_scene_file():
    assert "ddot(y5)" in motion_program("chain.mac", settings={"N": "5"}).program.outputs


def test_the_command_writes_json_by_default():
    result = CliRunner(mix_stderr=False).invoke(holonom, ["program", str(EXAMPLES / "chain.mac"), "--set", "N=2"])
    document = json.loads(result.stdout)
    assert document["operations"] == read_program(result.stdout).operations
    assert document["inputs"][0] == "t"


def test_the_command_writes_python(tmp_path):
    file = tmp_path / "motion.py"
    CliRunner().invoke(holonom, ["program", str(EXAMPLES / "pendulum.mac"), "--to", "python", "-o", str(file)])
    assert "def motion(values" in file.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "text", ["N", "N=", "=4", "N=quit()", "N=1;2", "a b=1", "N=4]$ system(1)$ [", "N=1/2/3", "N=1/0"]
)
def test_a_setting_that_is_no_number_is_refused(text):
    with failing(ErrorKind.NOT_A_SETTING):
        read_settings([text])


@pytest.mark.parametrize(
    ("text", "value"), [("N=64", "64"), ("g=9.81", "9.81"), ("u0=-3/10", "-3/10"), ("e=1e-3", "1e-3")]
)
def test_numbers_of_every_kind_can_be_set(text, value):
    assert list(read_settings([text]).values()) == [value]


@pytest.mark.parametrize(
    ("request_", "failure", "refusal"),
    [
        ({"settings": {"M": "4"}}, ErrorKind.REFUSED, "unused_setting"),
        ({"scene": "no_such_scene"}, ErrorKind.REFUSED, "unknown_scene"),
        ({"scene": "f()$"}, ErrorKind.NOT_A_SCENE_NAME, None),
    ],
)
def test_what_the_scene_file_does_not_have_is_refused_where_it_stands(request_, failure, refusal):
    with pytest.raises(HolonomError) as caught:
        motion_program("chain.mac", **request_).written("json")
    assert (caught.value.kind, caught.value.refusal) == (failure, refusal)
    assert "\n" not in str(caught.value)
    assert caught.value.place in ("", str(EXAMPLES / "chain.mac"))
