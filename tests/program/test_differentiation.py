"""Derivatives of programs, against differences in 40 digits of the same program; solutions against `differentiated`."""

from fractions import Fraction
from pathlib import Path
from random import Random

import mpmath
import pytest

from holonom.program.arithmetic import Arithmetic, run_program
from holonom.program.differentiation import along, derivative_name, differentiated, solution_differentiated
from holonom.program.motion_problem import motion_problem
from holonom.program.motion_program import CALLED, Call, Constant, Name, Operation, Program
from holonom.program.request import Request
from holonom.program.sign_pattern import at_start
from holonom.sandbox import Limits

POINT = {"x": Fraction(3, 7), "y": Fraction(5, 9), "t": Fraction(1, 3)}
ABOVE_ONE = {Operation.ARCOSH}
NUMBERS = Arithmetic(
    number=lambda number: mpmath.mpf(number.numerator) / number.denominator,
    constants={Constant.PI: mpmath.pi, Constant.E: mpmath.e},
    power=lambda base, exponent: base ** (mpmath.mpf(exponent.numerator) / exponent.denominator),
    operations={Operation(each.head): each.of(mpmath.mp) for each in CALLED}
    | {
        Operation.ADD: lambda *terms: mpmath.fsum(terms),
        Operation.MULTIPLY: lambda *factors: mpmath.fprod(factors),
        Operation.SUBTRACT: lambda a, b: a - b,
        Operation.DIVIDE: lambda a, b: a / b,
        Operation.NEGATE: lambda a: -a,
        Operation.POWER: lambda a, b: a**b,
    },
)


def program_of(*assignments: Call) -> Program:
    named = tuple((f"w{place}", call) for place, call in enumerate(assignments))
    return Program(None, "direct", "schur", tuple(POINT), named, {"out": Name(named[-1][0])})


def derivatives(program: Program) -> dict[str, mpmath.mpf]:
    """Derivatives by x, y and t, x and y being inputs that move, t one that moves by itself."""
    found = differentiated(program, along(("x", "y"), ("x", "y")) | {"t": {"t": Fraction(1)}})
    inputs = {name: NUMBERS.number(value) for name, value in POINT.items()}
    moves = {derivative_name(a, b): mpmath.mpf(a == b) for a in "xy" for b in "xy"}
    values = run_program(found, inputs | moves, NUMBERS)
    assert values["out"] == pytest.approx(run_program(program, inputs, NUMBERS)["out"], rel=1e-38)
    return {name: values[derivative_name("out", name)] for name in POINT}


def by_differences(program: Program, name: str) -> mpmath.mpf:
    inputs = {each: NUMBERS.number(value) for each, value in POINT.items()}
    return mpmath.diff(lambda value: run_program(program, {**inputs, name: value}, NUMBERS)["out"], inputs[name])


@pytest.fixture(autouse=True)
def forty_digits():
    with mpmath.workdps(40):
        yield


def agree(program: Program) -> None:
    for name, found in derivatives(program).items():
        assert abs(found - by_differences(program, name)) <= 1e-15 * max(1, abs(found)), name


@pytest.mark.parametrize("operation", [*Operation])
def test_every_operation(operation):
    x, y, t = map(Name, POINT)
    inner = Call(Operation.ADD, (Call(Operation.MULTIPLY, (x, x, y)), t, Fraction(operation in ABOVE_ONE)))
    two = operation in {Operation.SUBTRACT, Operation.DIVIDE, Operation.POWER, Operation.ARCTAN2}
    several = operation in {Operation.ADD, Operation.MULTIPLY}
    agree(program_of(inner, Call(operation, (Name("w0"), *([y] if two else [y, t, x] if several else [])))))


@pytest.mark.parametrize(
    "exponent", [Fraction(0), Fraction(1), Fraction(2), Fraction(5), Fraction(-3), Fraction(-1, 2)]
)
def test_powers_with_numbers(exponent):
    agree(program_of(Call(Operation.POWER, (Call(Operation.MULTIPLY, (Name("x"), Name("t"))), exponent))))


@pytest.mark.parametrize("seed", range(40))
def test_random_programs(seed):
    random, values = Random(seed), [*map(Name, POINT), Fraction(2, 3), Constant.PI]
    safe = Operation.SIN, Operation.COS, Operation.TANH, Operation.ERF, Operation.ARCTAN, Operation.ARSINH
    calls = []
    for place in range(12):
        operation = random.choice([*safe, Operation.ADD, Operation.MULTIPLY, Operation.SUBTRACT, Operation.NEGATE])
        count = {Operation.ADD: 3, Operation.MULTIPLY: 3, Operation.SUBTRACT: 2}.get(operation, 1)
        calls.append(Call(operation, tuple(random.choice(values[-6:] + values[:3]) for _ in range(count))))
        values.append(Name(f"w{place}"))
    agree(program_of(*calls))


def test_what_does_not_move_costs_nothing():
    program = program_of(Call(Operation.SIN, (Name("y"),)), Call(Operation.MULTIPLY, (Name("w0"), Name("x"))))
    found = differentiated(program, {"x": {"x": Fraction(1)}})
    assert found.operations == program.operations


EXAMPLES = Path(__file__).parents[2] / "examples"
SYSTEMS = {  # under a singular mass matrix, servo-constraints, repeated constraints, a law in parts
    "heavy_top.mac": ("m", "I1"),
    "level_load.mac": ("m", "g"),
    "hard/repeated_constraint.mac": ("m", "l"),
    "hoist.mac": ("m", "g"),
    "pendulum.mac": ("m", "g"),
    "satellite.mac": ("M", "m"),
    "overhead_crane.mac": ("m", "g"),
    "linkage.mac": ("m", "g"),
}
QUICK = ("heavy_top.mac", "level_load.mac", "hard/repeated_constraint.mac", "hoist.mac")


@pytest.mark.parametrize(
    "file", [*QUICK, *(pytest.param(each, marks=pytest.mark.long) for each in SYSTEMS if each not in QUICK)]
)
def test_derivatives_of_a_solution_are_those_of_its_program(file):
    names = SYSTEMS[file]
    problem = at_start(motion_problem(EXAMPLES / file, Request(derivatives=True), Limits(), open_parameters=names))
    directions = *(name for name in names if name in problem.parameters), *problem.state[::5]
    own = {name: {name: Fraction(1)} for name in problem.parameters}
    seeds = along(problem.state, directions) | own
    plain = differentiated(problem.motion, seeds)
    solved = solution_differentiated(problem.response, problem.matrices, seeds)
    assert set(plain.outputs) >= set(solved.outputs)
    random = Random(file)
    inputs = {name: NUMBERS.number(Fraction(random.randint(20, 40), 31)) for name in plain.inputs}
    values, truth = (run_program(program, inputs, NUMBERS) for program in (solved, plain))
    for name, value in values.items():
        assert abs(value - truth[name]) <= 1e-20 * max(1, abs(truth[name])), name
    assert any(values[derivative_name(f"ddot({q})", k)] for q in problem.coordinates for k in directions)


def test_a_factored_matrix_is_not_differentiated():
    problem = at_start(motion_problem(EXAMPLES / "heavy_top.mac", Request(derivatives=True), Limits()))
    seeds = along(problem.state, problem.state)
    plain = differentiated(problem.motion, seeds)
    solved = solution_differentiated(problem.response, problem.matrices, seeds)
    assert solved.operations < 0.6 * plain.operations
