"""Wrong results of linearize, linearize-along, equilibria and series, drawn at random, are found."""

import copy
import json
import random
from fractions import Fraction

import pytest

import holonom
from holonom.crosscheck.irregular_point import IrregularPoint
from holonom.crosscheck.linearized import verify
from holonom.crosscheck.report import Verdict
from holonom.crosscheck.results import read_result, verify_result
from holonom.failures import ErrorKind, HolonomError
from holonom.formats import Publication, published
from holonom.series.power_series import series_document, values_at

PENDULUM = """system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m, g],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, potential_energy = [gravity = m*g*y],
  forces = [drag = [-dot(x)/2, 0], drive = [0, u*dot(u)]], constraints = [x^2 + y^2 - u^2])$
swing : holonomic_scene(system, control_law = [u = 1 + t/10], parameter_values = [m = 3/2, g = 981/100],
  initial_state = [x = 2/5*m, dot(x) = 1/2], initial_guess = [y = -4/5, dot(y) = 0], time_span = [0, 2],
  observe = [trajectory, multipliers, pull = lambda1*x + ddot(y)])$
"""
PUSHED = PENDULUM.replace("1 + t/10", "1 + m*t/15").replace("observe = [", "observe = [controls, ")
LED = """system : holonomic_system(coordinates = [x, y, z], controls = [u, F], kinetic_energy = dot(x)^2 + dot(y)^2
    + (1 + z^2)*dot(z)^2/2,
  potential_energy = [gravity = 20*y, spring = (z - x)^2], forces = [drive = [F*z/5, F/7, F]],
  constraints = [x^2 + y^2 - u^2])$
led : holonomic_scene(system, servo_constraints = [y = -2 + t/10, z = x/3 + sin(t)], time_span = [0, 2],
  initial_state = [x = 1/2, dot(x) = 1],
  initial_guess = [y = -2, u = 2, z = 0, dot(z) = 1, dot(y) = 0, dot(u) = 0], observe = [trajectory, multipliers])$
"""
HOOP = """system : holonomic_system(coordinates = [r, z], kinetic_energy = (dot(r)^2 + dot(z)^2 + 25*r^2)/2,
  potential_energy = [gravity = 10*z], constraints = [r^2 + z^2 - 1])$
rest : holonomic_scene(system, initial_state = [r = 0, dot(r) = 0, dot(z) = 0], initial_guess = [z = -1],
  time_span = [0, 1])$
"""
BUCKLED = """system : holonomic_system(coordinates = [x, phi], controls = [u], kinetic_energy = dot(x)^2 + dot(phi)^2,
  potential_energy = [spring = x^6/6 - u*x^4 + x^3/7 - x/3 + x^2, gravity = -3*cos(phi)])$
rest : holonomic_scene(system, control_law = [u = 1 + t], initial_state = [x = 0, phi = 0, dot(x) = 0, dot(phi) = 0],
  time_span = [0, 1])$
"""
FORCED = """system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2,
  forces = [spring = [-(5 + 2*cos(%pi*t + 1))*x]])$
mathieu : holonomic_scene(system, initial_state = [x = 0, dot(x) = 0], nominal = [x = 1], time_span = [0, 2])$"""
FREE = """system : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  potential_energy = 10*y, constraints = [x^2 + y^2 - u^2])$
thrown : holonomic_scene(system, control_law = [u = sqrt((1 + t)^2 + (1 - 5*t^2)^2)],
  initial_state = [x = 1, y = 1, dot(x) = 1, dot(y) = 0], time_span = [0, 1])$"""

STIFF = """system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  potential_energy = (10^8*x^2 + y^2)/2, forces = [-dot(x), -dot(y)/5])$
rest : holonomic_scene(system, initial_state = [x = 0, y = 0, dot(x) = 0, dot(y) = 0], time_span = [0, 1])$"""
PRESCRIBED = """system : holonomic_system(coordinates = [r, phi], controls = [u], parameters = [S],
  kinetic_energy = (dot(r)^2 + r^2*dot(phi)^2)/2, potential_energy = -10*r*cos(phi), constraints = [r - u])$
pulled : holonomic_scene(system, prescribed_reactions = [lambda1 = -S - t], parameter_values = [S = 15],
  initial_state = [r = 1, dot(r) = 0, phi = 1/2, dot(phi) = 0, u = 1, dot(u) = 0], time_span = [0, 1/8])$"""


def along(scene):
    return published(Publication.LINEARIZED_ALONG, scene.linearize_along(samples=3).document())


def with_sums(series):
    return series_document(series, values_at(series, Fraction(1, 100)))


RESULTS = {
    "motion with prescribed reactions": (PRESCRIBED, along),
    "equilibria with prescribed reactions": (
        PRESCRIBED.replace("-S - t", "-S + 3"),
        lambda scene: published(Publication.EQUILIBRIA, scene.equilibria().document()),
    ),
    "series with prescribed reactions": (
        PRESCRIBED,
        lambda scene: series_document(scene.series(order=6, sensitivities=["S"])),
    ),
    "linearisation along a motion": (PENDULUM, along),
    "period of a forced motion": (FORCED, along),
    "deviations from a free motion": (FREE, along),
    "linearisation": (PENDULUM, lambda scene: published(Publication.LINEARIZED, scene.linearize(at="3/10").document())),
    "servo-constraints": (LED, lambda scene: published(Publication.LINEARIZED, scene.linearize(at="3/10").document())),
    "equilibria": (HOOP, lambda scene: published(Publication.EQUILIBRIA, scene.equilibria().document())),
    "equations of degree five": (
        BUCKLED,
        lambda scene: published(Publication.EQUILIBRIA, scene.equilibria().document()),
    ),
    "stiff and slow": (STIFF, lambda scene: published(Publication.LINEARIZED, scene.linearize().document())),
    "stiff and slow equilibrium": (
        STIFF,
        lambda scene: published(Publication.EQUILIBRIA, scene.equilibria().document()),
    ),
    "series": (PUSHED, lambda scene: with_sums(scene.series(order=6, sensitivities=["m", "x"]))),
}
VERIFIED = {  # entries of each document that a verdict is about
    "motion with prescribed reactions": ("times", "points", "C", "transition"),
    "equilibria with prescribed reactions": ("count",),
    "series with prescribed reactions": ("t0", "coordinates", "multipliers", "sensitivities"),
    "linearisation along a motion": ("times", "points", "basis", "A", "B", "C", "D", "transition"),
    "period of a forced motion": ("transition", "floquet"),
    "deviations from a free motion": ("transition", "free"),
    "linearisation": ("at_rest", "point", "mass", "basis", "A", "B", "C", "D", "eigenvalues", "frequencies", "damping",
                      "modes", "controllable_rank", "observable_rank"),
    "servo-constraints": ("point", "basis", "A", "C", "eigenvalues", "modes"),
    "equations of degree five": ("count",),
    "equilibria": ("count", "complete", "found"),
    "series": ("order", "t0", "coordinates", "multipliers", "controls", "sensitivities", "at"),
    "stiff and slow": ("eigenvalues", "frequencies", "damping"),
    "stiff and slow equilibrium": ("found",),
}  # fmt: skip
LONG = "linearisation along a motion", "period of a forced motion"
ROUNDING = 1e-6  # numbers below are rounding errors; a change in the seventh digit is one, too


@pytest.fixture(
    scope="module",
    params=[pytest.param(name, marks=pytest.mark.long if name in LONG else ()) for name in RESULTS],
)
def result(request):
    return made(request.param)


def made(name):
    text, make = RESULTS[name]
    scene = holonom.system(text)
    return scene.description, json.loads(json.dumps(make(scene))), VERIFIED[name]


def test_a_true_result_agrees(result):
    description, content, _ = result
    found = verify_result(description, content)
    assert found.verdict is Verdict.AGREES


def leaves(part, path=()):
    """Paths to numbers and truth values that are no rounding errors."""
    if isinstance(part, dict | list):
        for key, each in part.items() if isinstance(part, dict) else enumerate(part):
            yield from leaves(each, (*path, key))
    elif isinstance(part, bool | int) or (
        part is not None
        and (not isinstance(part, str) or path[0] in VERIFIED["series"])
        and (not Fraction(part) or abs(Fraction(part)) > ROUNDING)
    ):
        yield path


def changed(value, draw):
    """A wrong value."""
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return value + draw.choice([-1, 1])
    number = Fraction(value)
    wrong = draw.choice([-number, number + number / 1000, number - Fraction(1, 20), 2 * number])
    wrong = number + 1 if wrong == number else wrong
    return str(wrong) if isinstance(value, str) else float(wrong)


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(1, 5))])
def test_a_wrong_result_disagrees(result, seed):
    description, content, verified = result
    draw = random.Random(seed)
    for entry in verified:
        places = list(leaves(content[entry], (entry,)))
        *path, last = draw.choice(places)
        wrong = copy.deepcopy(content)
        part = wrong
        for key in path:
            part = part[key]
        part[last] = changed(part[last], draw)
        found = verify_result(description, wrong)
        assert found.verdict is Verdict.DISAGREES, (path, last, part[last])


def test_the_wrong_coordinates_of_a_basis_disagree():
    description, content, _ = made("stiff and slow")
    for wrong in (["x", "x"], ["x"], ["x", "z"]):
        assert verify_result(description, content | {"leading": wrong}).verdict is Verdict.DISAGREES


def test_a_list_of_another_length_disagrees():
    """Some ended in an internal error."""
    description, content, _ = made("stiff and slow")
    for name in ("A", "C", "basis", "mass", "eigenvalues", "modes", "frequencies", "damping"):
        for wrong in (content[name][:-1], [*content[name], content[name][0]]):
            assert verify_result(description, content | {name: wrong}).verdict is Verdict.DISAGREES, name
    assert verify_result(description, content | {"C": [*content["C"][:-1], [0.0]]}).verdict is Verdict.DISAGREES


def test_a_series_of_few_digits_is_undecided(tmp_path):
    scene = holonom.system(PENDULUM)
    content = json.loads(json.dumps(series_document(scene.series(order=6, digits=12))))
    assert verify_result(scene.description, content).verdict is Verdict.UNDECIDED
    file = tmp_path / "series.json"
    file.write_text(json.dumps(content | {"arithmetic": "rounded"}))
    with pytest.raises(HolonomError) as refused:
        read_result(file)
    assert refused.value.kind is ErrorKind.NOT_A_DOCUMENT


@pytest.mark.parametrize("name", ["d(lambda1, m)", "d(u, m)"])
def test_the_last_derivatives_are_checked(name):
    """The equations up to the order of the series contain all but two coefficients of multipliers."""
    scene = holonom.system(PUSHED)
    content = json.loads(json.dumps(series_document(scene.series(order=6, sensitivities=["m"]))))
    for place in (-2, -1):
        wrong = copy.deepcopy(content)
        row = wrong["sensitivities"][name]
        row[place] = str(Fraction(row[place]) + Fraction(1, 10**6))
        assert verify_result(scene.description, wrong).verdict is Verdict.DISAGREES


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(1, 3))])
def test_a_wrong_number_of_solutions_disagrees(seed):
    """Random potentials of degree four in each coordinate, with a count that leaves out or adds a solution."""
    draw = random.Random(seed)
    energy = " + ".join(f"{q}^4/4 + {draw.randint(-9, 9)}*{q}^3/7 - {draw.randint(1, 9)}*{q}^2" for q in "xy")
    scene = holonom.system(
        f"""system : holonomic_system(coordinates = [x, y], kinetic_energy = dot(x)^2 + dot(y)^2,
  potential_energy = [spring = {energy} + x*y])$
rest : holonomic_scene(system, initial_state = [x = 0, y = 0, dot(x) = 0, dot(y) = 0], time_span = [0, 1])$"""
    )
    content = json.loads(json.dumps(published(Publication.EQUILIBRIA, scene.equilibria().document())))
    assert verify_result(scene.description, content).verdict is Verdict.AGREES
    for change in (-1, 1):
        wrong = {**content, "count": content["count"] + change, "complete": False}
        assert verify_result(scene.description, wrong).verdict is Verdict.DISAGREES


def test_exact_values_are_read_and_put_into_the_equations():
    scene = holonom.system(BUCKLED)
    content = json.loads(json.dumps(published(Publication.EQUILIBRIA, scene.equilibria().document())))
    exact = content["found"][0]["exact"]
    assert exact["x"].startswith("CRootOf(")
    for name, value in (
        ("x", exact["x"].replace("21*", "22*")),
        ("x", f"-({exact['x']})"),
        ("x", repr(content["found"][0]["coordinates"]["x"])),
        ("x", "__import__('os').getpid()"),
        ("x", "9**9**9"),
        ("phi", f"{exact['phi']} + 1/10**20"),
        ("y", "1"),
    ):
        wrong = copy.deepcopy(content)
        wrong["found"][0]["exact"][name] = value
        assert verify_result(scene.description, wrong).verdict is Verdict.DISAGREES, value


def equilibria_under_a_norm(bodies: str) -> tuple[holonom.Scene, dict]:
    scene = holonom.system(f"""system : holonomic_system({bodies})$
    rest : holonomic_scene(system, initial_state = [e0 = 1, e1 = 0, e2 = 0, e3 = 0, dot(e1) = 0, dot(e2) = 0,
      dot(e3) = 0])$""")
    return scene, json.loads(json.dumps(published(Publication.EQUILIBRIA, scene.equilibria().document())))


def test_signs_of_euler_parameters_are_verified():
    scene, content = equilibria_under_a_norm("""coordinates = [e0, e1, e2, e3], constraints = [e0^2 + e1^2 + e2^2 + e3^2
      - 1], kinetic_energy = 2*(e0*dot(e1) - e1*dot(e0) + e2*dot(e3) - e3*dot(e2))^2 + 3*(e0*dot(e2) - e2*dot(e0)
      + e3*dot(e1) - e1*dot(e3))^2 + 4*(e0*dot(e3) - e3*dot(e0) + e1*dot(e2) - e2*dot(e1))^2,
      potential_energy = (e1 + e0)^2 + 3*(e2 - e1)^2/2 + 3*e3^2""")
    assert content["reversals"] == [["e0", "e1", "e2", "e3"]]
    assert (len(content["found"]), content["complete"]) == (4, True)
    assert verify_result(scene.description, content).verdict is Verdict.AGREES
    opposite = copy.deepcopy(content)
    for name in content["reversals"][0]:
        opposite["found"][1]["coordinates"][name] = -content["found"][0]["coordinates"][name]
    assert verify_result(scene.description, opposite).verdict is Verdict.DISAGREES


def test_points_of_a_sphere_have_no_second_sign():
    scene, content = equilibria_under_a_norm("""coordinates = [e0, e1, e2, e3],
      constraints = [e0^2 + e1^2 + e2^2 + e3^2 - 1], potential_energy = e1^2 + 2*e2^2 + 3*e3^2,
      kinetic_energy = (dot(e0)^2 + dot(e1)^2 + dot(e2)^2 + dot(e3)^2)/2""")
    assert (content["reversals"], len(content["found"]), content["complete"]) == ([], 8, True)
    wrong = content | {"reversals": [["e0", "e1", "e2", "e3"]], "found": content["found"][:4], "count": 4}
    assert verify_result(scene.description, wrong).verdict is Verdict.DISAGREES


BEAM = """beam : planar_body(20, 5, [x, y], phi)$  rope : distance_joint(marker(beam, [-3/5, 1/4]), [0, 0], 21/10)$
system : holonomic_system(assembly(beam, rope, gravity = uniform_gravity(981/100, beam)))$
hanging : holonomic_scene(system, initial_state = [phi = 1/10, dot(phi) = 1/5, x = 7/5, dot(x) = 1/3],
  initial_guess = [y = -2, dot(y) = 0], time_span = [0, 1], observe = [moment = reaction(rope)[3]])$
"""
DRIVEN = """system : holonomic_system(coordinates = [x], controls = [u], constraints = [x - u],
  kinetic_energy = dot(x)^2/2)$
driven : holonomic_scene(system, control_law = [u = t^2], initial_state = [], time_span = [0, 1])$
"""


def linearized_later(text: str, at: str = "1/2") -> tuple[holonom.Scene, dict]:
    scene = holonom.system(text)
    return scene, json.loads(json.dumps(published(Publication.LINEARIZED, scene.linearize(at=at).document())))


def test_an_output_whose_terms_cancel_disagreed():
    scene, content = linearized_later(BEAM)
    assert content["outputs"][-1] == "moment"
    assert verify_result(scene.description, content).verdict is Verdict.AGREES
    content["C"][-1][0] += 1e-4
    assert verify_result(scene.description, content).verdict is Verdict.DISAGREES


@pytest.mark.parametrize(("share", "verdict"), [(1e-9, Verdict.AGREES), (1e-5, Verdict.DISAGREES)])
def test_a_mass_matrix_counts_to_seven_digits(share, verdict):
    scene, content = linearized_later(PENDULUM)
    content["mass"][0][0] *= 1 + share
    assert verify_result(scene.description, content).verdict is verdict


def test_a_system_without_a_degree_of_freedom_ended_in_an_internal_error():
    scene, content = linearized_later(DRIVEN)
    assert (content["A"], content["eigenvalues"]) == ([], [])
    assert verify_result(scene.description, content).verdict is Verdict.AGREES
    content["D"]["u"][0][0] += 1e-3
    assert verify_result(scene.description, content).verdict is Verdict.DISAGREES


HALF_TURN = """rod : rigid_body(2, [1/3, 1, 2], [x, y, z], [e0, e1, e2, e3])$
system : holonomic_system(assembly(rod, uniform_gravity(10, rod),
  revolute_joint(marker(rod, [0, 0, 1/2], [1, 0, 0]), marker(ground, [0, 0, 0], [1, 0, 0]))))$
scene : holonomic_scene(system, time_span = [0, 1], initial_guess = [x = 0, y = 0, z = 1/2, e1 = 1],
  initial_state = [e0 = 1/10^13, e2 = 0, e3 = 0, dot(e0) = 0])$
"""


def test_a_body_near_a_half_turn_disagreed():
    scene, content = linearized_later(HALF_TURN, at="0")
    assert verify_result(scene.description, content).verdict is Verdict.AGREES
    content["A"][1][0] += 1e-4
    assert verify_result(scene.description, content).verdict is Verdict.DISAGREES


@pytest.mark.parametrize(("place", "stated"), [(0, "asymptotically stable"), (0, "unstable"), (1, "stable")])
def test_a_wrong_stability_disagrees(place, stated):
    """The bead is stable off the axis, and unstable at the lowest and the highest point."""
    scene = holonom.system(HOOP)
    content = published(Publication.EQUILIBRIA, scene.equilibria().document())
    assert [each["stability"] for each in content["found"]] == ["stable", "unstable", "unstable", "stable"]
    content["found"][place]["stability"] = stated
    assert verify_result(scene.description, content).verdict is Verdict.DISAGREES


UNDAMPED = """system : holonomic_system(coordinates = [x, y], parameters = [c], kinetic_energy = dot(x)^2 + dot(y)^2,
  forces = [drag = [-c*dot(x), 0]], constraints = [x^2 + y^2 - 1])$
s : holonomic_scene(system, parameter_values = [c = 0], initial_state = [x = 3/5, y = 4/5, dot(x) = 1],
  time_span = [0, 1])$"""
SADDLE = """system : holonomic_system(coordinates = [x, y, z], parameters = [w, c],
  kinetic_energy = ((dot(x) - w*y)^2 + (dot(y) + w*x)^2)/2, potential_energy = POTENTIAL,
  forces = [damping = [-c*dot(x), -c*dot(y), 0]], constraints = [z - x - y])$
rest : holonomic_scene(system, parameter_values = [w = 2, c = 0],
  initial_state = [x = 0, y = 0, dot(x) = 0, dot(y) = 0], time_span = [0, 1])$"""


@pytest.mark.parametrize(
    ("w", "c", "bend", "verdict"),
    [
        ("2", "0", "", "stable"),
        ("101/100", "0", "", "stable"),
        ("9/10", "0", "", "unstable"),
        ("2", "1e-5", "", "unstable"),
        ("2", "0", " - x^4", "undecided"),
    ],
)
def test_a_rotating_saddle_is_stable_as_far_as_the_theorem_goes(w, c, bend, verdict):
    """Of Brouwer: (w^2 - 1)(w^2 + 1/2) > 0. Dissipation destroys it (Thomson and Tait), other terms leave it open."""
    scene = holonom.system(SADDLE.replace("POTENTIAL", f"x^2/2 - y^2/4{bend}")).with_settings(w=w, c=c)
    content = json.loads(json.dumps(published(Publication.EQUILIBRIA, scene.equilibria().document())))
    (top,) = (each for each in content["found"] if not any(each["coordinates"].values()))
    assert top["stability"] == verdict
    assert verify_result(scene.description, content).verdict is Verdict.AGREES
    top["stability"] = "stable"
    found = verify_result(scene.description, content).verdict
    assert found is (Verdict.AGREES if verdict == "stable" else Verdict.DISAGREES)


def test_derivatives_by_a_coefficient_that_is_zero():
    """Products with it are left out where they contain multipliers alone."""
    scene = holonom.system(PENDULUM.replace("-dot(x)/2", "-(m - 3/2)*dot(x)"))
    content = json.loads(json.dumps(series_document(scene.series(order=4, sensitivities=["m"]))))
    assert verify_result(scene.description, content).verdict is Verdict.AGREES
    scene = holonom.system(UNDAMPED)
    content = json.loads(json.dumps(series_document(scene.series(order=4, sensitivities=["c"]))))
    assert verify_result(scene.description, content).verdict is Verdict.AGREES


def test_deviations_through_switchings_are_not_checked():
    scene = holonom.system(FORCED.replace("cos(%pi*t + 1)", "signum(sin(%pi*t + 1))"))
    content = json.loads(json.dumps(along(scene)))
    assert verify_result(scene.description, content).verdict is Verdict.UNDECIDED
    content["A"][1][1][0] *= 2
    assert verify_result(scene.description, content).verdict is Verdict.DISAGREES


def test_a_result_of_another_kind_is_refused(tmp_path):
    file = tmp_path / "other.json"
    file.write_text('{"format": "holonom-check"}')
    with pytest.raises(HolonomError) as refused:
        read_result(file)
    assert refused.value.kind is ErrorKind.NOT_A_DOCUMENT


def test_check_takes_a_result(holonom_here, write_scene, tmp_path):
    scene, file = write_scene(f"load(holonom)$\n{HOOP}"), tmp_path / "found.json"
    assert holonom_here("equilibria", scene, "--json", file).returncode == 0
    assert holonom_here("check", scene, "--result", file).returncode == 0
    content = json.loads(file.read_text())
    content["found"][0]["coordinates"]["r"] += 1e-3
    file.write_text(json.dumps(content))
    answer = holonom_here("check", scene, "--result", file, "--json", "-")
    last = json.loads(answer.stdout)["equations"][-1]
    assert (answer.returncode, last["id"], last["verdict"]) == (1, "result", "disagrees")


def test_conditions_without_real_values_are_undecided():
    def conditions():
        yield "a condition that holds", 0.0, 1.0
        raise IrregularPoint

    assert verify(conditions()).verdict is Verdict.UNDECIDED


MEASURED = """m_: {}$ l_: {}$ t_: {}$
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m, g, k],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2,
  potential_energy = [gravity = m*g*y, spring = k*(x - l_/3)^2/2], forces = [drag = [-m/t_/5*dot(x), 0]],
  constraints = [x^2 + y^2 - u^2])$
swing : holonomic_scene(system, control_law = [u = l_], parameter_values = [m = m_, g = 981/100*l_/t_^2, k = m_/t_^2],
  initial_state = [x = 3/5*l_, dot(x) = l_/t_/7], initial_guess = [y = -4/5*l_, dot(y) = 0], time_span = [0, 3*t_])$
"""


ATOMS, PLANETS = ("10^-27", "10^-10", "10^-13"), ("10^24", "10^9", "10^7")


def wrong_by_a_thousandth(content, path):
    wrong = copy.deepcopy(content)
    part = wrong
    for key in path[:-1]:
        part = part[key]
    part[path[-1]] *= 1.001
    return wrong


@pytest.mark.parametrize("units", [ATOMS, PLANETS], ids=["atoms", "planets"])
def test_wrong_results_in_other_units_disagree(units):
    """Sizes of one hid wrong results of atoms, and rejected equilibria that are right."""
    scene = holonom.system(MEASURED.format(*units))
    linear, still = (
        json.loads(json.dumps(published(kind, found.document())))
        for kind, found in (
            (Publication.LINEARIZED, scene.linearize()),
            (Publication.EQUILIBRIA, scene.equilibria()),
        )
    )
    changes = [(linear, ["point", name]) for name in ("x", "dot(y)", "lambda1", "u")]
    changes += [(linear, [name, 0, 0]) for name in ("basis", "mass", "C", "eigenvalues")]
    changes += [(linear, ["A", 1, 0]), (linear, ["B", "u", 1, 0]), (linear, ["D", "u", 0, 0])]
    changes += [
        (still, ["found", 0, group, name]) for group, name in (("coordinates", "x"), ("multipliers", "lambda1"))
    ]
    for content, path in changes:
        assert verify_result(scene.description, content).verdict is Verdict.AGREES
        found = verify_result(scene.description, wrong_by_a_thousandth(content, path))
        assert found.verdict is Verdict.DISAGREES, path


@pytest.mark.long
@pytest.mark.parametrize("units", [ATOMS, PLANETS], ids=["atoms", "planets"])
def test_wrong_results_along_motions_in_other_units_disagree(units):
    """Those of atoms were undecided, and right ones of planets rejected."""
    scene = holonom.system(MEASURED.format(*units))
    content = json.loads(json.dumps(along(scene)))
    assert verify_result(scene.description, content).verdict is Verdict.AGREES
    for path in (["points", 1, "x"], ["C", 1, 2, 0], ["transition", 2, 1, 0]):
        found = verify_result(scene.description, wrong_by_a_thousandth(content, path))
        assert found.verdict is Verdict.DISAGREES, path
