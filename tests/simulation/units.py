"""A motion in other units: each of its programs takes and gives numbers in them, and computes as before between.

Every coordinate is measured in the unit of length, angles and Euler parameters, too: that is only a change of
variables, so that no dimensions have to be known. Constraints and controls keep their values.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from decimal import Decimal
from fractions import Fraction
from typing import Any

from holonom.program.motion_problem import DependsOn, MotionProblem
from holonom.program.motion_program import Call, Expression, Name, Operation, Program, names_in
from holonom.simulation.matrices import INDEXED

PROGRAMS = "motion", "projection", "matrices", "energy", "controls", "outputs", "switching"


@dataclass(frozen=True)
class Units:
    """The units of mass, length and time of SI, in these units."""

    mass: Fraction
    length: Fraction
    time: Fraction

    @property
    def energy(self) -> Fraction:
        return self.mass * self.length**2 / self.time**2


SI = Units(Fraction(1), Fraction(1), Fraction(1))
SYSTEMS = {
    "micrometres": Units(Fraction(1), Fraction(1, 10**6), Fraction(1)),
    "atoms": Units(Fraction(1, 10**27), Fraction(1, 10**10), Fraction(1, 10**13)),
    "slow atoms": Units(Fraction(1, 10**27), Fraction(1, 10**10), Fraction(1)),
    "planets": Units(Fraction(10**24), Fraction(10**9), Fraction(10**7)),
    "light and fast": Units(Fraction(1, 10**3), Fraction(10**6), Fraction(1, 10**5)),
}


def in_units(problem: MotionProblem, units: Units) -> MotionProblem:
    """The same motion, its time, coordinates and rates multiplied by these units."""
    of_inputs = _of_inputs(problem, units)

    def changed(program: Program | None) -> Program | None:
        return program and _changed(program, of_inputs, lambda output: _of_output(output, problem, units))

    def text(number: str, unit: Fraction) -> str:
        """Exactly: units are powers of ten."""
        exact = Fraction(number) * unit
        return format(Decimal(exact.numerator) / Decimal(exact.denominator), "e")

    span, start, ends, servo = problem.time_span, problem.initial.parametric, problem.ends, problem.servo
    tables = tuple(
        replace(table, pieces=tuple((str(Fraction(first) * units.time), *rest) for first, *rest in table.pieces))
        for table in problem.tables
    )
    return replace(
        problem,
        time_span=span and tuple(text(number, units.time) for number in span),
        law_span=problem.law_span and tuple(text(each, units.time) for each in problem.law_span),
        start={name: text(number, of_inputs[name]) for name, number in problem.start.items()},
        tables=tables,
        initial=replace(problem.initial, parametric=start and replace(start, program=changed(start.program))),
        ends=replace(ends, events=changed(ends.events)),
        servo=replace(servo, matrix=changed(servo.matrix)),
        **{name: changed(getattr(problem, name)) for name in PROGRAMS},
        drawing=None,
        _compiled={},
    )


def _of_inputs(problem: MotionProblem, units: Units) -> dict[str, Fraction]:
    """Units of the inputs that have some; multipliers and constraints keep theirs but for the energy's."""
    units_of = {"t": units.time, **{table.inputs[0]: units.time for table in problem.tables}}
    units_of |= dict.fromkeys(problem.coordinates, units.length)
    units_of |= dict.fromkeys(problem.state[len(problem.coordinates) :], units.length / units.time)
    units_of |= {f"ddot({name})": units.length / units.time**2 for name in problem.coordinates}
    return units_of | dict.fromkeys(problem.multipliers, units.energy)


def _of_output(output: str, problem: MotionProblem, units: Units) -> Fraction:
    """The unit of an output of any of the programs."""
    length, time, energy = units.length, units.time, units.energy
    indexed = INDEXED.fullmatch(output)
    if output in problem.state or output in problem.multipliers:
        return _of_inputs(problem, units)[output]
    if output.startswith("ddot("):
        return length / time**2
    if indexed and indexed[1] == "switch" and problem.signs[int(indexed[2]) - 1].by is DependsOn.REACTION:
        return energy
    if indexed is None:
        return {"energy": energy, "power": energy / time}.get(output, Fraction(1))
    return {
        "A": energy * time**2 / length**2,
        "J": 1 / length,
        "h": energy / length,
        "Lambda": energy / length,
        "c": 1 / time**2,
        "residual_rate": 1 / time,
        "position_correction": length,
        "velocity_correction": length / time,
        "momentum": energy * time / length,
        "switch_rate": 1 / time,
    }.get(indexed[1], Fraction(1))


def _changed(program: Program, of_inputs: dict[str, Fraction], of_output: Callable[[str], Fraction]) -> Program:
    """A program that divides what it takes by units, and multiplies what it gives."""
    used = set().union(*(names_in(value) for _, value in program.assignments), *map(names_in, program.outputs.values()))
    named = {name: f"{name} by its unit" for name in program.inputs if name in of_inputs and name in used}
    before = [(own, Call(Operation.MULTIPLY, (1 / of_inputs[name], Name(name)))) for name, own in named.items()]
    inner = [(name, _renamed(value, named)) for name, value in program.assignments]
    outputs, after = {}, []
    for name, value in program.outputs.items():
        after.append((f"{name} in its unit", Call(Operation.MULTIPLY, (of_output(name), _renamed(value, named)))))
        outputs[name] = Name(after[-1][0])
    return replace(program, assignments=(*before, *inner, *after), outputs=outputs)


def _renamed(expression: Expression, names: dict[str, str]) -> Expression:
    match expression:
        case Name(text):
            return Name(names.get(text, text))
        case Call(operation, arguments):
            return Call(operation, tuple(_renamed(argument, names) for argument in arguments))
    return expression


def description_in_length(description: dict[str, Any], length: Fraction) -> dict[str, Any]:
    """The same systems and scenes in a description, their coordinates and velocities multiplied by this unit."""
    system, energy = description["system"], length**2

    def times(factor: Fraction, tree: Any) -> Any:
        return ["Multiply", ["Rational", factor.numerator, factor.denominator], tree]

    measured = {name: times(1 / length, name) for name in system["coordinates"]}
    measured |= {f"dot({name})": times(1 / length, f"dot({name})") for name in system["coordinates"]}
    measured |= {f"lambda{k}": times(1 / energy, f"lambda{k}") for k in range(1, len(system["constraints"]) + 1)}

    def of(tree: Any) -> Any:
        if isinstance(tree, list):
            return [tree[0], *map(of, tree[1:])]
        return measured.get(tree, tree) if isinstance(tree, str) else tree

    def all_of(trees: dict[str, Any]) -> dict[str, Any]:
        return {name: of(tree) for name, tree in trees.items()}

    def lengths(values: dict[str, Any]) -> dict[str, Any]:
        return {name: times(length, value) if name in measured else value for name, value in values.items()}

    scenes = [
        scene
        | {name: lengths(scene[name]) for name in ("initial_state", "initial_guess", "nominal")}
        | {name: all_of(scene[name]) for name in ("control_law", "outputs")}
        | {name: [of(tree) for tree in scene[name]] for name in ("until", "servo_constraints")}
        | {
            "prescribed_reactions": {
                name: times(energy, of(law)) for name, law in scene["prescribed_reactions"].items()
            }
        }
        for scene in description["scenes"]
    ]
    terms = {
        name: [{**term, "value": times(energy, of(term["value"]))} for term in system[name]]
        for name in ("kinetic_energy", "potential_energy")
    }
    forces = [{**term, "value": [times(length, of(value)) for value in term["value"]]} for term in system["forces"]]
    constraints = [of(tree) for tree in system["constraints"]]
    others = {"forces": forces, "constraints": constraints, "drawing": []}
    return description | {"system": system | terms | others, "scenes": scenes}
