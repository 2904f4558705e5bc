"""Every elementary function, by every route that a system takes, against mpmath.

For each function f, on its own coordinate x: T = dot(x)^2/2, V = f(a + x/4), and a drive f(a + t/4), with a inside the
domain of f. So ddot(x) = f(a + t/4) - f'(a + x/4)/4, and the derivative is Maxima's. Everything is asked once of all.
"""

import mpmath
import numpy as np
import pytest
import sympy
from programs import heyoka_function
from refusing import refused

import holonom
from holonom.crosscheck.report import Verdict
from holonom.program.c_function import compile_c
from holonom.program.numpy_function import NumpyFunction
from holonom.program.targets import python

ORDER, DIGITS = 12, 25

# In Maxima's notation of x: the function of mpmath, and a.
FUNCTIONS = {
    "sin(x)": (mpmath.sin, "1/3"),
    "cos(x)": (mpmath.cos, "1/3"),
    "tan(x)": (mpmath.tan, "1/3"),
    "sec(x)": (mpmath.sec, "1/3"),
    "csc(x)": (mpmath.csc, "4/3"),
    "cot(x)": (mpmath.cot, "4/3"),
    "asin(x)": (mpmath.asin, "1/5"),
    "acos(x)": (mpmath.acos, "1/5"),
    "atan(x)": (mpmath.atan, "1/5"),
    "asec(x)": (mpmath.asec, "-9/4"),
    "acsc(x)": (mpmath.acsc, "9/4"),
    "acot(x)": (mpmath.acot, "-9/4"),
    "sinh(x)": (mpmath.sinh, "1/3"),
    "cosh(x)": (mpmath.cosh, "1/3"),
    "tanh(x)": (mpmath.tanh, "1/3"),
    "sech(x)": (mpmath.sech, "1/3"),
    "csch(x)": (mpmath.csch, "-4/3"),
    "coth(x)": (mpmath.coth, "4/3"),
    "asinh(x)": (mpmath.asinh, "1/3"),
    "acosh(x)": (mpmath.acosh, "9/4"),
    "atanh(x)": (mpmath.atanh, "1/5"),
    "asech(x)": (mpmath.asech, "1/2"),
    "acsch(x)": (mpmath.acsch, "-4/3"),
    "acoth(x)": (mpmath.acoth, "9/4"),
    "exp(x)": (mpmath.exp, "1/3"),
    "log(x)": (mpmath.log, "9/4"),
    "erf(x)": (mpmath.erf, "1/3"),
    "sqrt(1 + sin(x))": (lambda x: mpmath.sqrt(1 + mpmath.sin(x)), "1/3"),
    "atan2(x, x^2 - 2)": (lambda x: mpmath.atan2(x, x**2 - 2), "4/5"),
    "abs(x)*x^2": (lambda x: abs(x) * x**2, "-4/3"),
    "signum(x)*x": (abs, "-4/3"),
    "2^x*x^x": (lambda x: 2**x * x**x, "9/4"),
}
NAMES = {written: f"x{index}" for index, written in enumerate(FUNCTIONS, start=1)}
STATE = 0.07  # every coordinate, not far from zero


def at(written, variable):
    """The function of a + variable/4, as Maxima's text."""
    place = f"({FUNCTIONS[written][1]} + {variable}/4)"
    return "".join(place if c == "x" and not _within_a_word(written, i) else c for i, c in enumerate(written))


def _within_a_word(text, index):
    return text[index - 1 : index].isalpha() or text[index + 1 : index + 2].isalpha()


def system_of_all(scenes):
    return holonom.system(f"""
        system : holonomic_system(
          coordinates = [{", ".join(NAMES.values())}],
          kinetic_energy = {" + ".join(f"dot({x})^2/2" for x in NAMES.values())},
          potential_energy = [field = {" + ".join(at(written, x) for written, x in NAMES.items())}],
          forces = [drive = [{", ".join(at(written, "t") for written in NAMES)}]])$
        {scenes}""")


START = ", ".join(f"{x} = 0, dot({x}) = 0" for x in NAMES.values())
DRIVEN = f"driven : holonomic_scene(system, effects = [drive], observe = [trajectory], initial_state = [{START}])$"
EVERYTHING = f"everything : holonomic_scene(system, initial_state = [{START}])$"


@pytest.fixture(scope="module")
def scene():
    return system_of_all(DRIVEN + EVERYTHING)


@pytest.fixture(scope="module")
def record(scene):
    return scene.record


@pytest.fixture(scope="module")
def accelerations(scene):
    """By the form of the program, ddot(x) of each function at t = 1/2 and one state."""
    program = scene.program().program
    given = [0.5 if name == "t" else 0.0 if name.startswith("dot(") else STATE for name in program.inputs]
    module = {}
    exec(python.write(program), module)
    forms = {
        "C": compile_c(program)(given),
        "NumPy": NumpyFunction(program)(given),
        "heyoka": heyoka_function(program)(np.array(given)),
        "Python": module["motion"](given),
    }
    return {form: dict(zip(program.outputs, values, strict=True)) for form, values in forms.items()}


@pytest.fixture(scope="module")
def series(scene):
    driven = holonom.Scene(scene.file, "driven", {}, scene.limits)
    return driven.series(ORDER, DIGITS).coordinates


def exact(written):
    function, place = FUNCTIONS[written]
    return function, mpmath.mpf(sympy.Rational(place).p) / sympy.Rational(place).q


@pytest.mark.parametrize("form", ["C", "NumPy", "heyoka", "Python"])
@pytest.mark.parametrize("written", FUNCTIONS)
def test_program(written, form, accelerations):
    function, a = exact(written)
    truth = function(a + mpmath.mpf(1) / 8) - mpmath.diff(function, a + mpmath.mpf(STATE) / 4) / 4
    assert accelerations[form][f"ddot({NAMES[written]})"] == pytest.approx(float(truth), rel=1e-13, abs=1e-14)


@pytest.mark.parametrize("written", FUNCTIONS)
def test_series(written, series):
    with mpmath.workdps(60):
        function, a = exact(written)
        taylor = mpmath.taylor(lambda t: function(a + t / 4), 0, ORDER - 2)
        found = [mpmath.mpf(c) for c in series[NAMES[written]][2:]]
        for n, (coefficient, truth) in enumerate(zip(found, taylor, strict=True)):
            assert abs(coefficient * (n + 1) * (n + 2) - truth) <= mpmath.mpf(10) ** (2 - DIGITS) * (1 + abs(truth))


@pytest.mark.parametrize("written", FUNCTIONS)
def test_record(written, record):
    """The potential energy comes back as SymPy's own function of the same name."""
    (effect,) = record.system.potential_energy
    function, a = exact(written)
    x = sympy.Symbol(NAMES[written], real=True)
    (part,) = [term for term in sympy.Add.make_args(effect.value) if x in term.free_symbols]
    assert float(part.subs(x, sympy.Rational(7, 100)).evalf(20)) == pytest.approx(
        float(function(a + mpmath.mpf(STATE) / 4)), rel=1e-14
    )


def test_as_laws_tangents_and_reciprocals_of_functions_were_refused():
    """A law's rates are Maxima's, among them sec of a tangent: of ddot(x) = f(a + t/4), dot(x) is an integral of f."""
    controls = [f"u{index}" for index in range(1, len(FUNCTIONS) + 1)]
    names = NAMES.values()
    motion = holonom.system(f"""
        system : holonomic_system(coordinates = [{", ".join(names)}], controls = [{", ".join(controls)}],
          kinetic_energy = {" + ".join(f"dot({x})^2/2" for x in names)}, forces = [{", ".join(controls)}])$
        driven : holonomic_scene(system, time_span = [0, 1],
          control_law = [{", ".join(f"{u} = {at(f, 't')}" for u, f in zip(controls, FUNCTIONS, strict=True))}],
          initial_state = [{", ".join(f"{x} = 0, dot({x}) = 0" for x in names)}])$""").simulate(samples=2)
    for written, name in NAMES.items():
        function, a = exact(written)
        truth = mpmath.quad(lambda t, f=function, a=a: f(a + t / 4), [0, 1])
        assert float(motion.report.velocities[f"dot({name})"]) == pytest.approx(float(truth), rel=1e-13), written


@pytest.mark.parametrize(
    "scenes", [pytest.param(DRIVEN, id="driven"), pytest.param(EVERYTHING, id="everything", marks=pytest.mark.long)]
)
def test_check(scenes):
    verdicts = system_of_all(scenes).check().verdicts
    (equations_of_motion,) = (found.verdict for found in verdicts if found.id == "lagrange_equations")
    assert equations_of_motion in {Verdict.PROVED, Verdict.AGREES, Verdict.SAMPLED}
    assert Verdict.DISAGREES not in {found.verdict for found in verdicts}


def test_signum_is_constant_between_its_jumps():
    """Equation (18) differentiates it; SymPy's impulse at the jump is none at the points where the two are compared."""
    scene = holonom.system("""
        system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [t - signum(dot(x))*x])$
        scene : holonomic_scene(system, initial_state = [x = 1, dot(x) = 1])$""")
    found = {verdict.number: verdict.verdict for verdict in scene.check().verdicts}
    assert {found["13"], found["18"]} <= {Verdict.PROVED, Verdict.AGREES}


def test_a_function_that_no_program_has_is_refused_by_its_name_and_its_place():
    scene = holonom.system("""
        system : holonomic_system(coordinates = [x], kinetic_energy = dot(x)^2/2, forces = [expintegral_si(2 + t)])$""")
    with refused("function_not_described"):
        scene.program().document  # noqa: B018
