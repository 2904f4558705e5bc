"""A system may use any name that the library uses for itself: Maxima's variables have dynamic scope."""

import json
import re
from pathlib import Path

import pytest

from holonom.crosscheck import check_record
from holonom.maxima import LIBRARY, run_batch, run_scene
from holonom.record import read_record

BOUND = re.compile(r"\bblock\(\s*\[([^\]]*)\]|^\w+\(([\w, \[\]]*)\)\s*:=|lambda\(\[([^\]]*)\]", re.MULTILINE)
NAME = re.compile(r"[A-Za-z]\w*")
MAXIMAS = {
    "t",
    "lambda",
    "errormsg",
    "fpprec",
    "fpprintprec",
    "linel",
    "ratprint",
    "ratepsilon",
    "bftorat",
    "algebraic",
    "algexact",
    "scalarmatrixp",
    "trigexpandplus",
    "trigexpandtimes",
    "linsolve_params",
    "linsolvewarn",
}
ENTRIES = {
    "coordinates",
    "parameters",
    "parameter_values",
    "initial_state",
    "title",
    "effects",
    "settings",
    "expression_graph",
}
AT_ONCE = 12  # names in one system

SCENE = """
load("holonom.mac")$
{first} : holonomic_system(coordinates = [{second}, {third}], controls = [{fourth}], parameters = [{parameters}],
  kinetic_energy = (dot({second})^2 + (1 + {product}*t)*dot({third})^2)/2,
  potential_energy = {sum}*{second},
  constraints = [{third} - {fourth}*{second}])$
scene : holonomic_scene({first}, control_law = [{fourth} = 1 + t*({sum})], parameter_values = [{values}],
  initial_state = [{second} = 1, dot({second}) = 2])$
"""

UNPUSHED = """
load("holonom.mac")$
{first} : holonomic_system(coordinates = [{second}, {third}], controls = [{fourth}], parameters = [{parameters}],
  kinetic_energy = (1 + {product})*(dot({second})^2 + dot({third})^2)/2,
  constraints = [{second}^2 + {third}^2 - {fourth}^2])$
scene : holonomic_scene({first}, control_law = [{fourth} = sqrt((1 + t*({sum}))^2 + t^2)],
  parameter_values = [{values}],
  initial_state = [{second} = 1, {third} = 0, dot({second}) = {sum}, dot({third}) = 1])$
"""

PRESCRIBED = SCENE.replace(
    "control_law = [{fourth} = 1 + t*({sum})]", "prescribed_reactions = [lambda1 = 1 + t*({sum})]"
)
PRESCRIBED = PRESCRIBED.replace("initial_state = [", "initial_state = [{fourth} = 1, dot({fourth}) = 1, ")


def local_names(*folders: str) -> list[str]:
    """Every name that a function in these folders of the library binds."""
    files = [file for folder in folders for file in (LIBRARY / folder).glob("*.mac")]
    text = "\n".join(path.read_text() for path in files)
    bound = {
        match[0]
        for groups in BOUND.findall(text)
        for part in re.split(r",", ",".join(groups))
        if (match := NAME.match(part.strip(" []\n")))
    }
    return sorted(bound - MAXIMAS - ENTRIES)


def groups(names: list[str]) -> list[list[str]]:
    """All names, `AT_ONCE` at a time; the last ones fill up the last group."""
    return [names[max(0, min(start, len(names) - AT_ONCE)) :][:AT_ONCE] for start in range(0, len(names), AT_ONCE)]


def scene_with(names: list[str], directory: Path, template: str = SCENE) -> Path:
    first, second, third, fourth, *parameters = names
    file = directory / "scene.mac"
    file.write_text(
        template.format(
            first=first,
            second=second,
            third=third,
            fourth=fourth,
            parameters=", ".join(parameters),
            product="*".join(parameters),
            sum=" + ".join(parameters),
            values=", ".join(f"{name} = {place}/7" for place, name in enumerate(parameters, 1)),
        )
    )
    return file


@pytest.mark.parametrize("names", groups(local_names(".", "derivation", "record")), ids=" ".join)
def test_names_of_the_derivation_are_the_users_too(names: list[str], tmp_path: Path):
    report = check_record(read_record(run_scene(scene_with(names, tmp_path))))
    assert report.verdicts
    assert report.disagreements == 0


@pytest.mark.parametrize("names", groups(local_names("free_motion")), ids=" ".join)
def test_names_of_the_free_motion_are_the_users_too(names: list[str], tmp_path: Path):
    writer = "lambda([file], (free_motion_order : 2, write_free_motion(file, false, 4)))"
    free = json.loads(run_batch(scene_with(names, tmp_path), writer))
    assert free["universal"]["laws"] == [{names[3]: 0}]
    assert free["trajectory"]["kind"] == "series"


@pytest.mark.parametrize("names", groups(local_names("free_motion")), ids=" ".join)
def test_names_of_the_proof_are_the_users_too(names: list[str], tmp_path: Path):
    writer = "lambda([file], write_json(json_verdict_on_motion(motion_verdict(false, [], scene, 4)), file))"
    assert json.loads(run_batch(scene_with(names, tmp_path, UNPUSHED), writer))["verdict"] == "free"


@pytest.mark.parametrize("names", groups(local_names("free_motion", "program")), ids=" ".join)
def test_names_of_prescribed_reactions_are_the_users_too(names: list[str], tmp_path: Path):
    writer = "lambda([file], (free_motion_order : 2, write_free_motion(file, false, 4)))"
    free = json.loads(run_batch(scene_with(names, tmp_path, PRESCRIBED), writer))
    assert free["prescribed"]["controls"].keys() == {f"ddot({names[3]})"}
    assert free["trajectory"]["kind"] == "series"


@pytest.mark.parametrize("names", groups(local_names("program")), ids=" ".join)
def test_names_of_the_program_are_the_users_too(names: list[str], tmp_path: Path):
    neutral = [f"neutral{place}x" for place in range(len(names))]
    writer = "lambda([file], write_program(file, false, 'direct))"
    theirs = json.loads(run_batch(scene_with(names, tmp_path), writer))
    ours = json.loads(run_batch(scene_with(neutral, tmp_path), writer))
    assert theirs["operations"] == ours["operations"]
    assert len(theirs["inputs"]) == len(ours["inputs"])
