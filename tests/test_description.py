"""Descriptions: all that a scene file says, as a document from which the same follows."""

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from refusing import refused

import holonom
from holonom import source
from holonom.description import Description, read_description
from holonom.documents import ask
from holonom.failures import ErrorKind, HolonomError
from holonom.formats import Document, read
from holonom.record import Record
from holonom.source import Source, describe

EXAMPLES = Path(__file__).parents[1] / "examples"
FILES = sorted(file for file in EXAMPLES.rglob("*.mac") if file.name not in ("printed.mac", "by_hand.mac"))
SHORT = {"arm", "hoist", "paper"}
SWITCHED = """
load("holonom.mac")$
assume(m > 0)$ declare(n, integer)$ closed_form_size : 77$
system : holonomic_system(title = "Switched \\"on\\" \\\\ off", coordinates = [x, y], controls = [u, w],
  parameters = [m, k], kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2,
  potential_energy = [stop = k*max(x, 0)^2/2, weight = 981/100*m*y],
  forces = [drag = [-erf(dot(x)), 0], push = [w, 0]], constraints = [y - u*x], drawing = [circle([x, y], 1/10)])$
run : holonomic_scene(system, effects = [push], control_law = [u = 1 + table([[0, 0], [1, 0.1], [2, 1/3]], clamped),
    w = a*if t < 1/2 then unit_step(t - 1/4) elseif t <= 1 or t > 1.5 then min(t, 1) else 12345678901234567890],
  parameter_values = [m = 1, k = setting('stiff, 2.5), a = 3], initial_state = [x = 0.1, dot(x) = sqrt(2)],
  initial_guess = [y = 0.1], time_span = [0, 1.75], until = [x - 2], observe = [trajectory, energy])$
"""


RELEASED = """
load("holonom.mac")$
a : particle(1, [x1, y1])$  b : particle(3, [x2, y2])$
rod : distance_joint(a, b, 4)$
system : holonomic_system(parameters = [c], assembly(a, b, rod))$
run : holonomic_scene(system, parameter_values = [c = 1], time_span = [0, 3], released = [rod = t - c],
  initial_state = [x1 = 3, y1 = 0, x2 = -1, y2 = 0, dot(x1) = 1, dot(y1) = 6, dot(x2) = 1, dot(y2) = -2])$
"""


def test_releases_are_described(write_scene, holonom_here):
    assert "lambda1 at -c + t = 0" in holonom_here("describe", write_scene(RELEASED)).stdout


@pytest.fixture(scope="module")
def switched(tmp_path_factory) -> Description:
    file = tmp_path_factory.mktemp("switched") / "scene.mac"
    file.write_text(SWITCHED, encoding="utf-8")
    return describe(file)


def described_anew(description: Description, folder: Path) -> Description:
    """What a Maxima describes that saw the description alone."""
    return read_description(ask(Document.DESCRIPTION, written(description, folder)), description.file)


def written(description: Description, folder: Path) -> Path:
    file = folder / "description.json"
    file.write_text(json.dumps(description.content, indent=1), encoding="utf-8")
    return file


@pytest.mark.parametrize(
    "file",
    [pytest.param(file, id=file.stem, marks=[] if file.stem in SHORT else [pytest.mark.long]) for file in FILES],
)
def test_a_description_describes_the_same_again(file, tmp_path):
    description = describe(file)
    assert described_anew(description, tmp_path).content == description.content


def test_conditions_tables_and_exact_numbers_are_described_again(switched, tmp_path):
    assert described_anew(switched, tmp_path).content == switched.content


def test_a_description_holds_what_its_file_says(switched):
    (run,) = switched.scenes
    assert switched.closed_form_size == 77
    assert switched.system.title == 'Switched "on" \\ off'
    assert run.title == "run"  # it has none of its own
    assert switched.content["assumptions"] == [["Greater", "m", 0]]
    assert switched.content["declarations"] == [["n", "integer"]]
    assert [effect.effect for effect in switched.system.potential_energy] == ["stop", "weight"]
    assert switched.system.velocities == ("dot(x)", "dot(y)")
    assert switched.system.multipliers == ("lambda1",)
    assert run.effects == ("kinetic_energy", "push")
    assert run.parameter_values.trees == {"m": 1, "k": ["Rational", 5, 2], "a": 3}
    assert run.initial_state.trees == {"x": ["Rational", 1, 10], "dot(x)": ["Sqrt", 2]}
    assert run.initial_guess.trees == {"y": ["Rational", 1, 10]}
    assert run.span_trees == (0, ["Rational", 7, 4])
    assert run.observe == ("trajectory", "energy")
    assert switched.tables[0].points[1] == (1, ["Rational", 1, 10])
    assert switched.tables[0].ends == (0, 0)
    assert run.control_law.trees["u"] == ["Add", 1, ["Table", 0, "t"]]


@pytest.mark.parametrize("name", ["θ", "x̂", "长度", "%a_b"])
def test_names_may_be_in_any_writing(name, write_scene):
    scene = write_scene(f"""load("holonom.mac")$
system : holonomic_system(coordinates = [{name}], kinetic_energy = dot({name})^2/2)$""")
    assert [str(each) for each in describe(scene).content["system"]["coordinates"]] == [name]


def test_a_scene_file_runs_once_for_all_questions(write_scene, monkeypatch):
    runs = []
    run_scene = source.run_scene
    monkeypatch.setattr(source, "run_scene", lambda *arguments: runs.append(arguments) or run_scene(*arguments))
    text = (EXAMPLES / "pendulum.mac").read_text(encoding="utf-8")
    scene = holonom.load(write_scene(text))
    scene.equations, scene.check(), scene.free(), scene.series(4), scene.program().program
    assert scene.simulate(until=Fraction(1, 10)).report is not None
    assert scene.system.coordinates == scene.record.system.coordinates
    assert len(runs) == 1
    scene.with_settings(m=2).program().program  # noqa: B018
    assert len(runs) == 2


@pytest.mark.parametrize(
    "command",
    [("derive",), ("program",), ("free",), ("series", "--order", "4"), ("simulate", "--until", "1/10", "--final")],
    ids=" ".join,
)
def test_commands_take_a_description_where_they_take_a_scene(command, tmp_path, holonom_here):
    scene, description = EXAMPLES / "pendulum.mac", tmp_path / "pendulum.json"
    assert holonom_here("describe", scene, "--json", description).returncode == 0
    first, second = (holonom_here(command[0], file, *command[1:], "--json", "-") for file in (scene, description))
    if command == ("program",):
        first, second = (holonom_here("program", file) for file in (scene, description))
    assert first.returncode == second.returncode == 0
    assert without_times(json.loads(first.stdout)) == without_times(json.loads(second.stdout))


def without_times(content: dict) -> dict:
    return {name: value for name, value in content.items() if "seconds" not in name and name != "scene"}


def test_settings_are_put_into_a_description(tmp_path):
    file = EXAMPLES / "pendulum.mac"
    set_later = describe(written(describe(file), tmp_path), {"m": "3/4"})
    set_first = describe(file, {"m": "3/4"})
    assert set_later.content == set_first.content
    assert set_later.scenes[0].parameter_values.trees["m"] == ["Rational", 3, 4]


def test_a_description_is_set_nothing_that_is_no_parameter(tmp_path):
    with pytest.raises(HolonomError) as raised:
        describe(written(describe(EXAMPLES / "chain.mac"), tmp_path), {"N": "4"})
    assert raised.value.kind is ErrorKind.NOT_SETTABLE


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("system", "constraints", 0), ["System", "rm"]),
        (("system", "constraints", 0), ["Add", "x;quit()", 1]),
        (("system", "constraints", 0), 0.5),
        (("system", "constraints", 0), ["\ud800", "x"]),
        (("system", "constraints", 0), {"num": "1e99999"}),
        (("scenes", 0, "name"), "a b"),
        (("closed_form_size",), 0),
        (("surprise",), 1),
    ],
)
def test_what_is_no_description_is_refused(path, value, switched):
    content = json.loads(switched.text)
    part = content
    for step in path[:-1]:
        part = part[step]
    part[path[-1]] = value
    with pytest.raises(HolonomError) as raised:
        read_description(json.dumps(content), switched.file)
    assert raised.value.kind is ErrorKind.NOT_A_DOCUMENT


@pytest.mark.parametrize("tree", [["Which", "t", 1], ["Table", 7, "t"], ["Rational", 1, 0], ["Sin", 1, 2]])
def test_what_maxima_cannot_make_of_a_description_is_refused(tree, switched, tmp_path):
    content = json.loads(switched.text)
    content["scenes"][0]["control_law"]["w"] = tree
    with pytest.raises(HolonomError):
        ask(Document.RECORD, written(replace(switched, content=content), tmp_path))


def test_only_what_is_used_is_set(write_scene):
    with refused("unused_setting"):
        describe(write_scene(SWITCHED), {"stif": "1"})
    with pytest.raises(HolonomError, match="'verdict_order'"):  # a variable of the library
        describe(write_scene(SWITCHED), {"verdict_order": "7"})
    assert describe(write_scene(SWITCHED), {"stiff": "7"}).scenes[0].parameter_values.trees["k"] == 7


def test_the_size_of_closed_forms_is_a_setting_of_every_file(write_scene, tmp_path):
    described = describe(write_scene(SWITCHED), {"closed_form_size": "7"})
    assert described.closed_form_size == 7
    document = written(described, tmp_path)
    assert describe(document, {"closed_form_size": "9"}).closed_form_size == 9
    assert json.loads(ask(Document.RECORD, document, settings={"closed_form_size": "1"}))["derivations"][0]["left_out"]
    for size in ("0", "-1", "3/2"):
        with refused("wrong_closed_form_size"):
            describe(write_scene(SWITCHED), {"closed_form_size": size})
        with pytest.raises(HolonomError):
            describe(document, {"closed_form_size": size})


def test_the_record_has_the_system_of_the_description(switched):
    record = read(Document.RECORD, ask(Document.RECORD, Source(switched.file)), Record)
    assert list(record.system.constraint_trees) == switched.content["system"]["constraints"]
    assert record.system.constraints[0] == switched.system.constraints[0]
