"""Typed values of documents: dataclasses read from JSON by their annotations.

A document has the shape of its schema when it comes here (`holonom.formats.read`). It is not checked a second time.
"""

from collections.abc import Callable, Mapping
from dataclasses import MISSING, field, fields, is_dataclass
from functools import cache, partial
from types import NoneType, UnionType
from typing import Any, TypeVar, get_args, get_origin

Struct = TypeVar("Struct")
AS_IT_IS = (bool, int, str)


def key(name: str, default: Any = MISSING) -> Any:
    """Make a field of a dataclass that has another name in the document.

    Parameters
    ----------
    name : str
        Name in the document.
    default : object
        Value of the field if the document does not have it.

    Returns
    -------
    dataclasses.Field
    """
    return field(default=default, metadata={"key": name})


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


@cache
def _fields(kind: type) -> tuple[tuple[str, str | None, Any], ...]:
    """Return name, key and annotation of each field. The key of a group is None."""
    if is_dataclass(kind):
        return tuple((each.name, each.metadata.get("key", each.name), each.type) for each in fields(kind))
    return tuple((name, name, annotation) for name, annotation in kind.__annotations__.items())


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
    if origin is UnionType:
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
