"""Effects: only those that a scene calls for cost operations, and the costs are listed."""

import json
import re
from itertools import chain, combinations
from pathlib import Path

import pytest
import sympy as sp
from click.testing import CliRunner
from confinement import without_notice
from programs import PENDULUM, document, program
from refusing import message_of

from holonom.cli import holonom
from holonom.crosscheck.check import check_record
from holonom.crosscheck.evaluation import Steps
from holonom.crosscheck.independent import IndependentEquations
from holonom.crosscheck.motion_program import ScenePrograms, verify_programs
from holonom.crosscheck.points import random_point
from holonom.crosscheck.premises import Premises, differences
from holonom.crosscheck.report import Verdict
from holonom.crosscheck.system import described_system
from holonom.failures import ErrorKind, HolonomError
from holonom.formats import VERSION, Document, read
from holonom.program.effects import Costs, Measure, Status, _points, _regular_point, scene_costs
from holonom.program.forms import MotionProgram
from holonom.program.motion_problem import motion_problem
from holonom.program.numpy_function import NumpyFunction
from holonom.program.request import Request, Solve
from holonom.record import derived_record
from holonom.sandbox import Limits
from holonom.source import describe

EXAMPLES = Path(__file__).parents[2] / "examples"
SPHERICAL = EXAMPLES / "spherical_pendulum.mac"
OPTIONAL = ("support_motion", "frame_rotation", "gravity", "drag")
SUBSETS = tuple(chain.from_iterable(combinations(OPTIONAL, size) for size in range(len(OPTIONAL) + 1)))

SYSTEM = """
load("holonom.mac")$
system : holonomic_system(coordinates = [{coordinates}], controls = [{controls}], parameters = [{parameters}],
  kinetic_energy = [{kinetic}], potential_energy = [{potential}], forces = [{forces}],
  constraints = [{constraint}])$
"""
SCENE = """
moving_scene : holonomic_scene(system, effects = {effects}, control_law = [{law}],
  parameter_values = [{values}], initial_state = [{state}], observe = [trajectory, multipliers, energy])$
"""

VALUES = {"m": "3/2", "k": "1/3"}

# Name of the system: its entries, each a list of (effect, value), its constraint, and a state that satisfies it.
SYSTEMS = {
    "spherical pendulum": {
        "coordinates": "x, y, z",
        "kinetic": [
            ("relative_motion", "m*(dot(x)^2 + dot(y)^2 + dot(z)^2)/2"),
            ("support_motion", "m*dot(u)*dot(x)"),
            ("frame_rotation", "m*k*(x*dot(y) - y*dot(x)) + m*k^2*(x^2 + y^2)/2"),
        ],
        "potential": [("gravity", "m*10*z")],
        "forces": [("drag", "[-k*dot(x), -k*dot(y), -k*dot(z)]")],
        "constraint": "x^2 + y^2 + z^2 - 1",
        "state": "x = 1, y = 0, z = 0, dot(x) = 0, dot(y) = 0, dot(z) = 0",
        "indispensable": {"relative_motion"},
    },
    "polar coordinates": {
        "coordinates": "r, phi",
        "kinetic": [("motion", "m*(dot(r)^2 + r^2*dot(phi)^2)/2"), ("wobble", "m*sin(phi)*dot(r) + u*dot(phi)")],
        "potential": [("spring", "k*(r - 1)^2/2"), ("magnetic", "k*r^2*dot(phi)")],
        "forces": [("motor", "[0, sin(t)]"), ("drag", "[-k*dot(r)^3, 0]")],
        "constraint": "r - u",
        "state": "phi = 0, dot(phi) = 1",
        "indispensable": {"motion"},
    },
    "coupled masses": {
        "coordinates": "p, q, s",
        "kinetic": [("masses", "m*(dot(p)^2 + dot(q)^2 + dot(s)^2)/2"), ("coupling", "dot(q)*(dot(p) + dot(s))/4")],
        "potential": [("weight", "m*(p + q)"), ("spring", "k*(p - s)^2/2")],
        "forces": [("push", "[t, u, dot(u)]"), ("drag", "[-dot(p), -dot(q), -dot(s)]")],
        "constraint": "p*q - u*s",
        "state": "p = 0, q = 1, dot(q) = 0, dot(s) = 0",
        "indispensable": {"masses"},
    },
}  # fmt: skip


def symbol(name):
    return sp.Symbol(name, real=True)


def listed(names):
    return f"[{', '.join(names)}]"


def spherical_scene(called):
    """The example's system with a scene of its own that moves both controls."""
    described = SPHERICAL.read_text(encoding="utf-8").partition("swinging_scene :")[0]
    described = re.sub(r"^load\(.*\$$", 'load("holonom.mac")$', described, flags=re.MULTILINE)
    values = "m = 3/2, l = 1, g = 981/100, c = 1/10, Omega = 1/2"
    state = "x = 3/5, y = 0, z = -4/5, dot(x) = 0, dot(y) = 1"
    scene = SCENE.format(
        effects=listed(["relative_motion", *called]), law="u = sin(3*t), w = cos(t)", values=values, state=state
    )
    return described + scene


def system_text(name, chosen):
    """A system with only the chosen effects written down, and what they contain declared."""
    described = SYSTEMS[name]

    def entry_text(entry):
        return ", ".join(f"{effect} = {value}" for effect, value in described[entry] if effect in chosen)

    parts = {entry: entry_text(entry) for entry in ("kinetic", "potential", "forces")}
    contained = set(re.findall(r"\w+", " ".join([*parts.values(), described["constraint"]])))
    return SYSTEM.format(
        coordinates=described["coordinates"],
        constraint=described["constraint"],
        controls=", ".join(contained & {"u"}),
        parameters=", ".join(sorted(contained & set(VALUES))),
        **parts,
    )


def scene_text(name, called, system):
    """A scene of a system that is written so, with what it declares."""
    declared = re.search(r"controls = \[(.*?)\], parameters = \[(.*?)\]", system)
    law, values = (list(filter(None, each.split(", "))) for each in declared.groups())
    return SCENE.format(
        effects=called,
        law=", ".join(f"{u} = 1 + t" for u in law),
        values=", ".join(f"{name} = {VALUES[name]}" for name in values),
        state=SYSTEMS[name]["state"],
    )


def effects_of(name):
    return [effect for entry in ("kinetic", "potential", "forces") for effect, _ in SYSTEMS[name][entry]]


def costs_of(*arguments):
    result = CliRunner(mix_stderr=False).invoke(holonom, ["effects", *map(str, arguments), "--json", "-"])
    return json.loads(result.stdout)


def refusal_of(file, *options):
    result = CliRunner(mix_stderr=False).invoke(holonom, ["effects", str(file), *options], standalone_mode=False)
    assert result.return_value == 2
    said = without_notice(result.stderr)
    assert said.count("\n") == 1
    return said


@pytest.mark.long
@pytest.mark.parametrize("called", SUBSETS, ids=lambda called: "+".join(called) or "none")
def test_every_subset_of_effects_is_checked(called, write_scene):
    file = write_scene(spherical_scene(called))
    record = derived_record(file)
    report = check_record(record, describe(file))
    assert report.verdicts
    assert report.disagreements == 0
    assert_solves_independent_equations(file, record)


def assert_solves_independent_equations(file, record):
    """The motion program's numbers are the solution of the bordered system that SymPy writes down."""
    program = MotionProgram(file, Request(), Limits()).program
    (scene,) = record.scenes
    known = IndependentEquations(described_system(record.system, scene.effects))
    point = random_point(program.inputs, 0, "effects")
    point |= {symbol(name): number for name, number in scene.parameter_values.items()}
    expected = known.bordered.solution(dict(zip(point, Steps(list(point.values())).real_at({}), strict=True)))
    computed = NumpyFunction(program)([float(point[symbol(name)]) for name in program.inputs])
    for name, number in zip(program.outputs, computed, strict=True):
        if name != "energy":
            assert number == pytest.approx(float(expected[symbol(name)]), rel=1e-10)


LEFT_OUT = [
    (name, effect) for name in SYSTEMS for effect in effects_of(name) if effect not in SYSTEMS[name]["indispensable"]
]


@pytest.mark.parametrize(("name", "left_out"), LEFT_OUT)
def test_leaving_an_effect_out_is_as_if_it_were_not_written(name, left_out, write_scene):
    remaining = [effect for effect in effects_of(name) if effect != left_out]
    whole = system_text(name, effects_of(name))
    chosen = write_scene(whole + scene_text(name, listed(remaining), whole))
    assert_same_assignments(MotionProgram(chosen, Request(), Limits()).document, name, remaining, write_scene)


def assert_same_assignments(chosen, name, effects, write_scene):
    part = system_text(name, effects)
    written = MotionProgram(write_scene(part + scene_text(name, "all", part)), Request(), Limits()).document
    chosen, written = json.loads(chosen), json.loads(written)
    uncalled = set(chosen["inputs"]) - set(written["inputs"])  # of a control that only the effects left out contain
    assert uncalled <= {"u", "dot(u)", "ddot(u)"}
    assert chosen | {"inputs": [name for name in chosen["inputs"] if name not in uncalled]} == written


SWITCHED = """
v : [dot(x) + {shaking}*dot(u) - {turning}*k*y, dot(y) + {turning}*k*(x + {shaking}*u)]$
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m, k], {switches}
  kinetic_energy = [motion = m*(v . v)/2], potential_energy = [weight = {turning}*m*y],
  forces = [drag = [-{shaking}*dot(x), u - k*dot(y)]], constraints = [x^2 + y^2 - 1])$
scene : holonomic_scene(system, {effects} control_law = [u = 1 + t], parameter_values = [m = 3/2, k = 1/3],
  initial_state = [x = 1, y = 0, dot(y) = 0])$
"""


@pytest.mark.parametrize("called", [(), ("shaking",), ("turning",), ("shaking", "turning")], ids=listed)
def test_switches_are_as_if_one_or_zero_were_written(called, write_scene):
    """With both T has their product, the acceleration k u of the moved support in turning axes."""
    names = {"shaking": "shaking", "turning": "turning", "switches": "switches = [shaking, turning],"}
    numbers = {name: str(int(name in called)) for name in ("shaking", "turning")} | {"switches": ""}
    effects = f"effects = {listed(['motion', 'weight', 'drag', *called])},"
    programs = []
    for filled in (SWITCHED.format(**numbers, effects=""), SWITCHED.format(**names, effects=effects)):
        file = write_scene('load("holonom.mac")$' + filled)
        programs.append(json.loads(MotionProgram(file, Request(), Limits()).document))
    assert programs[0] == programs[1]
    assert check_record(derived_record(file), describe(file)).disagreements == 0


@pytest.mark.long
def test_a_pair_of_switches_costs_what_both_add_beyond_each(write_scene):
    pair = ("support_motion", "frame_rotation")
    found = [costs_of(write_scene(spherical_scene(called))) for called in ((), pair[:1], pair[1:], pair)]
    neither, support, frame, both = (costs["operations"] for costs in found)
    for costs in found:
        assert [(each["name"], each["operations"]) for each in costs["pairs"]] == [
            ("frame_rotation*support_motion", both - support - frame + neither)
        ]
    assert both != support + frame - neither


def test_check_finds_a_program_with_other_switches(write_scene):
    other = describe(write_scene(spherical_scene(["support_motion"])))
    file = write_scene(spherical_scene(["support_motion", "frame_rotation"]))
    problems = {solve: motion_problem(file, Request(solve=solve), Limits()) for solve in Solve}
    programs = [ScenePrograms("moving_scene", problems)]
    verdicts = [
        {each.found.verdict for each in verify_programs(of, programs, "seed")} for of in (describe(file), other)
    ]
    assert verdicts[0] == {Verdict.AGREES}
    assert Verdict.DISAGREES in verdicts[1]
    assert any(each.what == "effects" for each in differences(derived_record(file), Premises(other)))


def test_a_scene_that_calls_for_less_pays_less():
    asked = (Request(scene=f"{name}_scene") for name in ("swinging", "shaken"))
    swinging, shaken = (json.loads(MotionProgram(SPHERICAL, each, Limits()).document) for each in asked)
    assert swinging["operations"] < shaken["operations"]


def test_costs_are_those_of_the_programs():
    costs = costs_of(SPHERICAL, "--scene", "foucault_scene")
    program = json.loads(MotionProgram(SPHERICAL, Request(scene="foucault_scene"), Limits()).document)
    assert costs["scene"] == "foucault_scene"
    assert costs["operations"] == program["operations"]
    terms = {(term["equation"], term["term"]): term for term in costs["terms"]}
    assert len(terms) == len(costs["terms"])
    assert terms["3", "(dB_k/dq_s - dB_s/dq_k) dot(q_k)"]["status"] == Status.PRESENT
    assert terms["3", "[k,m;s] dot(q_k) dot(q_m)"] == {
        "equation": "3",
        "term": "[k,m;s] dot(q_k) dot(q_m)",
        "status": Status.ABSENT_BY_STRUCTURE,
        "operations": 0,
        "seconds": 0.0,
    }
    found = {effect["name"]: effect for effect in costs["effects"]}
    assert found["frame_rotation"]["status"] == Status.PRESENT
    assert found["frame_rotation"]["operations"] > 0
    assert found["drag"]["status"] == Status.ABSENT_BY_CHOICE
    assert found["relative_motion"]["operations"] is None


def test_the_table_shows_every_term_and_effect():
    result = CliRunner(mix_stderr=False).invoke(holonom, ["effects", str(SPHERICAL), "--scene", "swinging_scene"])
    for said in ("[k,m;s] dot(q_k)", "absent by structure", "absent by choice", "indispensable", "20 operations"):
        assert said in result.stdout


@pytest.mark.long
def test_a_file_without_scenes_has_all_its_effects(write_scene):
    costs = costs_of(write_scene(system_text("coupled masses", effects_of("coupled masses"))), "--set", "m=2")
    assert costs["scene"] is None
    assert {effect["status"] for effect in costs["effects"]} == {Status.PRESENT}


def test_without_a_compiler_numpy_is_measured(monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    costs = scene_costs(SPHERICAL, Request(scene="swinging_scene"), Limits())
    assert costs.measured_in is Measure.NUMPY
    assert costs.seconds_per_evaluation > 0


def test_a_constant_control_has_no_rates(write_scene):
    scene = scene_text("coupled masses", "all", system_text("coupled masses", effects_of("coupled masses")))
    still = write_scene(system_text("coupled masses", effects_of("coupled masses")) + scene.replace("1 + t", "2"))
    program = MotionProgram(still, Request(), Limits()).program
    assert "u" in program.inputs
    assert not {"dot(u)", "ddot(u)"} & set(program.inputs)


@pytest.mark.parametrize(
    "change",
    [
        {"version": VERSION + 1},
        {"terms": [{"equation": "3"}]},
        {"program": None},
        {"program": {}},
        {"effects": [{"name": "drag"}]},
    ],
)
def test_what_is_no_document_of_costs_is_refused_in_one_sentence(change):
    whole = document(PENDULUM.inputs, [], {"out": PENDULUM.inputs[0]})
    good = {"format": "holonom-effects", "version": VERSION, "program": whole, "terms": [], "effects": []}
    assert read(Document.EFFECTS, json.dumps(good), Costs).effects == ()
    with pytest.raises(HolonomError) as refusal:
        read(Document.EFFECTS, json.dumps(good | change), Costs)
    assert "\n" not in str(refusal.value)


def test_text_that_is_not_json_is_refused():
    with pytest.raises(HolonomError):
        read(Document.EFFECTS, "{", Costs)


def test_an_effect_that_does_not_exist_is_refused(write_scene):
    file = write_scene(spherical_scene(["antigravity"]))
    assert re.search(message_of(ErrorKind.REFUSED, "'antigravity'"), refusal_of(file))


@pytest.mark.parametrize("effects", ["[gravity, drag]", "[support_motion]"])
def test_effects_without_squares_of_velocities_are_refused(write_scene, effects):
    text = spherical_scene([]).replace("[relative_motion]", effects)
    assert re.search(message_of(ErrorKind.REFUSED, "relative_motion"), refusal_of(write_scene(text)))


def test_a_redundant_constraint_costs_nothing(write_scene):
    described = (
        'load("holonom.mac")$ system : holonomic_system(coordinates = [x, y], kinetic_energy = dot(x)^2 + dot(y)^2,'
        " constraints = [x^2 + y^2 - 1{}])$"
    )
    twice, once = (costs_of(write_scene(described.format(more))) for more in (", 2*(x^2 + y^2 - 1)", ""))
    assert twice["operations"] == once["operations"] > 0


def test_a_value_for_an_undeclared_parameter_is_refused(write_scene):
    assert re.search(message_of(ErrorKind.REFUSED, "'mass'"), refusal_of(SPHERICAL, "--set", "mass=2"))
    file = write_scene(spherical_scene([]).replace("m = 3/2", "mass = 3/2"))
    assert re.search(message_of(ErrorKind.REFUSED, "parameter_values", "'mass'"), refusal_of(file))


def test_points_of_measurements_are_near_one_and_have_no_symmetry():
    points = [tuple(point.values()) for point in _points(dict.fromkeys("xyz"))]
    values = [value for point in points for value in point]
    assert all(0.5 <= value < 1.5 for value in values)
    assert len(set(values)) == len(values)
    assert len({round(abs(a - b), 9) for a, b, _ in points} | {round(abs(b - c), 9) for _, b, c in points}) > 1


def test_a_point_of_measurements_is_where_the_program_has_values():
    """A root of what is negative at the first points."""
    names = dict.fromkeys("xy")
    first = next(_points(names))
    bound = first["x"] + 1e-3
    root = ["Sqrt", ["Subtract", "x", {"num": repr(bound)}]]
    found = _regular_point(program(["x", "y"], [("w", root)], {"f": "w"}), names)
    assert found["x"] > bound
    assert _regular_point(program(["x", "y"], [("w", ["Sqrt", "x"])], {"f": "w"}), names) == first
