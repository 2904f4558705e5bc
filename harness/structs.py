"""Typed values of documents: dataclasses from and to JSON, by their annotations.

`holonom.schema` makes the schema of a document from the same dataclass.
"""

import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import MISSING, field, fields, is_dataclass
from functools import cache, cached_property, partial
from inspect import cleandoc
from types import NoneType, UnionType
from typing import Annotated, Any, NamedTuple, TypeVar, Union, get_args, get_origin

Struct = TypeVar("Struct")
AS_IT_IS = (bool, int, str)
DOUBLE = 8  # bytes


class Entry(NamedTuple):
    """An entry of an object in a document."""

    name: str  # of the attribute
    key: str | None  # its name in the document; None for fields that are in the same object
    kind: Any
    text: str  # its description
    rules: Mapping[str, Any] = {}  # JSON Schema beyond the type
    required: bool = True
    computed: bool = False  # written, not read
    optional: bool = False  # not written if it is None


def entry(
    text: str, default: Any = MISSING, *, key: str = "", optional: bool = False, compare: bool = True, **rules: Any
) -> Any:
    """Make a field of a dataclass an entry of a document.

    Parameters
    ----------
    text : str
        Description.
    default : object
        Value if the document does not have it. A callable makes it.
    key : str
        Name in the document, if it is another than the field's.
    optional : bool
        True if None is not written.
    compare : bool
        Whether the field counts when two objects are compared.
    **rules : object
        JSON Schema beyond the type.

    Returns
    -------
    dataclasses.Field
    """
    stated = {"text": text, "rules": rules, "optional": optional} | ({"key": key} if key else {})
    made = {"default_factory" if callable(default) else "default": default}
    return field(metadata=stated, compare=compare, **made)


def computed(text: str, key: str = "", **rules: Any) -> Callable[[Struct], Struct]:
    """Make a property an entry of a document, which is written and not read.

    Parameters
    ----------
    text, key, **rules : str, str, object
        As for `entry`.

    Returns
    -------
    callable
        Decorator of the property's function.
    """

    def marked(function: Struct) -> Struct:
        function.entry = text, key, rules
        return function

    return marked


def group() -> Any:
    """Make a field whose own fields are in the same object of the document.

    Returns
    -------
    dataclasses.Field
    """
    return field(metadata={"key": None})


def structured(kind: type[Struct], content: Mapping[str, Any], **given: Any) -> Struct:
    """Return the dataclass, or named tuple, that an object of a document describes.

    Parameters
    ----------
    kind : type
        The type. Of its fields those of dataclasses, named tuples, ``tuple[...]`` and ``Mapping[str, ...]`` are read in
        the same way. A class that has ``of_document`` reads itself. Other classes are called, as enumerations are.
        Fields that the object does not have get their defaults.
    content : mapping of str to object
        The object.
    **given : object
        Values of fields that are not read.

    Returns
    -------
    object
        An instance of the type.
    """
    read = {
        name: _value(annotation, content if place is None else content[place])
        for name, place, annotation in _fields(kind)
        if name not in given and (place is None or place in content)
    }
    return kind(**read, **given)


def with_attributes(kind: type[Struct]) -> type[Struct]:
    """Append the entries of a class to its docstring, as attributes.

    Parameters
    ----------
    kind : type
        Dataclass whose fields are entries.

    Returns
    -------
    type
        The same class.
    """
    head, examples, rest = cleandoc(kind.__doc__).partition("\n\nExamples\n")
    lines = [line for each in entries_of(kind) if each.name[0] != "_" for line in (each.name, f"    {each.text}")]
    kind.__doc__ = "\n".join([f"{head}\n", "Attributes", "----------", *lines]) + examples + rest
    return kind


class Documented:
    """A result that is published as a document."""

    def document(self) -> dict[str, Any]:
        """Return the content of the JSON document without format and version.

        Returns
        -------
        dict
        """
        return written(self)


def written(value: Any, text: Callable[[Any], str] = str) -> Any:
    """Return a value as JSON holds it.

    Parameters
    ----------
    value : object
        Dataclasses and named tuples become objects of their entries, arrays lists, and complex numbers pairs.
    text : callable
        Takes values of other classes to text.

    Returns
    -------
    object
    """
    if value is None or type(value) in (str, int, float, bool):
        return value
    if isinstance(value, str):
        return str(value)
    if isinstance(value, complex):
        return [float(value.real), float(value.imag)]
    if isinstance(value, Mapping):
        return {name: written(part, text) for name, part in value.items()}
    if stated := entries_of(type(value)):
        return dict(_written(value, stated, text))
    if hasattr(value, "dtype") and value.dtype.kind in "fiub" and value.dtype.itemsize <= DOUBLE:
        return value.tolist()
    if getattr(value, "ndim", 0):
        return [written(part, text) for part in value]
    return [written(part, text) for part in value] if isinstance(value, tuple | list) else text(value)


def _written(value: Any, stated: tuple[Entry, ...], text: Callable[[Any], str]) -> Iterator[tuple[str, Any]]:
    for each in stated:
        part = getattr(value, each.name)
        if each.key is None:
            yield from written(part, text).items()
        elif part is not None or not each.optional:
            yield each.key, written(part, text)


@cache
def entries_of(kind: type) -> tuple[Entry, ...]:
    """Return the entries of an object in a document, those of properties last.

    Parameters
    ----------
    kind : type
        Dataclass, or named tuple whose fields are ``Annotated[type, "description"]``.

    Returns
    -------
    tuple of Entry
        Empty for any other class.
    """
    if hasattr(kind, "_fields"):
        stated = {name: get_args(each) for name, each in kind.__annotations__.items() if get_origin(each) is Annotated}
        return tuple(
            Entry(name, name, _annotated(*inside[:-1]), inside[-1], required=name not in kind._field_defaults)
            for name, inside in stated.items()
        )
    return tuple(_field_entries(kind)) if is_dataclass(kind) else ()


def _annotated(kind: Any, *rules: Any) -> Any:
    return Annotated[kind, *rules] if rules else kind


def _field_entries(kind: type) -> Iterator[Entry]:
    for each in fields(kind):
        stated = dict(each.metadata)
        if "text" in stated or stated.get("key", "") is None:
            required = each.default is MISSING and each.default_factory is MISSING
            place = stated.pop("key", each.name)
            if _type(kind, each.type) is None and not stated.get("rules"):
                raise TypeError(f"{kind.__name__}.{each.name}: unknown type {each.type}")
            yield Entry(each.name, place, _type(kind, each.type), **{"text": ""} | stated, required=required)
    for name, each in vars(kind).items():
        function = each.func if isinstance(each, cached_property) else getattr(each, "fget", None)
        if hasattr(function, "entry"):
            text, place, rules = function.entry
            yield Entry(name, place or name, function.__annotations__.get("return"), text, rules, computed=True)


@cache
def _fields(kind: type) -> tuple[tuple[str, str | None, Any], ...]:
    """Return name, key and annotation of each field. The key of a group is None."""
    if is_dataclass(kind):
        places = ((each.name, each.metadata.get("key", each.name), each.type) for each in fields(kind))
        return tuple((name, place, _type(kind, annotation)) for name, place, annotation in places)
    return tuple((name, name, annotation) for name, annotation in kind.__annotations__.items())


def _type(kind: type, annotation: Any) -> Any:
    """Return a type that may be stated as text, None if only type checkers know it."""
    with suppress(NameError):
        return eval(annotation, vars(sys.modules[kind.__module__])) if isinstance(annotation, str) else annotation


def _value(kind: Any, content: Any) -> Any:
    reader = reader_of(kind)
    return content if reader is None else reader(content)


@cache
def reader_of(kind: Any) -> Callable[[Any], Any] | None:
    """Return the function that reads a part of a document as a type.

    Parameters
    ----------
    kind : type
        Annotation of a field.

    Returns
    -------
    callable or None
        None if the part is unchanged.
    """
    origin, inside = get_origin(kind), get_args(kind)
    if origin is Annotated:
        return reader_of(inside[0])
    if origin in (UnionType, Union):
        reader = reader_of(inside[0]) if len(inside) == 2 and inside[1] is NoneType else None
        return reader and (lambda content: None if content is None else reader(content))
    if origin is tuple:
        readers = [reader_of(each) for each in inside if each is not Ellipsis]
        if not any(readers):
            return tuple
        if Ellipsis in inside:
            return lambda content: tuple(map(readers[0], content))
        return lambda content: tuple(_value(each, part) for each, part in zip(inside, content, strict=True))
    if origin is not None and issubclass(origin, Mapping):
        reader = reader_of(inside[1])
        return reader and (lambda content: {name: reader(part) for name, part in content.items()})
    if not isinstance(kind, type) or kind in AS_IT_IS:
        return None
    if hasattr(kind, "of_document"):
        return kind.of_document
    return partial(structured, kind) if is_dataclass(kind) or hasattr(kind, "_fields") else kind
