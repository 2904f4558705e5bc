"""The motion program, compared with the equations of motion: right ones agree, and every wrong one is found."""

import math
import random
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from holonom.crosscheck.motion_program import ScenePrograms, verify_programs, why_missing
from holonom.crosscheck.motions import read_motions
from holonom.crosscheck.questions import ask_for_check
from holonom.crosscheck.report import Verdict
from holonom.failures import ErrorKind, HolonomError
from holonom.program.motion_problem import MotionProblem
from holonom.program.motion_program import Call, Name, Operation, Program
from holonom.program.request import Solve
from holonom.source import Source

EXAMPLES = Path(__file__).parents[2] / "examples"
# A law of one control, tables, servo-constraints of relative degree 4, prescribed reactions, redundant constraints,
# a mass matrix that the constraints make up for, signs that switch; servo-constraints of a control in a constraint.
FILES = (
    *("paper/paper", "hoist", "overhead_crane", "prescribed_tension", "hard/repeated_constraint", "linkage", "bead"),
    "level_load",
)
MUTATED = ("paper/paper", "pendulum", "arm", "crane", "prescribed_tension", "level_load")
EACH = 12  # mutants of each file
PROGRAMS = ("motion", "projection", "matrices", "energy")
OPEN = """
load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], controls = [u], parameters = [m, k], kinetic_energy = m*(dot(x)^2 +
  dot(y)^2)/2, potential_energy = k*x^4, forces = [drag = [-abs(dot(x))*dot(x), 0]], constraints = [y - sin(u*x)])$
"""
PENDULUM = """
load("holonom.mac")$
system : holonomic_system(coordinates = [x, y], kinetic_energy = (dot(x)^2 + dot(y)^2)/2, potential_energy = 10*y,
  constraints = [x^2 + y^2 - 1])$
swing : holonomic_scene(system, initial_state = [x = 3/5, y = -4/5, dot(x) = 0, dot(y) = 0], time_span = [0, 1])$
"""
KINDS = """
load("holonom.mac")$
system : holonomic_system(coordinates = [r, x, z], controls = [u, w, F], kinetic_energy = (dot(r)^2 + dot(x)^2 +
  dot(z)^2)/2, potential_energy = x^2*z, forces = [0, 0, F], constraints = [r - u - r*x/2, x*z - w])$
run : holonomic_scene(system, prescribed_reactions = [lambda1 = t], servo_constraints = [x = 1 + t^2, z = 2 + t^3],
  initial_state = [r = 1, dot(r) = 0, x = 1, z = 2], time_span = [0, 1])$
"""
ROUNDING = 1e-13
SINES = {
    "Sin": math.sin,
    "Cos": math.cos,
    "Exp": math.exp,
    "Sqrt": math.sqrt,
    "Abs": abs,
    "Tan": math.tan,
    "Sign": lambda x: (x > 0) - (x < 0),
}


def asked(file: Path) -> tuple[Source, list[ScenePrograms]]:
    source = Source(file)
    return source, read_motions(source.description(), ask_for_check(source, {})).programs


@pytest.fixture(scope="module")
def programs() -> dict[str, tuple[Source, list[ScenePrograms]]]:
    return {name: asked(EXAMPLES / f"{name}.mac") for name in dict.fromkeys((*FILES, *MUTATED))}


@pytest.mark.parametrize("name", FILES)
def test_right_programs_agree(programs, name):
    source, written = programs[name]
    found = verify_programs(source.description(), written, name)
    assert {each.found.verdict for each in found} == {Verdict.AGREES}
    assert {each.scene for each in found} == {scene.name for scene in source.description().scenes}
    assert {(each.found.digits, each.found.points) for each in found} == {(50, 8)}


def test_a_program_whose_controls_are_open_agrees(write_scene):
    source, written = asked(write_scene(OPEN))
    found = verify_programs(source.description(), written, "open")
    assert [each.found.verdict for each in found] == [Verdict.AGREES] * len(Solve)
    drag = replace(source.description(), content=without_drag(source.description().content))
    assert [each.found.verdict for each in verify_programs(drag, written, "open")] == [Verdict.DISAGREES] * len(Solve)


def without_drag(content: dict) -> dict:
    return content | {"system": content["system"] | {"forces": []}}


def test_reactions_beside_servo_constraints_agree(write_scene):
    """The multiplier of a servo-constraint, which is zero, is looked at too."""
    source, (written,) = asked(write_scene(KINDS))
    assert {each.found.verdict for each in verify_programs(source.description(), [written], "kinds")} == {
        Verdict.AGREES
    }
    problem = written.problems[Solve.DIRECT]
    for name in ("ddot(u)", "ddot(w)", "lambda1", "lambda2", "lambda3"):
        outputs = problem.motion.outputs | {name: Name("x")}
        wrong = replace(problem, motion=replace(problem.motion, outputs=outputs))
        found = verify_programs(source.description(), [replace(written, problems={Solve.DIRECT: wrong})], name)
        assert Verdict.DISAGREES in {each.found.verdict for each in found}, name


@pytest.mark.parametrize(
    ("solve", "verdict"), [(Solve.DIRECT, Verdict.DISAGREES), (Solve.ORTHOGONAL, Verdict.UNDECIDED)]
)
def test_a_program_of_a_regular_motion_has_values(write_scene, solve, verdict):
    """The orthogonal solve, which needs positive masses, may have none."""
    source, (scene,) = asked(write_scene(PENDULUM))
    problem = scene.problems[solve]
    name = problem.motion.assignments[0][0]
    lost = ((name, Call(Operation.DIVIDE, (Fraction(1), Fraction(0)))), *problem.motion.assignments[1:])
    wrong = replace(problem, motion=replace(problem.motion, assignments=lost))
    found = verify_programs(source.description(), [replace(scene, problems={solve: wrong})], "lost")
    assert verdict in {each.found.verdict for each in found}
    assert verdict is Verdict.DISAGREES or Verdict.DISAGREES not in {each.found.verdict for each in found}


@pytest.mark.parametrize("name", MUTATED)
def test_every_wrong_program_is_found(programs, name):
    source, written = programs[name]
    draw, missed, made = random.Random(name), [], 0
    while made < EACH:
        scene = draw.choice(written)
        solve = draw.choice([each for each in scene.problems if scene.problems[each].motion is not None])
        which = draw.choice(PROGRAMS)
        wrong = mutated(getattr(scene.problems[solve], which), draw)
        right = getattr(scene.problems[solve], which)
        if wrong is None or same_values(right, wrong):
            continue
        if scene.scene == "thrown_scene" or not looked_at(source, scene.scene, which):
            continue
        made += 1
        changed = replace(scene, problems=scene.problems | {solve: replace(scene.problems[solve], **{which: wrong})})
        found = verify_programs(source.description(), [changed], f"{name} {made}")
        if all(each.found.verdict is not Verdict.DISAGREES for each in found):
            missed.append((scene.scene, solve, which, [each.found for each in found]))
    assert missed == []


def looked_at(source: Source, scene: str, which: str) -> bool:
    """Of prescribed reactions the projection is not compared with its definition."""
    described = next(each for each in source.description().scenes if each.name == scene)
    return which != "projection" or not described.prescribed_reactions


def mutated(program: Program, draw: random.Random) -> Program | None:
    """The program with one operation of one assignment changed; None where there is nothing to change."""
    places = [place for place, (_, expression) in enumerate(program.assignments) if isinstance(expression, Call)]
    if not places:
        return None
    place = draw.choice(places)
    name, expression = program.assignments[place]
    before = [*program.inputs, *(each for each, _ in program.assignments[:place])]
    wrong = changed(expression, before, draw)
    return replace(
        program, assignments=(*program.assignments[:place], (name, wrong), *program.assignments[place + 1 :])
    )


def changed(expression, names: list[str], draw: random.Random):
    match expression:
        case Call(operation, arguments) if draw.random() < 0.6:
            place = draw.randrange(len(arguments))
            other = changed(arguments[place], names, draw)
            return Call(operation, (*arguments[:place], other, *arguments[place + 1 :]))
        case Call(Operation.ADD, arguments):
            return Call(Operation.ADD, (Call(Operation.NEGATE, (arguments[0],)), *arguments[1:]))
        case Call(Operation.SUBTRACT, arguments):
            return Call(Operation.ADD, arguments)
        case Call(Operation.SIN, arguments):
            return Call(Operation.COS, arguments)
        case Fraction():
            return expression + draw.choice([1, Fraction(1, 10**12), -expression / 10**6])
        case Name():
            return Name(draw.choice(names))
        case _:
            return Call(Operation.NEGATE, (expression,))


def same_values(right: Program, wrong: Program) -> bool:
    """Whether two programs give the same in double precision and exact rationals, without the package's evaluation."""
    for seed in range(3):
        draw = random.Random(seed)
        inputs = {name: Fraction(draw.randint(1, 1000), 500) for name in right.inputs}
        try:
            pairs = zip(values(right, inputs), values(wrong, inputs), strict=True)
            if any(abs(a - b) > ROUNDING * max(1, abs(a), abs(b)) for a, b in pairs):
                return False
        except (ValueError, ZeroDivisionError, OverflowError, TypeError):
            continue
    return True


def values(program: Program, inputs: dict) -> list:
    known = dict(inputs)
    for name, expression in program.assignments:
        known[name] = value(expression, known)
    return [value(each, known) for each in program.outputs.values()]


def value(expression, known: dict):
    match expression:
        case Name(text):
            return known[text]
        case Fraction():
            return expression
        case Call(operation, arguments):
            x = [value(each, known) for each in arguments]
            match operation:
                case Operation.ADD:
                    return sum(x)
                case Operation.MULTIPLY:
                    return math.prod(x)
                case Operation.SUBTRACT:
                    return x[0] - x[1]
                case Operation.DIVIDE:
                    return x[0] / x[1]
                case Operation.NEGATE:
                    return -x[0]
                case Operation.POWER:
                    return x[0] ** (int(x[1]) if x[1] == int(x[1]) else float(x[1]))
                case _:
                    return SINES[operation](float(x[0]))


def test_a_wrong_table_is_found(programs):
    source, scenes = programs["hoist"]
    scene = next(each for each in scenes if each.problems[Solve.DIRECT].tables)
    problem: MotionProblem = scene.problems[Solve.DIRECT]
    (table,) = problem.tables
    pieces = [(*piece[:4], str(Fraction(piece[4]) * Fraction(1001, 1000))) for piece in table.pieces]
    wrong = replace(problem, tables=(replace(table, pieces=tuple(pieces)),))
    found = verify_programs(source.description(), [replace(scene, problems={Solve.DIRECT: wrong})], "table")
    assert Verdict.DISAGREES in {each.found.verdict for each in found}


@pytest.mark.parametrize(
    ("kind", "verdict"),
    [
        (ErrorKind.REFUSED, Verdict.NOTHING),
        (ErrorKind.TOO_LONG, Verdict.UNDECIDED),
        (ErrorKind.TOO_LARGE, Verdict.UNDECIDED),
    ],
)
def test_a_program_that_maxima_does_not_write_leaves_nothing_to_check(kind, verdict):
    found = why_missing(HolonomError(kind, "ten"))
    assert found == (verdict, None, None, HolonomError(kind, "ten").reason)


def test_other_errors_of_maxima_are_errors_of_the_check():
    error = HolonomError(ErrorKind.NOT_MAXIMA, "ten")
    with pytest.raises(HolonomError) as caught:
        why_missing(error)
    assert caught.value is error
