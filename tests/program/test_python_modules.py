"""Python modules for NumPy, JAX and CasADi have the numbers of the motion program, and its derivatives."""

import ast
import subprocess
import sys

import numpy as np
import pytest
from exported import (
    PROGRAMS,
    example,
    law_of,
    lift_by_a_table,
    model_of_program,
    module_of,
    random_arguments,
    spline_of_lift,
    values_of,
)
from hypothesis import HealthCheck, given, settings
from programs import (
    ENDS,
    ENDS_POINTS,
    ENDS_VALUES,
    PENDULUM,
    assume_well_conditioned,
    chain,
    program,
    random_points,
    random_programs,
)
from reference import assert_within_bounds, reference

import holonom
from holonom.failures import ErrorKind, HolonomError
from holonom.program.differentiation import differentiated
from holonom.program.forms import MotionProgram
from holonom.program.model import scene_model
from holonom.program.numpy_function import NumpyFunction
from holonom.program.request import Request
from holonom.program.rewriting import ONE
from holonom.program.targets import MODULES, python_casadi, python_jax, python_numpy
from holonom.sandbox import Limits

casadi = pytest.importorskip("casadi")
jax = pytest.importorskip("jax")
jax.config.update("jax_enable_x64", True)

SCENES = {"crane.mac": ("m", "c"), "arm.mac": (), "spherical_pendulum.mac": (), "whirling_bob.mac": ()}
CLOSE = 1e-13


@pytest.fixture(scope="module", params=SCENES)
def model(request):
    return example(request.param, *SCENES[request.param])


@pytest.fixture(scope="module")
def crane():
    return example("crane.mac", "m", "c")


@pytest.fixture(scope="module")
def lift(tmp_path_factory):
    """Its law is a table."""
    return lift_by_a_table(tmp_path_factory.mktemp("lift") / "scene.mac", "m")


def assert_close(found, expected):
    assert np.shape(found) == np.shape(expected)
    assert np.max(np.abs(found - expected) / (1 + np.abs(expected)), initial=0) < CLOSE


def test_the_modules():
    assert MODULES == ("casadi", "jax", "numpy")


@pytest.mark.parametrize("package", ["numpy", "jax"])
def test_functions_of_arrays(model, package):
    module, arguments = module_of(model, package), random_arguments(model)
    for name, program_of in PROGRAMS.items():
        if (written := program_of(model)) is None:
            assert not hasattr(module, name)
            continue
        assert module.OUTPUTS[name] == tuple(written.outputs)
        assert_close(np.asarray(getattr(module, name)(*arguments)), values_of(written, *arguments))
    t, y, _, p = arguments
    u = law_of(model, t, p)
    assert_close(np.asarray(module.law(t, p)), u)
    n = len(model.coordinates)
    accelerations = values_of(model.motion, t, y, u, p)[:n]
    assert_close(np.asarray(module.rhs(t, y, p)), np.concatenate([y[n:], accelerations]))


def test_functions_of_casadi():
    model = example("crane.mac", "m", "c")
    module, arguments = module_of(model, "casadi"), random_arguments(model)
    t, y, _, p = arguments
    u, n = law_of(model, t, p), len(model.coordinates)
    for name, program_of in PROGRAMS.items():
        if (written := program_of(model)) is not None:
            many = getattr(module, name).map(len(t))
            assert_close(many(t[None], *arguments[1:]).full(), values_of(written, *arguments))
    rates = np.concatenate([y[n:], values_of(model.motion, t, y, u, p)[:n]])
    assert_close(module.rhs.map(len(t))(t[None], y, p).full(), rates)
    assert module.rhs.name_in() == ["t", "y", "p"]


@settings(max_examples=6, suppress_health_check=list(HealthCheck))
@given(random_programs())
def test_random_programs(written):
    assume_well_conditioned(written)
    assert_same_numbers(written)


@pytest.mark.parametrize("written", [PENDULUM, chain(4)], ids=["pendulum", "chain"])
def test_programs_by_hand(written):
    assert_same_numbers(written)


def assert_same_numbers(written):
    points, model = random_points(written), model_of_program(written)
    t, p, nothing = points[0], points[1:], np.empty((0, points.shape[1]))
    forms = {
        "NumPy": module_of(model, "numpy").motion(t, nothing, nothing, p),
        "JAX": np.asarray(module_of(model, "jax").motion(t, nothing, nothing, p)),
        "CasADi": module_of(model, "casadi").motion.map(len(t))(t[None], nothing, nothing, p).full(),
    }
    for index, point in enumerate(points.T):
        expected = reference(written, point.tolist())
        for form, outputs in forms.items():
            assert_within_bounds(form, expected, outputs[:, index])


@pytest.mark.parametrize("package", ["numpy", "jax"])
def test_points_are_broadcast(crane, package):
    module = module_of(crane, package)
    t, y, _, p = random_arguments(crane, points=3)
    found = np.asarray(module.rhs(t[0], y[:, 0], np.stack(np.broadcast_arrays(p[0][:, None], p[1]))))
    assert found.shape == (6, 3, 3)
    assert_close(found[:, 1, 2], np.asarray(module.rhs(t[0], y[:, 0], [p[0][1], p[1][2]])))


@pytest.fixture(scope="module")
def jacobian(crane):
    """The Jacobian of the crane's motion by y and p at one point, by the differentiated program; and the point."""
    names = (*crane.state, *crane.parameters)
    written = differentiated(crane.motion, {name: {name: ONE} for name in names})
    point = [argument[..., 0] for argument in random_arguments(crane)]
    t, *vectors = point
    values = dict(zip(written.outputs, NumpyFunction(written)([t, *np.concatenate(vectors)]), strict=True))
    return np.array([[values[f"d({out}, {name})"] for name in names] for out in crane.motion.outputs]), point


def test_jax_differentiates(crane, jacobian):
    expected, point = jacobian
    module = module_of(crane, "jax")
    for derivative in (jax.jacfwd, jax.jacrev):
        found = jax.jit(derivative(module.motion, argnums=(1, 3)))(*point)
        assert_close(np.concatenate(found, axis=1), expected)
    gradient = jax.grad(lambda p: module.motion(*point[:3], p)[3])(point[3])
    assert_close(np.asarray(gradient), expected[3, 6:])


def test_casadi_differentiates(crane, jacobian):
    expected, point = jacobian
    found = module_of(crane, "casadi").motion.jacobian()(*point, 0)
    assert_close(np.concatenate([found[1].full(), found[3].full()], axis=1), expected)


@pytest.mark.parametrize("x", [-1 / 4, 0.0, 2.0])
def test_the_derivative_of_hertzs_force_was_no_number_without_contact(x, write_scene):
    """The force max(0, -x)^(3/2) was x sqrt(x), and 0/0 its derivative at zero."""
    model = scene_model(
        write_scene("""load("holonom.mac")$
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [max(0, -x)^(3/2)])$
scene : holonomic_scene(system, initial_state = [x = 1, dot(x) = 0])$"""),
        Request(None),
        (),
        Limits(),
    )
    force, u = module_of(model, "jax").motion, np.zeros(0)
    expected = [[-1.5 * max(0.0, -x) ** 0.5, 0.0]]
    for derivative in (jax.jacfwd, jax.jacrev):
        assert_close(np.asarray(derivative(force, 1)(0.0, np.array([x, 1.0]), u, u)), expected)
    y = casadi.SX.sym("y", 2)
    by_casadi = casadi.Function("by", [y], [casadi.jacobian(module_of(model, "casadi").motion(0, y, u, u), y)])
    assert_close(by_casadi([x, 1.0]).full(), expected)


@pytest.mark.parametrize("v", [-0.3, 0.5])
def test_the_derivative_of_a_clipped_root_was_no_number(v):
    scene = holonom.system("""
system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [-5*max(0, dot(x))^(1/2)])$
scene : holonomic_scene(system, initial_state = [x = 1, dot(x) = 0])$""")
    module: dict = {}
    exec(scene.program().to_python("jax"), module)
    found = jax.jacfwd(module["motion"], 1)(0.0, np.array([1.0, v]), np.zeros(0), np.zeros(0))
    assert_close(np.asarray(found), [[0.0, -2.5 / v**0.5 if v > 0 else 0.0]])


@pytest.mark.parametrize("package", ["numpy", "jax"])
def test_a_table_is_the_spline_between_its_points(lift, package):
    module, times = module_of(lift, package), np.linspace(0, 9, 41)
    spline = spline_of_lift()
    expected = [spline(times), spline(times, 1), spline(times, 2)]
    assert_close(np.asarray(module.law(times, module.VALUES)), np.array(expected))


@pytest.mark.parametrize("scene", ["crane", "lift"])
def test_jit_and_vmap(scene, request):
    model = request.getfixturevalue(scene)
    module = module_of(model, "jax")
    t, y, _, p = random_arguments(model)
    many = jax.jit(jax.vmap(module.rhs, in_axes=(0, 1, 1), out_axes=1))
    assert_close(np.asarray(many(t, y, p)), np.asarray(module.rhs(t, y, p)))


def test_the_gradient_of_a_table(lift):
    """The rate that the law has is the derivative of its control."""
    module = module_of(lift, "jax")
    values, rates = jax.jvp(lambda t: module.law(t, module.VALUES), (1.3,), (1.0,))
    assert_close(np.asarray(rates[:2]), np.asarray(values[1:]))


@pytest.mark.parametrize("package", ["numpy", "jax"])
def test_integers_and_single_precision_are_converted(crane, package):
    module = module_of(crane, package)
    y = [0, 1, -3, 0, 0, 0]
    exact = np.asarray(module.rhs(0, np.array(y, float), [100.0, 10.0]))
    for kind in (np.float32, np.int64):
        found = np.asarray(module.rhs(kind(0), np.array(y, kind), np.array([100, 10], kind)))
        assert found.dtype == float
        assert_close(found, exact)


def test_jax_with_single_precision_is_refused(crane, tmp_path):
    file = tmp_path / "crane.py"
    file.write_text(python_jax.write_model(crane, "crane"), encoding="utf-8")
    run = subprocess.run(
        [sys.executable, "-c", "import crane; crane.rhs(0.0, crane.Y0, crane.VALUES)"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert run.returncode == 1
    assert run.stderr.splitlines()[-1].startswith("TypeError: ")
    assert "jax_enable_x64" in run.stderr


@pytest.mark.parametrize("package", ["numpy", "jax"])
@pytest.mark.parametrize("vector", ["y", "u", "p"])
@pytest.mark.parametrize("more", [-1, 1])
def test_a_vector_of_another_length_moved_those_behind_it(crane, package, vector, more):
    arguments = dict(zip("tyup", random_arguments(crane), strict=True))
    arguments[vector] = np.ones((len(arguments[vector]) + more, 7))
    with pytest.raises(ValueError, match=vector):
        module_of(crane, package).motion(**arguments)


@pytest.mark.parametrize("package", MODULES)
def test_there_is_no_value_where_functions_of_the_time_have_ended(package):
    motion = module_of(model_of_program(ENDS), package).motion
    found = [float(motion(t, np.empty(0), np.empty(0), np.array([a]))[0]) for t, a in ENDS_POINTS.T]
    assert found == ENDS_VALUES


def test_the_time_has_derivatives_until_functions_of_it_end():
    motion = module_of(model_of_program(ENDS), "jax").motion
    slope = jax.grad(lambda t: motion(t, np.empty(0), np.empty(0), np.array([2.0]))[0])
    assert [slope(t) for t in (-1.0, 0.0)] == [2.0, 2.0]


def test_a_table_is_refused_to_casadi(lift):
    with pytest.raises(HolonomError) as caught:
        python_casadi.write_model(lift, "lift")
    assert caught.value.kind is ErrorKind.NO_TABLES


@pytest.mark.parametrize(("form", "package"), [("c", "jax"), ("python", "torch"), ("json", "numpy")])
def test_a_module_goes_with_python_alone(form, package):
    with pytest.raises(HolonomError) as caught:
        MotionProgram(None, Request(None), Limits()).written(form, package=package)
    assert caught.value.kind is ErrorKind.NO_SUCH_MODULE


def test_a_control_without_a_law_leaves_law_and_rhs_out(write_scene):
    file = write_scene("""load("holonom.mac")$
system : holonomic_system(coordinates = [x], controls = [u], kinetic_energy = dot(x)^2/2, forces = [pull = [u]])$
free : holonomic_scene(system, initial_state = [x = 0, dot(x) = 0])$""")
    module = module_of(scene_model(file, Request(), (), Limits()), "numpy")
    assert module.motion(0, [1, 2], [3, 0, 0], []) == [3]
    assert not hasattr(module, "law")
    assert not hasattr(module, "rhs")


def test_names_cannot_end_what_they_stand_in():
    written = program(["t", 'a"; */ \\'], [("w", ["Negate", 'a"; */ \\'])], {'"""': "w"})
    tree = ast.parse(python_numpy.write_model(model_of_program(written), "scene"))
    assert ast.get_docstring(tree)
    module = module_of(model_of_program(written), "numpy")
    assert (module.PARAMETERS, module.OUTPUTS["motion"]) == (('a"; */ \\',), ('"""',))
    assert module.motion(0, [], [], [2.0]) == [-2.0]


@pytest.mark.parametrize(("condition", "holds"), [("<", 0), ("<=", 1), (">", 0), (">=", 1)])
def test_at_a_tie_the_values_were_the_mean_of_both_branches(condition, holds, write_scene):
    scene = write_scene(f"""load("holonom.mac")$
    system : holonomic_system(coordinates = [x], controls = [u],
      kinetic_energy = dot(x)^2/2, forces = [u + if x {condition} 0 then 10 else 20])$
    s : holonomic_scene(system, control_law = [u = if t {condition} 1 then 2*t + abs(t - 1) else 5*t],
      initial_state = [x = 1, dot(x) = 0], time_span = [0, 2])$""")
    module = module_of(scene_model(scene, Request(), (), Limits()), "numpy")
    assert np.ravel(module.law(1.0, ()))[:2].tolist() == ([2, 2] if holds else [5, 5])
    assert np.ravel(module.motion(1.0, np.zeros(2), np.zeros(3), ())[0]).tolist() == [10 if holds else 20]
