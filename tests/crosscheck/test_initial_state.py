"""Wrong starts: what a record says of the initial state, changed or left out, is found by the check."""

import dataclasses

import pytest

import holonom
from holonom.crosscheck.check import check_record
from holonom.crosscheck.report import Verdict
from holonom.description import Description
from holonom.record import Equation, Record, Relation, Scene, derived_record
from holonom.source import describe

# X is fixed by the control alone, y by a root that the guess chooses, w by nothing that has a closed form.
START = """
load("holonom.mac")$
system : holonomic_system(
  coordinates = [X, y, z, v, w], controls = [u],
  kinetic_energy = (dot(X)^2 + dot(y)^2 + dot(z)^2 + dot(v)^2 + dot(w)^2)/2,
  constraints = [X - u, y^2 + z^2 - 1, w + sin(w)/2 - v])$
scene : holonomic_scene(system, control_law = [u = 2 + t], initial_state = [z = 0.6, v = 1, dot(z) = 0, dot(v) = 0],
  initial_guess = [X = 0, y = -1, w = 1, dot(X) = 0, dot(y) = 0, dot(w) = 0], time_span = [0, 1])$
"""


@pytest.fixture(scope="module")
def record(tmp_path_factory) -> Record:
    file = tmp_path_factory.mktemp("start") / "scene.mac"
    file.write_text(START)
    return derived_record(file)


@pytest.fixture(scope="module")
def description(record, tmp_path_factory) -> Description:
    file = tmp_path_factory.mktemp("described") / "scene.mac"
    file.write_text(START)
    return describe(file)


def verdicts(record: Record, description: Description, scene: Scene) -> dict[str, Verdict]:
    """Verdicts on (12) and (19) alone; the derivation is not verified."""
    alone = dataclasses.replace(scene, equations=tuple(e for e in scene.equations if e.number in ("12", "19")))
    nothing = dataclasses.replace(record.derivations[0], equations=())
    changed = dataclasses.replace(record, derivations=(nothing,), scenes=(alone,))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("holonom.crosscheck.check._Check._on_derivation", lambda *_: ())
        report = check_record(changed, description)
    return {
        found.number: found.verdict for found in report.verdicts if found.scene and found.is_recorded and found.number
    }


def fixed_values(scene: Scene) -> Equation:
    return next(equation for equation in scene.equations if equation.number == "19")


def with_relations(scene: Scene, relations: tuple[Relation, ...]) -> Scene:
    changed = dataclasses.replace(fixed_values(scene), relations=relations)
    equations = tuple(changed if equation.number == "19" else equation for equation in scene.equations)
    return dataclasses.replace(scene, equations=equations)


def test_all_values_left_out_are_listed(record, description):
    (scene,) = record.scenes
    listed = {str(relation.left) for relation in fixed_values(scene).relations}
    assert listed == {"X_0", "y_0", "w_0", "dot(X)_0", "dot(y)_0", "dot(w)_0"}
    assert verdicts(record, description, scene) == {"12": Verdict.AGREES, "19": Verdict.AGREES}


def test_each_wrong_or_missing_value_is_found(record, description):
    (scene,) = record.scenes
    relations = fixed_values(scene).relations
    for i, relation in enumerate(relations):
        larger = Relation(relation.left_tree, ["Add", relation.right_tree, ["Rational", 1, 1000]])
        for changed in ((larger,), ()):
            wrong = with_relations(scene, (*relations[:i], *changed, *relations[i + 1 :]))
            assert verdicts(record, description, wrong)["19"] is Verdict.DISAGREES, relation.left


def test_a_start_off_the_constraints_is_found(record, description):
    (scene,) = record.scenes
    for name in scene.initial_state:
        moved = {**scene.initial_state, name: scene.initial_state[name] + 1}
        wrong = dataclasses.replace(scene, initial_state=moved)
        assert verdicts(record, description, wrong)["12"] is Verdict.DISAGREES, name


def test_a_parameter_beside_a_root_of_no_closed_form_was_taken_for_its_value(tmp_path):
    """h_0 = h0 for all h0, though s_0 is known in numbers alone; (19) gave the number 1, and the check disagreed."""
    file = tmp_path / "scene.mac"
    file.write_text("""
load("holonom.mac")$
system : holonomic_system(coordinates = [s, h], parameters = [h0], kinetic_energy = (dot(s)^2 + dot(h)^2)/2,
  constraints = [s + sin(s)/2 - h, h - h0])$
scene : holonomic_scene(system, parameter_values = [h0 = 1], initial_state = [],
  initial_guess = [s = 1, h = 1, dot(s) = 0, dot(h) = 0])$
""")
    record = derived_record(file)
    (scene,) = record.scenes
    found = {relation.left.name: str(relation.right) for relation in fixed_values(scene).relations}
    assert found["h_0"] == "h0"
    assert verdicts(record, describe(file), scene)["19"] in (Verdict.PROVED, Verdict.AGREES)


def test_a_number_in_the_place_of_a_closed_form_is_found(record, description):
    """X_0 = u(0) for all laws is the number 2 already; that of dot(y) holds for the scene's own numbers alone."""
    (scene,) = record.scenes
    relations = fixed_values(scene).relations
    for i, relation in enumerate(relations):
        if str(relation.left) == "dot(y)_0":
            number = Relation(relation.left_tree, 0)
            wrong = with_relations(scene, (*relations[:i], number, *relations[i + 1 :]))
            assert verdicts(record, description, wrong)["19"] is Verdict.DISAGREES


def test_numbers_stand_for_closed_forms_that_are_too_long(tmp_path):
    """Of seven velocities that seven constraints fix together; 1/(2 j) each, and another number is found."""
    file = tmp_path / "scene.mac"
    file.write_text("""
load("holonom.mac")$
q : makelist(concat(q, j), j, 7)$
system : holonomic_system(coordinates = q, kinetic_energy = apply("+", dot(q)^2),
  constraints = makelist(apply("+", makelist((q[j]^2 - j^2 - t)/(i + j), j, 7)), i, 7))$
scene : holonomic_scene(system, initial_state = makelist(q[j] = j, j, 7))$
""")
    record, described = derived_record(file), describe(file)
    (scene,) = record.scenes
    assert verdicts(record, described, scene)["19"] in (Verdict.PROVED, Verdict.AGREES)
    first, *others = fixed_values(scene).relations
    wrong = with_relations(scene, (Relation(first.left_tree, ["Rational", 1, 3]), *others))
    assert verdicts(record, described, wrong)["19"] is Verdict.DISAGREES


def test_numbers_for_the_scene_alone_do_not_count_for_all_parameters(tmp_path):
    """Four coordinates of a crank and rod are numbers, as r = 1 and l = 2 have it; the check put other lengths in."""
    file = tmp_path / "scene.mac"
    file.write_text("""
load("holonom.mac")$
rod : planar_body(m, I, [x, y], b)$
slider : particle(M, [s, h])$
system : holonomic_system(parameters = [m, I, M, r, l], assembly(rotor(I, a), rod, slider,
  revolute_joint(marker(rod, [-l/2, 0]), [r*cos(a), r*sin(a)]),
  revolute_joint(marker(rod, [l/2, 0]), slider), point_on_line(slider, marker(ground, [0, 0], [1, 0]))))$
scene : holonomic_scene(system, parameter_values = [m = 1, I = 1, M = 1, r = 1, l = 2],
  initial_state = [a = 0, dot(a) = 1],
  initial_guess = [x = 2, y = 0, b = 0, s = 3, h = 0, dot(x) = 0, dot(y) = 0, dot(b) = 0, dot(s) = 0, dot(h) = 0])$
""")
    record, described = derived_record(file), describe(file)
    (scene,) = record.scenes
    relations = fixed_values(scene).relations
    assert verdicts(record, described, scene)["19"] in (Verdict.PROVED, Verdict.AGREES)
    for i, relation in enumerate(relations):
        wrong = with_relations(scene, (*relations[:i], Relation(relation.left_tree, 5), *relations[i + 1 :]))
        assert verdicts(record, described, wrong)["19"] is Verdict.DISAGREES, relation.left


def test_force_without_a_value_at_the_start_is_no_error(tmp_path):
    """The start itself is compared; the check ended as an internal error."""
    file = tmp_path / "scene.mac"
    file.write_text("""
load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2, forces = [log(x), 0],
  constraints = [y - 2*x])$
scene : holonomic_scene(system, initial_state = [x = 0, dot(x) = 1], time_span = [0, 1])$
""")
    report = check_record(derived_record(file), describe(file))
    assert Verdict.DISAGREES not in {found.verdict for found in report.verdicts}


GUESSED = """
load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  constraints = [x^2 + y^2 + x*y^3 - u^2])$
scene : holonomic_scene(system, control_law = [u = 2 + t], initial_guess = [x = 1, y = 1, dot(x) = 0, dot(y) = 0])$
"""


def test_rounded_values_alone_satisfy_a_constraint_up_to_rounding(tmp_path):
    """A residual of 4e-61, all of whose numbers were found, was called a disagreement."""
    file = tmp_path / "scene.mac"
    file.write_text(GUESSED)
    record, description = derived_record(file), describe(file)
    (scene,) = record.scenes
    assert verdicts(record, description, scene)["19"] is Verdict.AGREES
    first, *others = fixed_values(scene).relations
    moved = Relation(first.left_tree, ["Add", first.right_tree, ["Power", 10, -45]])
    assert verdicts(record, description, with_relations(scene, (moved, *others)))["19"] is Verdict.DISAGREES


ROUNDED = """
load("holonom.mac")$
system : holonomic_system(coordinates = [x, y],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [x^2 + y^2 - 1])$
scene : holonomic_scene(system, initial_state = [x = 0.333333333333333333333333333333,
  y = 0.942809041582063365867792482806, dot(x) = 0, dot(y) = 0])$
"""


def test_another_correction_of_rounded_values_is_found(tmp_path):
    file = tmp_path / "scene.mac"
    file.write_text(ROUNDED)
    record, description = derived_record(file), describe(file)
    (scene,) = record.scenes
    name, size = scene.correction
    assert verdicts(record, description, scene)["12"] is Verdict.AGREES
    for other in ((name, f"{1.03 * float(size)}"), (name, "1e-3"), ("dot(x)", size), None):
        changed = dataclasses.replace(scene, correction=other)
        assert verdicts(record, description, changed)["12"] is Verdict.DISAGREES, other


NEAR = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2, constraints = [x^2 + y^2 - 1])$
scene : holonomic_scene(system, initial_state = [x = {x}, y = {y}, dot(x) = 0, dot(y) = 0])$
"""


@pytest.mark.parametrize(("x", "y"), [("0.707106781187", "-0.707106781187"), ("6.1e-17", "-1"), ("1.0e-13", "-1")])
def test_equal_and_short_corrections_disagreed(x, y, write_scene):
    """Of x and y by the same number, or of y to a fraction of 28 digits."""
    scene = write_scene(NEAR.format(x=x, y=y))
    checked = check_record(derived_record(scene), describe(scene))
    assert not checked.disagreements
    assert {each.verdict for each in checked.verdicts if each.number == "12"} == {Verdict.AGREES}


LIFTED = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  constraints = [y - u*x])$
scene : holonomic_scene(system, control_law = [u = LAW], initial_state = [x = 1, dot(x) = 0], time_span = [0, 3])$
"""
TURNED = """load("holonom.mac")$
wheel : rigid_body(1, [1, 1, 2], [x, y, z], [e0, e1, e2, e3])$
here : marker(wheel, [0, 0, 0], [0, 0, 1], [1, 0, 0])$
there : marker(ground, [0, 0, 0], [0, 0, 1], [1, 0, 0])$
system : holonomic_system(assembly(wheel, revolute_joint(here, there), prescribed_angle(here, there, phi)))$
scene : holonomic_scene(system, initial_state = [x = 0, y = 0, z = 0, e0 = 1, e1 = 0, e2 = 0, e3 = 0, phi = 0,
  dot(phi) = 0, dot(e0) = 0], time_span = [0, 1])$
"""


def test_closed_forms_divided_by_zero_in_the_initial_state(write_scene):
    """dot(e3)_0 = -dot(e0)_0 e0_0/e3_0, where e3_0 = 0."""
    scene = write_scene(TURNED)
    record = derived_record(scene)
    values = {each.left_tree: each.right_tree for each in fixed_values(record.scenes[0]).relations}
    assert values["dot(e3)_0"] == 0
    assert not check_record(record, describe(scene)).disagreements


def test_special_functions_that_vanish_at_the_start_disagreed(write_scene):
    """sn(0), of which mpmath leaves 3e-218, and gamma(2) = 1, which it is relative to."""
    scene = write_scene(LIFTED.replace("LAW", "gamma(2 + t) + jacobi_sn(t, 1/3)"))
    checked = check_record(derived_record(scene), describe(scene))
    assert {each.verdict for each in checked.verdicts if each.number == "12"} == {Verdict.AGREES}


@pytest.mark.parametrize(
    ("law", "start"), [("max(0, t^3)", "0"), ("if sin(t) - t < 0 then t^2 else 0", "0"), ("(t - 1/3)^2", "1/3")]
)
def test_laws_that_vanish_at_the_start_were_errors_and_disagreements(law, start, write_scene):
    """The sign of t^3 was not found by two derivatives, and 1/3 is a decimal of 70 digits."""
    text = LIFTED.replace("y - u*x", "y - u").replace("LAW", law).replace("[0, 3]", f"[{start}, 3]")
    assert not holonom.load(write_scene(text)).check().disagreements


def test_orientations_were_a_disagreement(write_scene):
    scene = write_scene(NEAR.replace("y^2 - 1]", "y^2 - 1, y - 3/5], orientations = [x]").format(x="4/5", y="3/5"))
    assert not check_record(derived_record(scene), describe(scene)).disagreements


def test_the_rounding_error_of_a_constraint_is_no_disagreement(write_scene):
    """Of two circles' common point, irrational in both coordinates: the constraint is 2.6e-211 in 210 digits."""
    scene = write_scene("""load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  constraints = [x^2 + (y - 1)^2 - u^2, (x - 1)^2 + y^2 - 2])$
s : holonomic_scene(system, control_law = [u = 17/10 + sin(t)/5], initial_state = [],
  initial_guess = [x = 1, y = -1, dot(x) = 0, dot(y) = 0], time_span = [0, 1])$
""")
    assert not check_record(derived_record(scene), describe(scene)).disagreements
