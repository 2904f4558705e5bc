"""The same motion in other units is the same motion: samples, verdicts, switchings, events, engines, exit statuses.

Four systems are written in units by Maxima, so that their start, free motion, series and sweeps are in them, too; every
example is measured in them after Maxima.
"""

import json
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from subprocess import CompletedProcess
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest
from problems import problem
from refusing import failing
from units import SI, SYSTEMS, Units, description_in_length, in_units

import holonom
from holonom.documents import ask
from holonom.failures import ErrorKind, HolonomError
from holonom.formats import Document
from holonom.program.motion_problem import MotionProblem, motion_problem
from holonom.program.precision import read_precision
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.series.heyoka_series import expand
from holonom.series.power_series import MotionSeries
from holonom.simulation.hard_cases import Difficulty
from holonom.simulation.matrices import MotionMatrices, start_of
from holonom.simulation.nominal import nominal_of
from holonom.simulation.request import EngineName, SimulationRequest
from holonom.simulation.simulate import simulate
from holonom.sweeps.axes import read_axes
from holonom.sweeps.outputs import read_quantities
from holonom.sweeps.rows import Plan, RowMaker

AGREEMENT = 1e-10  # of the largest number of its kind
ENGINES = [EngineName.AUTO, EngineName.TAYLOR, EngineName.ROBUST, EngineName.RUNGE_KUTTA]
UNITS = """load("holonom.mac")$
m_: {mass}$ l_: {length}$ t_: {time}$
"""
TEXTS = {
    "pendulum": """system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m, g],
  kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2, potential_energy = [gravity = m*g*y], constraints = [x^2 + y^2 - u^2])$
swing : holonomic_scene(system, control_law = [u = l_ + l_*t/(10*t_)], parameter_values = [m = m_, g = 981/100*l_/t_^2],
  initial_state = [x = 3/5*l_, dot(x) = 0], initial_guess = [y = -7/10*l_, dot(y) = 0], time_span = [0, 3*t_],
  observe = [trajectory, multipliers, energy, residuals])$
""",
    "dry friction": """system : holonomic_system(coordinates = [x], parameters = [m, k, F],
  kinetic_energy = m*dot(x)^2/2, potential_energy = k*x^2/2, forces = [-F*signum(dot(x))])$
slide : holonomic_scene(system, parameter_values = [m = m_, k = 4*m_/t_^2, F = m_*l_/t_^2/2],
  initial_state = [x = l_, dot(x) = 0], time_span = [0, 8*t_])$
""",
    "double pendulum": """system : holonomic_system(coordinates = [x1, y1, x2, y2], parameters = [m, g, l],
  kinetic_energy = m*(dot(x1)^2 + dot(y1)^2 + dot(x2)^2 + dot(y2)^2)/2, potential_energy = [gravity = m*g*(y1 + y2)],
  constraints = [x1^2 + y1^2 - l^2, (x2 - x1)^2 + (y2 - y1)^2 - l^2])$
swing : holonomic_scene(system, parameter_values = [m = m_, g = 981/100*l_/t_^2, l = l_],
  initial_state = [x1 = 3/5*l_, y1 = -4/5*l_, x2 = 8/5*l_, y2 = -4/5*l_,
    dot(x1) = 0, dot(y1) = 0, dot(x2) = 0, dot(y2) = 0],
  time_span = [0, 2*t_], until = [x2])$
""",
    "pulse": """system : holonomic_system(coordinates = [x], parameters = [m, k, F], kinetic_energy = m*dot(x)^2/2,
  potential_energy = k*x^2/2, forces = [F*exp(-(100*(t/t_ - 3))^2)])$
kick : holonomic_scene(system, parameter_values = [m = m_, k = 4*m_/t_^2, F = 100*m_*l_/t_^2],
  initial_state = [x = 0, dot(x) = 0], time_span = [0, 8*t_])$
""",
}
FOLDER = Path(__file__).parents[2] / "examples"
SCENE = re.compile(r"^(\w+) *: *holonomic_scene", re.MULTILINE)
EXAMPLES = [
    (path.relative_to(FOLDER).as_posix(), scene)
    for path in sorted(FOLDER.rglob("*.mac"))
    for scene in SCENE.findall(path.read_text(encoding="utf-8"))
]
# The multipliers of the linkage are large next to dead centres. The stiff spring is stretched by 1e-3 beside
# coordinates of one, for 2,250 periods: in the same units, the last bit of x3 at the start changes the multipliers by
# 1e-10.
DIGIT_LOST = {"linkage.mac", "hard/stiff_spring.mac"}


@dataclass(frozen=True)
class Seen:
    """Verdicts and samples of a motion, in SI."""

    told: tuple  # all that has to be the same
    samples: dict[str, np.ndarray]  # by kind
    reaction: float = 0.0  # nominal size of the multipliers


def seen(motion: MotionProblem, engine: EngineName, units: Units) -> Seen:
    try:
        found = simulate(motion, SimulationRequest(engine=engine, samples=11))
    except HolonomError as error:
        return Seen((error.kind,), {})
    report, rate = found.report, float(units.length / units.time)
    samples = {
        "coordinates": np.array(list(found.coordinates.values())) / float(units.length),
        "velocities": np.array(list(found.velocities.values())) / rate,
        "multipliers": np.array(list(found.multipliers.values())) / float(units.energy),
        "times": found.times[None] / float(units.time),
        "switchings": np.array([[float(each.t) for each in report.switchings]]) / float(units.time),
    }
    cases = [case for case in report.cases if case is not Difficulty.LONG_RUN]  # by steps, which heyoka takes by units
    told = (
        [segment.engine for segment in report.segments],
        [each.outcome for each in report.switchings],
        report.ending and report.ending.crossed,
        [violation.quantity for violation in report.violations],
        cases,
    )
    return Seen(told, samples, reaction_size(motion) / float(units.energy))


def reaction_size(motion: MotionProblem) -> float:
    """The multiplier whose work along nominal sizes is that of the forces at the start; 0 where signs are open."""
    if motion.signs:
        return 0.0
    matrices = MotionMatrices(motion)
    here, sizes = matrices(*start_of(motion)), matrices.nominal.coordinates
    ways = np.max(np.abs(here.jacobian) * sizes, axis=1)
    return float(np.max(np.abs(here.force) * sizes) / ways.min()) if len(ways) and ways.min() > 0 else 0.0


def assert_same(one: Seen, other: Seen, agreement: float = AGREEMENT) -> None:
    assert other.told == one.told
    for kind, numbers in one.samples.items():
        size = np.max(np.abs(numbers), initial=one.reaction if kind == "multipliers" else 0.0) or 1.0
        assert np.max(np.abs(other.samples[kind] - numbers), initial=0.0) <= agreement * size, kind


def written(name: str, units: Units) -> str:
    """One of the four systems, as Maxima reads it in these units."""
    return UNITS.format(**vars(units)) + TEXTS[name]


@cache
def written_problem(name: str, units: Units) -> MotionProblem:
    with TemporaryDirectory() as folder:
        file = Path(folder) / "scene.mac"
        file.write_text(written(name, units), encoding="utf-8")
        return motion_problem(file, Request(), Limits())


@cache
def written_seen(name: str, engine: EngineName, units: Units) -> Seen:
    found = seen(written_problem(name, units), engine, units)
    if found.samples and "pendulum" in name:  # the constraints are areas, in whose unit the multipliers are
        found.samples["multipliers"] = found.samples["multipliers"] * float(units.length) ** 2
    return found


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("units", ["micrometres", "atoms"])
def test_dry_friction_is_the_same_in_small_units(units, engine):
    motion, others = written_problem("dry friction", SI), SYSTEMS[units]
    assert_same(written_seen("dry friction", engine, SI), seen(in_units(motion, others), engine, others))


@pytest.mark.parametrize("engine", ENGINES)
def test_a_pendulum_of_micrometres_is_the_same(engine):
    units = SYSTEMS["micrometres"]
    assert_same(written_seen("pendulum", engine, SI), written_seen("pendulum", engine, units))


@pytest.mark.long
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("units", SYSTEMS)
@pytest.mark.parametrize("name", TEXTS)
def test_four_systems_are_the_same_in_all_units(name, units, engine):
    assert_same(written_seen(name, engine, SI), written_seen(name, engine, SYSTEMS[units]))


def example(file: str, scene: str, engine: EngineName) -> MotionProblem:
    """The motion, but of 2,250 periods the first 45 where all would take minutes."""
    motion = problem(file, scene)
    short = file == "hard/stiff_spring.mac" and engine is EngineName.ROBUST
    return replace(motion, time_span=("0", "0.2")) if short else motion


@cache
def example_in_si(file: str, scene: str, engine: EngineName) -> Seen:
    return seen(example(file, scene, engine), engine, SI)


@pytest.mark.long
@pytest.mark.parametrize("units", SYSTEMS)
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("file", "scene"), EXAMPLES)
def test_every_example_is_the_same_in_all_units(file, scene, engine, units):
    others, by_default = SYSTEMS[units], example_in_si(file, scene, EngineName.AUTO)
    if engine is EngineName.TAYLOR and by_default.samples and set(by_default.told[0]) == {engine}:
        pytest.skip("by default, this engine integrates all of the motion")
    known = example_in_si(file, scene, engine)
    found = seen(in_units(example(file, scene, engine), others), engine, others)
    assert_same(known, found, (10 if file in DIGIT_LOST else 1) * AGREEMENT)


def test_a_vanishing_gradient_was_taken_for_a_vanishing_pivot():
    """Truth: the length 1 - t. Shortly before, rounding makes an error of 1e-11 in accelerations, in some units."""
    motion = in_units(problem("hard/vanishing_length.mac", "straight_scene"), SYSTEMS["planets"])
    with failing(ErrorKind.NO_GRADIENT) as raised:
        simulate(motion, SimulationRequest(engine=EngineName.TAYLOR, samples=11))
    assert raised.value.facts["time"] == pytest.approx(float(SYSTEMS["planets"].time), rel=1e-12)


def assert_ends_well(file: str, scene: str, run: Callable[..., CompletedProcess[str]], folder: Path) -> None:
    description = description_in_length(described(file), SYSTEMS["micrometres"].length)
    (folder / "description.json").write_text(json.dumps(description), encoding="utf-8")
    found = run("simulate", folder / "description.json", "--scene", scene, "--time-limit", "900")
    assert found.returncode == (2 if file == "hard/vanishing_length.mac" else 0), found.stderr


@cache
def described(file: str) -> dict[str, Any]:
    return json.loads(ask(Document.DESCRIPTION, FOLDER / file))


def test_a_pendulum_of_micrometres_ends_with_status_0(holonom_here, tmp_path):
    assert_ends_well("pendulum.mac", "swing_scene", holonom_here, tmp_path)


@pytest.mark.long
@pytest.mark.parametrize(("file", "scene"), EXAMPLES)
def test_every_example_of_micrometres_ends_with_status_0(file, scene, holonom_here, tmp_path):
    assert_ends_well(file, scene, holonom_here, tmp_path)


@pytest.mark.parametrize("samples", [11, None])
def test_taylor_coefficients_of_a_fast_motion_left_the_range_of_doubles(samples):
    """Its periods are 3e-15 of a unit of time; at order 30 the engine ended. None takes the states of each step."""
    motion, units = problem("hard/heavy_bob.mac"), SYSTEMS["atoms"]
    assert Fraction(1, 2**24) > nominal_of(in_units(motion, units)).time
    wanted = SimulationRequest(engine=EngineName.TAYLOR, samples=samples)
    one, other = simulate(motion, wanted), simulate(in_units(motion, units), wanted)
    for name, numbers in one.coordinates.items():
        at = numbers if samples is not None else numbers[-1:]
        found = other.coordinates[name] if samples is not None else other.coordinates[name][-1:]
        assert np.array(found) / float(units.length) == pytest.approx(np.array(at), rel=1e-12)


def test_sizes_follow_the_units():
    motion, units = written_problem("dry friction", SI), SYSTEMS["atoms"]
    one, other = nominal_of(motion), nominal_of(in_units(motion, units))
    assert other.time == pytest.approx(one.time * float(units.time), rel=1e-14)
    assert other.coordinates == pytest.approx(one.coordinates * float(units.length), rel=1e-14)


def test_a_light_mass_at_its_own_size_is_not_near_zero():
    assert nominal_of(problem("hard/heavy_bob.mac")).coordinates.tolist() == [1.0] * 4


def test_a_scene_may_give_sizes(write_scene):
    text = UNITS.format(**vars(SI)) + TEXTS["dry friction"]
    given = text.replace("initial_state", "nominal = [x = 1/10^3, t = 5], initial_state")
    sizes = nominal_of(motion_problem(write_scene(given), Request(), Limits()))
    assert (sizes.time, *sizes.state) == (5.0, 1e-3, 2e-4)


@pytest.mark.long
@pytest.mark.parametrize("units", SYSTEMS)
@pytest.mark.parametrize("name", ["pendulum", "double pendulum"])
def test_free_motion_is_the_same_in_all_units(name, units):
    one, other = (holonom.system(written(name, each)).free() for each in (SI, SYSTEMS[units]))
    assert other.motion.verdict == one.motion.verdict
    assert other.motion.first.order == one.motion.first.order
    assert other.universal.verdict == one.universal.verdict
    assert other.trajectory.kind == one.trajectory.kind


@cache
def expanded(file: str, scene: str, units: str | None) -> MotionSeries | ErrorKind:
    motion = problem(file, scene)
    try:
        return expand(motion if units is None else in_units(motion, SYSTEMS[units]), 12, read_precision("50"))
    except HolonomError as error:
        return error.kind


def assert_same_series(file: str, scene: str, units: str) -> None:
    one, other = expanded(file, scene, None), expanded(file, scene, units)
    if isinstance(one, ErrorKind):
        assert other is one
        return
    unit_of = dict.fromkeys(one.coordinates, SYSTEMS[units].length)
    unit_of |= dict.fromkeys(one.multipliers, SYSTEMS[units].energy)
    ours, theirs = one.coordinates | one.multipliers, other.coordinates | other.multipliers
    assert theirs.keys() == ours.keys()
    sizes = sizes_by_power(list(ours.values()))
    for name, unit in unit_of.items():
        for power, (number, found) in enumerate(zip(ours[name], theirs[name], strict=True)):
            in_si = Fraction(found) * SYSTEMS[units].time ** power / unit
            assert abs(in_si - Fraction(number)) <= Fraction(1, 10**40) * sizes[power], (name, power)


def sizes_by_power(series: list[Sequence[str]]) -> list[Fraction]:
    """The largest coefficients, or the mean of those beside: an even motion has rounding errors alone at odd powers."""
    largest = [max(abs(Fraction(number)) for number in column) for column in zip(*series, strict=True)]
    beside = zip([0, *largest], [*largest[1:], 0], strict=False)
    return [max(own, Fraction(float(one * other) ** 0.5)) for own, (one, other) in zip(largest, beside, strict=True)]


def test_a_series_is_the_same_in_units_of_atoms():
    assert_same_series("spherical_pendulum.mac", "shaken_scene", "atoms")


@pytest.mark.long
@pytest.mark.parametrize("units", ["atoms", "planets"])
@pytest.mark.parametrize(("file", "scene"), EXAMPLES)
def test_every_series_is_the_same_in_small_and_large_units(file, scene, units):
    """No size decides about a series, whose numbers are of any range: two systems are enough."""
    assert_same_series(file, scene, units)


PARAMETER = re.compile(r"[^_]parameters *= *\[(\w+)")


@cache
def swept(file: str, scene: str, units: str | None) -> Any:
    """Three rows around the first parameter, or the reason against a sweep."""
    (name,) = PARAMETER.findall((FOLDER / file).read_text(encoding="utf-8"))[:1]
    try:
        motion = problem(file, scene, open_parameters=(name,))
        value = float(motion.values[name])
        axes = read_axes([f"{name}={0.95 * value!r}:{1.05 * value!r}:3"], [], [], None, None)
        quantities = read_quantities([",".join(["final", *quantities_of(motion)])])
        plan = Plan(motion if units is None else in_units(motion, SYSTEMS[units]), axes, quantities)
        return RowMaker(plan).table(0, axes.rows).to_pandas()
    except HolonomError as error:
        return error.kind


def quantities_of(motion: MotionProblem) -> tuple[str, str]:
    first = motion.coordinates[0]
    return f"zero({first})", f"max({first})"


def assert_same_sweep(file: str, scene: str, units: str) -> None:
    one, other = swept(file, scene, None), swept(file, scene, units)
    if isinstance(one, ErrorKind):
        assert other is one
        return
    motion, own = problem(file, scene), SYSTEMS[units]
    assert other["status"].tolist() == one["status"].tolist()
    agreement = (10 if file in DIGIT_LOST else 1) * AGREEMENT
    zero, most = quantities_of(motion)
    velocities = motion.state[len(motion.coordinates) :]
    kinds = ((*motion.coordinates, most), own.length), (velocities, own.length / own.time), ((zero,), own.time)
    for names, unit in kinds:
        known, found = one[list(names)].to_numpy(float), other[list(names)].to_numpy(float) / float(unit)
        assert np.isnan(found).tolist() == np.isnan(known).tolist()
        size = np.nanmax(np.abs(known), initial=0.0) or 1.0
        assert np.nanmax(np.abs(found - known), initial=0.0) <= agreement * size, names


def test_a_sweep_is_the_same_in_units_of_atoms():
    assert_same_sweep("pendulum.mac", "swing_scene", "atoms")


@pytest.mark.long
@pytest.mark.parametrize("units", SYSTEMS)
@pytest.mark.parametrize(("file", "scene"), [each for each in EXAMPLES if each[0] != "paper/paper.mac"])  # no parameter
def test_every_sweep_is_the_same_in_all_units(file, scene, units):
    assert_same_sweep(file, scene, units)


FAST_AND_SLOW = """load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], parameters = [k], kinetic_energy = {mass}*(dot(x)^2 + dot(y)^2)/2,
  potential_energy = k*y^2/2)$
ringing : holonomic_scene(system, parameter_values = [k = 10^6*{mass}/({time})^2], time_span = [0, 10*{time}],
  initial_state = [x = {length}, y = {length}/1000, dot(x) = {length}/{time}/10, dot(y) = 0])$
"""


def test_fast_velocities_beside_a_slow_motion_lost_digits_in_short_units_of_time():
    """Truth: -sin(1000 t). Velocities in short units of time are small beside coordinates, which decided on steps."""
    scene = holonom.system(FAST_AND_SLOW.format(mass="10^24", length="10^9", time="10^7"))
    motion = scene.simulate(samples=2, tol=1e-12, engine="taylor")
    rows = holonom.sweep(scene, values={"k": [1e6 * 1e24 / 1e14]}, keep=["final"], workers=1).to_pandas()
    found = np.array([motion["dot(y)"][-1], rows["dot(y)"][0]]) / 1e9 * 1e7
    assert found == pytest.approx(-np.sin(10**4), abs=1e-12)


FROM_REST = """load("holonom.mac")$
system : holonomic_system(coordinates = [x], parameters = [k], kinetic_energy = dot(x)^2/2, potential_energy = k*x^2/2,
  forces = [{force}])$
push : holonomic_scene(system, parameter_values = [k = {k}], initial_state = [x = 0, dot(x) = {v}],
  time_span = [0, {end}])$
"""


@pytest.mark.parametrize(
    ("force", "k", "v", "end", "reach", "time"),
    [
        ("1", "1", "0", "6283", 2, 1),  # 1 - cos(t)
        ("cos(50*t)", "0", "0", "200", 2 / 2500, 1 / 50),
        ("1 - 1000*dot(x)", "0", "0", "10", 1e-6, 1e-3),  # at first; it continues with its last velocity, 1/1000
        ("if t < 1000 then 0 else 1", "1", "0", "6283", 2, 1),
        ("0", "1", "1/1000", "6283", 1e-3, 1),
        ("0", "0", "1/1000", "6283", 6.283, 6283),
    ],
)
def test_a_motion_from_zero_has_the_size_that_it_reaches(force, k, v, end, reach, time, write_scene):
    text = FROM_REST.format(force=force, k=k, v=v, end=end)
    sizes = nominal_of(motion_problem(write_scene(text), Request(), Limits()))
    assert 1 / 5 <= sizes.state[0] / reach <= 5
    assert 1 / 5 <= sizes.time / time <= 5


@pytest.mark.usefixtures("c_compiler")
def test_a_fast_force_on_a_mass_at_rest_was_followed_with_an_error_of_its_way(write_scene):
    """Truth: x = (1 - cos(50 t))/2500; the error was 2.6 of that, and the motion trusted."""
    text = FROM_REST.format(force="cos(50*t)", k="0", v="0", end="200")
    motion = motion_problem(write_scene(text), Request(), Limits())
    report = simulate(motion, SimulationRequest(engine=EngineName.RUNGE_KUTTA, tol=1e-9, samples=0)).report
    assert report.trusted
    assert report.coordinates["x"] * 2500 == pytest.approx(1 - np.cos(50 * 200), abs=1e-3)


@pytest.mark.parametrize(("start", "force"), [("a", "0"), ("0", "a*k")])
def test_rows_of_a_sweep_were_as_exact_as_the_largest(start, force):
    """Truth: a cos(t) and a (1 - cos(t)); from rest, the error of the first row was 800 times its size."""
    text = FROM_REST.format(force=force, k="1, a = 1", v="0", end="10").replace("[k]", "[k, a]")
    scene = holonom.system(text.replace("x = 0", f"x = {start}"))
    sizes = np.array([1e-12, 1e-9, 1e-5, 1e-3, 1.0, 1e3])
    table = holonom.sweep(scene, values={"a": sizes.tolist()}, keep=["final"], tol=1e-6).to_pandas()
    truth = np.cos(10) if start == "a" else 1 - np.cos(10)
    assert table["status"].tolist() == ["ok"] * len(sizes)
    assert table["x"].to_numpy() / sizes == pytest.approx(truth, abs=1e-4)
