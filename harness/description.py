"""The description: the whole content of a scene file, as a value.

It is the one document that passes from the process that ran the scene file to those that derive, and the check takes
its premises from it. It is therefore read strictly: its schema states it down to the last leaf of its expressions,
and titles hold no characters that hide or reverse text.
"""

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, NamedTuple

from .described import Shape, System, Values, expression
from .expression.functions import FUNCTIONS
from .expression.trees import Tree, integer_tree
from .failures import ErrorKind, HolonomError
from .formats import Document, decoded, require
from .hidden import hidden_character
from .schema import Rules
from .structs import entry, structured

if TYPE_CHECKING:
    from sympy import Expr

MOST_SCENES = 1000
LARGEST = 64 * 2**20  # characters of a description
BEGINS = re.compile(r'\s*\{\s*"format"\s*:\s*"holonom-description"')  # no scene file in Maxima's language begins so
TIME = "t"
SIZE = "closed_form_size"  # a setting for every file


WORD = r"%?[^\x00-@\[-\^`{-\x9f][^\x00-$&-/:-@\[-\^`{-\x9f]*"
NUMBER = r"^-?[0-9]{1,4300}(\.[0-9]{1,400})?([eE][+-]?[0-9]{1,4})?$"
HEADS = (
    *("Add", "And", "Divide", "Equal", "Greater", "GreaterEqual", "HalfStep", "Less", "LessEqual", "Max", "Min"),
    *("Multiply", "Negate", "Not", "NotEqual", "NotSame", "Or", "Power", "Rational", "Same", "Subscript", "Subtract"),
    *("Table", "UnitStep", "Which", *(each.head for each in FUNCTIONS)),
)
EXPRESSION = {
    "description": "An integer, a number, a name, or a function with its arguments. Table has the place of its table, "
    "from 0, and the time.",
    "anyOf": [
        {"type": "integer"},
        {
            "description": "An integer from 2^53 on, or a decimal number, which is the fraction with these digits.",
            "type": "object",
            "properties": {"num": {"description": "Digits of the number.", "type": "string", "pattern": NUMBER}},
            "required": ["num"],
            "additionalProperties": False,
        },
        {"$ref": "#/$defs/Name"},
        {
            "type": "array",
            "minItems": 2,
            "prefixItems": [{"enum": sorted(HEADS)}],
            "items": {"$ref": "#/$defs/Expression"},
        },
    ],
}
NAME = {
    "description": "Of a quantity, an effect, a scene or a word of the language.",
    "type": "string",
    "pattern": rf"^({WORD}|d{{1,3}}ot\({WORD}\))$",
}
Name = Annotated[str, Rules({"$ref": "#/$defs/Name"})]
Expression = Annotated[Tree, Rules({"$ref": "#/$defs/Expression"})]
Pair = tuple[Expression, Expression]
BY_NAME = {"propertyNames": {"$ref": "#/$defs/Name"}, "additionalProperties": {"$ref": "#/$defs/Expression"}}
Expressions = Annotated[Values, Rules(BY_NAME)]
OUTPUT_NAME = {"pattern": rf"^{WORD}(\[[1-9][0-9]{{0,3}}\])?$"}
OutputExpressions = Annotated[Values, Rules(BY_NAME | {"propertyNames": OUTPUT_NAME})]
Place = Annotated[int, Rules({"minimum": 1})]
NoValues = partial(Values, {})


@dataclass(frozen=True)
class Table:
    """Points of a cubic spline in the time."""

    points: tuple[Pair, ...] = entry("Times, increasing, each with a value.", minItems=2)
    ends: Pair | None = entry("Derivatives at both ends; null for the natural spline.")


class DescribedRelease(NamedTuple):
    """Constraints, by their multipliers, released at the first zero of an expression."""

    condition: Annotated[Expression, "Expression at whose first zero crossing the constraints end."]
    multipliers: Annotated[tuple[Name, ...], "Multipliers of the released constraints."]


@dataclass(frozen=True)
class DescribedScene:
    """A scene as its file states it, with exact numbers.

    No value is corrected or solved for.
    """

    name: Name = entry("The name it is assigned to.")
    title: str = entry("Title.")
    effects: tuple[Name, ...] = entry("Names of the effects it calls for, in the order of the system's.")
    control_law: Expressions = entry("Controls as functions of the time. A law may be switched, and may hold tables.")
    prescribed_reactions: Expressions = entry("Multipliers as functions of the time, in place of controls.")
    servo_trees: tuple[Expression, ...] = entry(
        "Expressions that the controls without a law make zero.", key="servo_constraints"
    )
    parameter_values: Expressions = entry("Numbers for parameters. Settings are among them.")
    initial_state: Expressions = entry("Coordinates and velocities as they were given.")
    initial_guess: Expressions = entry("Coordinates and velocities near which the others are looked for.")
    span_trees: Pair | None = entry("First and last time.", key="time_span")
    until_trees: tuple[Expression, ...] = entry("Expressions whose zeros end the motion.", key="until")
    observe: tuple[Name, ...] = entry("Observed quantities.")
    nominal: Expressions = entry("Sizes of coordinates, velocities and the time t.", NoValues)
    outputs: OutputExpressions = entry(
        "Observed quantities with names of their own: expressions of t, the state, accelerations, controls, "
        "multipliers and energy; name[k] is the k-th component of a list.",
        NoValues,
    )
    released: tuple[DescribedRelease, ...] = entry("Constraints that end.", ())

    @cached_property
    def time_span(self) -> "tuple[Expr, Expr] | None":
        """First and last time."""
        return None if self.span_trees is None else (expression(self.span_trees[0]), expression(self.span_trees[1]))

    @cached_property
    def servo_constraints(self) -> "tuple[Expr, ...]":
        """Expressions that the controls without a law make zero."""
        return tuple(map(expression, self.servo_trees))


@dataclass(frozen=True)
class DescribedEffect:
    """A named part of an energy, which is the sum of its parts."""

    effect: Name = entry("Name of the effect.")
    value: Expression = entry("Energy as an expression.")


@dataclass(frozen=True)
class DescribedForces:
    """A named part of the generalized forces."""

    effect: Name = entry("Name of the effect.")
    value: tuple[Expression, ...] = entry("Generalized forces, one a coordinate.")


@dataclass(frozen=True)
class DescribedShape:
    """A shape of the system's picture."""

    shape: Shape = entry("Kind of the shape.")
    numbers: tuple[Expression, ...] = entry(
        "x and y of its places in their order; the radius of a circle last.", minItems=2
    )


@dataclass(frozen=True)
class DescribedSystem:
    """A system as its file states it."""

    name: Name | None = entry("The name it is assigned to; null where it is described within its scenes.")
    title: str = entry("Title.")
    source: str | None = entry("Where it is published.")
    coordinates: tuple[Name, ...] = entry("q, at least one.", minItems=1)
    controls: tuple[Name, ...] = entry("u.")
    parameters: tuple[Name, ...] = entry("Constants that scenes give values to.")
    kinetic_energy: tuple[DescribedEffect, ...] = entry("T.")
    potential_energy: tuple[DescribedEffect, ...] = entry("V.")
    forces: tuple[DescribedForces, ...] = entry("Q.")
    constraints: tuple[Expression, ...] = entry("f, each zero on every motion.")
    drawing: tuple[DescribedShape, ...] = entry("Shapes, of which the system's picture is made.")
    orientations: tuple[Expression, ...] = entry("Expressions whose signs no motion changes.", ())
    switches: tuple[Name, ...] = entry("Names in T, V and Q: 1 in a scene that has them among its effects, else 0.", ())


@dataclass(frozen=True)
class DescriptionDocument:
    """All content of a scene file: one system and its scenes.

    Nothing is derived yet. Numbers are exact.
    """

    DEFINITIONS: ClassVar = {"Name": NAME, "Expression": EXPRESSION}

    closed_form_size: int = entry("Size beyond which closed forms are left out.", minimum=1)
    settings: Expressions = entry(
        "Numbers that the file was run with; those of parameters are among the parameter values of the scenes."
    )
    assumptions: tuple[Expression, ...] = entry("Assumptions of the file about its quantities.")
    declarations: tuple[tuple[Name, Name], ...] = entry("Names with what each is declared to be, such as an integer.")
    system: DescribedSystem = entry("The system.")
    tables: tuple[Table, ...] = entry("Tables of control laws and servo-constraints.")
    scenes: tuple[DescribedScene, ...] = entry("The scenes, oldest first.")
    joint_shapes: Mapping[str, tuple[Place, ...]] = entry(
        "Of multipliers, the segments between places that only their joint draws: places in the drawing, from 1.", dict
    )
    joints: Mapping[str, Name] = entry(
        "Of multipliers, the joint or body that wrote the constraint, by its name in the file.", dict
    )


@dataclass(frozen=True)
class Description:
    """The description in one scene file under certain settings.

    Attributes
    ----------
    file : Path
        The file that was run, or the document that was read.
    content : dict
        The document.
    was_run : bool
        True if the file was run.
    """

    file: Path
    content: dict[str, Any]
    was_run: bool = False

    @property
    def closed_form_size(self) -> int:
        """Size beyond which closed forms are left out."""
        return self.content["closed_form_size"]

    @property
    def settings(self) -> Values:
        """The settings that the file was run with."""
        return Values(self.content["settings"])

    @cached_property
    def system(self) -> System:
        """The system that the file describes."""
        return _system(self.content["system"])

    @cached_property
    def tables(self) -> tuple[Table, ...]:
        """The tables of its control laws and servo-constraints."""
        return tuple(structured(Table, table) for table in self.content["tables"])

    @cached_property
    def scenes(self) -> tuple[DescribedScene, ...]:
        """Its scenes, oldest first."""
        return tuple(structured(DescribedScene, scene) for scene in self.content["scenes"])

    @property
    def joints(self) -> Mapping[str, str]:
        """Name, in the file, of the joint or body that wrote each multiplier's constraint."""
        return self.content.get("joints", {})

    @property
    def joint_shapes(self) -> Mapping[str, Sequence[int]]:
        """Numbers of the shapes, from 1, that vanish with each multiplier's constraint."""
        return self.content.get("joint_shapes", {})

    @property
    def unused_parameters(self) -> tuple[str, ...]:
        """Parameters that the system declares, but neither it nor a scene uses."""
        system = {key: value for key, value in self.content["system"].items() if key != "parameters"}
        used = _strings([system, *({**scene, "parameter_values": []} for scene in self.content["scenes"])])
        return tuple(name for name in self.content["system"]["parameters"] if name not in used)

    @property
    def text(self) -> str:
        """The document as JSON, in which every control character is escaped."""
        return json.dumps(self.content, ensure_ascii=False, separators=(",", ":"))

    def with_settings(self, settings: Mapping[str, str]) -> "Description":
        """Return the description with other values of parameters.

        This is possible after the file has run.

        Parameters
        ----------
        settings : mapping of str to str
            Numbers, by name of the parameter, or a positive integer ``closed_form_size``.

        Returns
        -------
        Description

        Raises
        ------
        HolonomError
            The system, or a scene, has no such parameter, or the size is not a positive integer.
        """
        content = self.content
        for name, text in settings.items():
            content = _with_value(content, name, _number(text), self.file)
        if SIZE in settings:
            require(Document.DESCRIPTION, content, DescriptionDocument)
        return replace(self, content=content)

    def with_initial_state(self, scene: str, state: Mapping[str, float]) -> "Description":
        """Return the description with another initial state of a scene.

        Parameters
        ----------
        scene : str
            Name of the scene.
        state : mapping of str to float
            Coordinates and velocities by name, exact.

        Returns
        -------
        Description
        """
        start = {"initial_state": {name: _number(repr(value)) for name, value in state.items()}, "initial_guess": {}}
        scenes = [each | start if each["name"] == scene else each for each in self.content["scenes"]]
        return replace(self, content=self.content | {"scenes": scenes})


def is_description(text: str) -> bool:
    """Return True for a description, False for a scene file.

    Parameters
    ----------
    text : str
        Content of a file.

    Returns
    -------
    bool
    """
    return BEGINS.match(text) is not None


def read_description(text: str, file: Path) -> Description:
    """Read a description.

    Parameters
    ----------
    text : str
        JSON document.
    file : Path
        Its file, for messages.

    Returns
    -------
    Description

    Raises
    ------
    HolonomError
        It is too large, it is not a description, or it holds characters that hide or reverse text.
    """
    if len(text) > LARGEST:
        raise HolonomError(ErrorKind.DESCRIPTION_TOO_LARGE, file, f"{LARGEST // 2**20} MiB")
    content = decoded(Document.DESCRIPTION, text, DescriptionDocument)
    if len(content["scenes"]) > MOST_SCENES:
        raise HolonomError(ErrorKind.TOO_MANY_SCENES, file, str(len(content["scenes"])))
    for prose in _texts(content):
        if hidden := hidden_character(prose):
            raise HolonomError(ErrorKind.HIDDEN_CHARACTER, file, hidden)
    return Description(file, content)


def _texts(content: dict[str, Any]) -> Iterator[str]:
    """Yield the prose texts of a description.

    By its schema, names consist of letters and digits.
    """
    for part in (content["system"], *content["scenes"]):
        yield part["title"]
        yield part.get("source") or ""


def _strings(part: Any) -> set[str]:
    """Return all texts of a part of a document, names among them."""
    texts, waiting = set(), [part]
    while waiting:
        each_part = waiting.pop()
        if isinstance(each_part, str):
            texts.add(each_part)
        elif isinstance(each_part, dict | list):
            waiting += each_part.values() if isinstance(each_part, dict) else each_part
    return texts


def _system(system: dict[str, Any]) -> System:
    coordinates, controls = tuple(system["coordinates"]), tuple(system["controls"])
    names = {
        "time": TIME,
        "velocities": _rates("dot", coordinates),
        "accelerations": _rates("ddot", coordinates),
        "control_rates": _rates("dot", controls),
        "control_accelerations": _rates("ddot", controls),
        "multipliers": [f"lambda{place}" for place, _ in enumerate(system["constraints"], 1)],
    }
    return structured(System, system | names)


def _rates(dots: str, names: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(f"{dots}({name})" for name in names)


def _with_value(content: dict[str, Any], name: str, value: Tree, file: Path) -> dict[str, Any]:
    if name == SIZE:
        return content | {SIZE: value, "settings": content["settings"] | {name: value}}
    declared = name in content["system"]["parameters"]
    having = [scene for scene in content["scenes"] if declared or name in scene["parameter_values"]]
    if not declared and not having:
        raise HolonomError(ErrorKind.NOT_SETTABLE, file, name)
    return content | {
        "settings": content["settings"] | {name: value},
        "scenes": [
            scene | {"parameter_values": scene["parameter_values"] | {name: value}} if scene in having else scene
            for scene in content["scenes"]
        ],
    }


def _number(text: str) -> Tree:
    """Return the tree of a number, exactly as it is written.

    A quotient may be one of decimals.
    """
    numerator, _, denominator = text.partition("/")
    value = Fraction(numerator) / Fraction(denominator or 1)
    parts = [integer_tree(part) for part in value.as_integer_ratio()]
    return parts[0] if value.denominator == 1 else ["Rational", *parts]
