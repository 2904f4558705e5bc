"""Every form of a program gives the same numbers, to the rounding errors that its operations make."""

import math

import mpmath
import numpy as np
import pytest
import sympy
from hypothesis import HealthCheck, given, settings
from programs import (
    ENDS,
    ENDS_POINTS,
    ENDS_VALUES,
    PENDULUM,
    assume_well_conditioned,
    chain,
    heyoka_function,
    program,
    random_points,
    random_programs,
)
from reference import assert_within_bounds, reference

import holonom
from holonom.program.c_function import compile_c
from holonom.program.numpy_function import NumpyFunction
from holonom.program.targets import python


def python_function(written):
    """The function of a program's Python source, run as its reader would."""
    module = {}
    exec(python.write(written), module)
    return module["motion"]


def every_form(written):
    """Arrays of outputs, shape (outputs, points), by the name of the form that computed them."""
    points = random_points(written)
    c, compiled, python = compile_c(written), heyoka_function(written), python_function(written)
    return points, {
        "NumPy": NumpyFunction(written)(points),
        "C, many points": c(points),
        "C, one point": np.column_stack([c(point) for point in points.T]),
        "heyoka, many points": compiled(points),
        "heyoka, one point": np.column_stack([compiled(point) for point in points.T]),
        "Python": np.column_stack([python(point.tolist()) for point in points.T]).astype(float),
    }


def assert_same_numbers(written):
    points, forms = every_form(written)
    for index, point in enumerate(points.T):
        expected = reference(written, point.tolist())
        for form, outputs in forms.items():
            assert_within_bounds(form, expected, outputs[:, index])


@pytest.mark.parametrize("written", [PENDULUM, chain(1), chain(2), chain(12)], ids=["pendulum", "1", "2", "12"])
def test_programs_by_hand(written):
    assert_same_numbers(written)


def test_there_is_no_value_where_functions_of_the_time_have_ended():
    c, python = compile_c(ENDS), python_function(ENDS)
    assert NumpyFunction(ENDS)(ENDS_POINTS)[0].tolist() == ENDS_VALUES
    assert c(ENDS_POINTS)[0].tolist() == ENDS_VALUES
    assert [c(point)[0] for point in ENDS_POINTS.T] == ENDS_VALUES
    assert [python(point.tolist())[0] for point in ENDS_POINTS.T] == ENDS_VALUES
    assert [float(python(list(map(mpmath.mpf, point)), mpmath)[0]) for point in ENDS_POINTS.T] == ENDS_VALUES
    assert python(sympy.symbols("t a"), sympy) == [sympy.Mul(*sympy.symbols("t a"))]


@settings(max_examples=8, suppress_health_check=list(HealthCheck))
@given(random_programs())
def test_random_programs(written):
    assume_well_conditioned(written)
    assert_same_numbers(written)


@pytest.mark.long
@settings(max_examples=60, suppress_health_check=list(HealthCheck))
@given(random_programs())
def test_many_random_programs(written):
    assume_well_conditioned(written)
    assert_same_numbers(written)


@pytest.mark.parametrize("terms", [1000, pytest.param(5000, marks=pytest.mark.long)])
def test_sums_of_thousands_of_terms(terms):
    """The energy of a long chain is one sum."""
    written = program(["a"], [("w", ["Add", *(["Multiply", k, "a"] for k in range(1, terms + 1))])], {"out": "w"})
    exact = terms * (terms + 1) / 2
    for function in (NumpyFunction(written), compile_c(written), heyoka_function(written)):
        assert function(np.array([1.0]))[0] == pytest.approx(exact, rel=1e-15)


def test_compact_mode_gives_the_same_numbers():
    written = chain(3)
    points = random_points(written)
    plain, compact = (heyoka_function(written, compact=compact)(points) for compact in (False, True))
    assert compact == pytest.approx(plain, rel=1e-9)


def test_python_source_keeps_rationals_exact_for_many_digits():
    written = program(["a"], [("w", ["Multiply", ["Rational", 1, 3], "a"])], {"out": "w"})
    with mpmath.workdps(60):
        assert python_function(written)([mpmath.mpf(3)], mpmath) == [1]


@pytest.mark.parametrize("operation", ["Subtract", "Divide"])
def test_python_source_refused_rationals_before_numbers_of_mpmath(operation):
    written = program(["a"], [("w", [operation, ["Rational", 1, 3], "a"])], {"out": "w"})
    exact = {"Subtract": mpmath.mpf(1) / 3 - 2, "Divide": mpmath.mpf(1) / 6}[operation]
    assert python_function(written)([mpmath.mpf(2)], mpmath) == [exact]


def test_python_source_took_the_absolute_value_of_a_complex_root():
    written = program(["a"], [("w", ["Abs", ["Subtract", ["Power", "a", ["Rational", 1, 4]], 2]])], {"out": "w"})
    assert python_function(written)([81.0]) == [1]
    with pytest.raises(ValueError, match="domain"):
        python_function(written)([-81.0])


def test_a_singular_pivot_gives_no_finite_number():
    written = program(["a"], [("w", ["Divide", 1, "a"])], {"out": "w"})
    for function in (NumpyFunction(written), compile_c(written), heyoka_function(written)):
        assert function(np.array([0.0]))[0] == math.inf


def test_python_source_refused_the_sign_of_a_number_of_numpy():
    written = program(["a"], [("w", ["Sign", "a"])], {"out": "w"})
    assert [python_function(written)([np.float64(a)]) for a in (-2.5, 0, 3)] == [[-1], [0], [1]]
    assert math.isnan(python_function(written)([math.nan])[0])


@pytest.mark.parametrize(
    ("force", "state", "acceleration"),
    [
        ("min(10, x^(-12))", [0.03, 0], 10),
        ("-min(x, 10^17)", [1 / 3, 0], -1 / 3),
        ("max(10^20, y)", [1, -3], 1e20),
        ("-max(0, x*y)^(3/2)", [-0.3398979866895011, 0.6802731130757278], 0),
        ("min(x*y, 0)^(1/3)", [0.6174414858368353, 0.8261558909994002], 0),
    ],
)
def test_what_is_less_or_greater_lost_its_digits_to_the_other(force, state, acceleration):
    scene = holonom.system(f"""system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
      forces = [{force}, 0])$
      scene : holonomic_scene(system, initial_state = [x = 1, y = 1, dot(x) = 0, dot(y) = 0])$""")
    written = scene.program().program
    point = np.array([0.0, *state, 0.0, 0.0])
    for function in (NumpyFunction(written), compile_c(written), heyoka_function(written), python_function(written)):
        assert function(point)[0] == pytest.approx(acceleration, rel=1e-15)


@pytest.mark.parametrize(("x", "acceleration"), [(-1, 3), (4, -4)])
def test_a_branch_that_is_not_taken_has_a_value(x, acceleration):
    """sqrt(-1) times zero is no number."""
    scene = holonom.system("""system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2,
      forces = [if x > 0 then -2*sqrt(x) else -3*x])$
      scene : holonomic_scene(system, initial_state = [x = 1, dot(x) = 0])$""")
    written = scene.program().program
    for function in (NumpyFunction(written), compile_c(written), heyoka_function(written), python_function(written)):
        assert function(np.array([0.0, x, 0.0]))[0] == pytest.approx(acceleration)
