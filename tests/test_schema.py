"""Documents by their types: what is written is read, and the schema says both."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from fractions import Fraction
from typing import Annotated, Any, NamedTuple

import numpy as np
import pytest
from jsonschema import Draft202012Validator

from holonom.described import Values
from holonom.program.motion_problem import MotionProblem, Release
from holonom.schema import MATRIX, PAIRS, Names, Rules, schema_of
from holonom.structs import computed, entry, group, reader_of, written


class Colour(StrEnum):
    RED = "red"
    BLUE = "blue"


class Span(NamedTuple):
    first: Annotated[Fraction, "First time."]
    number: Annotated[Annotated[int, Rules({"minimum": 1})], "Number of times."]
    last: Annotated[Fraction | None, "Last time."] = None


@dataclass(frozen=True)
class Part:
    """A part."""

    colour: Colour | None = entry("Its colour.")
    below: "tuple[Part, ...] | None" = None  # not in the document
    size: int = entry("Its size.", 1, key="how many", minimum=0)


@dataclass(frozen=True)
class Origin:
    """Where it comes from."""

    title: str = entry("Its title.")
    note: str | None = entry("A note.", None, optional=True)


@dataclass(frozen=True)
class Whole:
    """A document.

    It has entries.

    Attributes
    ----------
    origin : Origin
    """

    origin: Origin = group()
    span: Span = entry("Times.")
    parts: tuple[Part, ...] = entry("Parts.", minItems=1)
    names: Names = entry("Names.")
    values: Mapping[str, float] = entry("Values.", dict)
    pair: tuple[str, int] = entry("A name and a number.", ("a", 1))
    even: Annotated[int, Rules({"multipleOf": 2})] = entry("Even.", 2)

    @property
    @computed("Number of parts.", minimum=1)
    def count(self) -> int:
        return len(self.parts)


WHOLE = Whole(Origin("it"), Span(Fraction(1, 2), 3), (Part(Colour.RED), Part(None, size=3)), ("x", "y"), {"x": 0.5})
DOCUMENT = {
    "title": "it",
    "span": {"first": "1/2", "number": 3, "last": None},
    "parts": [{"colour": "red", "how many": 1}, {"colour": None, "how many": 3}],
    "names": ["x", "y"],
    "values": {"x": 0.5},
    "pair": ["a", 1],
    "even": 2,
    "count": 2,
}
ENVELOPE = {"format": "holonom-whole", "version": 2}
SCHEMA = schema_of(Whole, "whole", 2)


def refused(document: dict) -> list[str]:
    """The paths at which the schema refuses a document."""
    return [error.json_path for error in Draft202012Validator(SCHEMA).iter_errors({**ENVELOPE, **document})]


def test_what_is_written_is_what_the_schema_says_and_is_read_again():
    assert written(WHOLE) == DOCUMENT
    assert list(written(WHOLE)) == list(DOCUMENT)
    assert refused(DOCUMENT) == []
    assert reader_of(Whole)(DOCUMENT) == WHOLE


def test_an_entry_may_be_left_out_if_it_has_a_default():
    assert set(SCHEMA["required"]) == {"format", "version", "title", "span", "parts", "names", "count"}
    assert reader_of(Whole)({**DOCUMENT, "span": {"first": "1/2", "number": 3}}).span == Span(Fraction(1, 2), 3)
    assert "note" not in written(WHOLE)
    assert written(replace(WHOLE, origin=Origin("it", "short")))["note"] == "short"


@pytest.mark.parametrize(
    ("changed", "place"),
    [
        ({"title": None}, "$.title"),
        ({"span": {"first": "soon", "number": 3, "last": None}}, "$.span.first"),
        ({"span": {"first": "1/2"}}, "$.span"),
        ({"span": {"first": "1/2", "number": 0, "last": None}}, "$.span.number"),
        ({"parts": []}, "$.parts"),
        ({"parts": [{"colour": "green", "how many": 1}]}, "$.parts[0].colour"),
        ({"parts": [{"colour": "red", "how many": -1}]}, "$.parts[0].how many"),
        ({"parts": [{"colour": "red", "size": 1}]}, "$.parts[0]"),
        ({"names": ["x", "x"]}, "$.names"),
        ({"values": {"x": "y"}}, "$.values.x"),
        ({"pair": ["a"]}, "$.pair"),
        ({"pair": ["a", 1, 2]}, "$.pair"),
        ({"even": 3}, "$.even"),
        ({"version": 1}, "$.version"),
        ({"another": 1}, "$"),
    ],
)
def test_a_document_of_another_shape_is_refused(changed, place):
    assert refused({**DOCUMENT, **changed}) == [place]


def test_descriptions_are_those_of_entries_and_classes():
    assert SCHEMA["description"] == "A document. It has entries."
    assert SCHEMA["properties"]["count"] == {"description": "Number of parts.", "type": "integer", "minimum": 1}
    assert SCHEMA["$defs"]["Part"]["description"] == "A part."
    assert SCHEMA["properties"]["span"] == {"description": "Times.", "$ref": "#/$defs/Span"}


def test_arrays_are_lists_and_complex_numbers_pairs():
    for array, shape in ((np.eye(2), MATRIX), (np.array([1, 2j]), PAIRS)):
        Draft202012Validator(shape).validate(written(array))
    assert written(np.array([1, 2j])) == [[1.0, 0.0], [0.0, 2.0]]
    assert written({"x": np.float64(0.5), "n": np.int64(2), "b": np.True_}) == {"x": 0.5, "n": 2, "b": True}


def test_numbers_beyond_double_precision_are_written_as_asked():
    assert written(np.array([np.longdouble(1) / 3]), "{:.20f}".format) == [f"{np.longdouble(1) / 3:.20f}"]


def test_a_type_may_contain_itself():
    schema = schema_of(MotionProblem, "motion-problem", 2)
    assert schema["$defs"][Release.__name__]["properties"]["after"]["$ref"] == "#"


def test_classes_that_read_themselves_state_their_shape():
    @dataclass
    class Law:
        """A law."""

        law: Values = entry("By control.")
        anything: Any = entry("Whatever.")

    properties = schema_of(Law, "law", 2)["properties"]
    assert properties["law"] == {"description": "By control.", **Values.SHAPE}
    assert properties["anything"] == {"description": "Whatever."}


def test_two_types_of_one_name_are_no_document():
    ours = Part

    @dataclass(frozen=True)
    class Other:
        """Another whole."""

        @dataclass(frozen=True)
        class Part:
            """Another part."""

            text: str = entry("Its text.")

        part: ours = entry("Ours.")
        other: Part = entry("Theirs.")

    with pytest.raises(TypeError, match="Part"):
        schema_of(Other, "other", 2)
