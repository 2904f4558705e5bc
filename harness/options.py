"""Options as fields of requests, for the command line, Python and the reference.

An option is a field of a dataclass. Its type is an enumeration, ``Fraction`` (a time), ``bool``, ``int``, ``float``,
``str`` or a tuple of names, written with commas between. ``| None`` if it may be left out.
"""

import inspect
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import Field, dataclass, field, fields
from decimal import Decimal
from enum import StrEnum
from fractions import Fraction
from functools import reduce, wraps
from numbers import Integral, Real
from types import NoneType
from typing import Any, TypeVar, get_origin

from .failures import ErrorKind, HolonomError
from .language import Message, translatable

LONGEST = 200  # digits of a number that an option gives
LARGEST_EXPONENT = 307  # of a double
SHOWN = 40  # characters of a rejected time
NAMES = {
    bool: "bool",
    int: "int",
    float: "float",
    str: "str",
    tuple: "sequence of str",
    Fraction: "number",
    NoneType: "None",
}
EXPECTED = {
    bool: (bool, translatable("True or False")),
    int: (Integral, translatable("an integer")),
    float: (Real, translatable("a number")),
    str: (str, translatable("text")),
}
Number = int | float | Fraction | Decimal | str
Function = TypeVar("Function", bound=Callable[..., Any])


@dataclass(frozen=True)
class Option:
    """The spelling of an option and its allowed values."""

    help: str  # the help text, on the command line and in Python
    metavar: str | None = None  # placeholder of the value on the command line
    spelt: tuple[str, ...] = ()  # on the command line, if it is not the name of the field
    alias: str = ""  # former name, accepted for one release
    least: float | None = None
    most: float | None = None
    above: float | None = None  # a bound that is not among the values
    choices: tuple[StrEnum, ...] = ()  # of an enumeration; without them, all members
    required: bool = False  # on the command line
    in_python: Any = None  # default in Python, where it is another than the field's


def option(default: Any, help: str, **details: Any) -> Any:
    """Make a field of a request an option.

    Parameters
    ----------
    default : object
        Default of the field.
    help, **details : str, object
        Fields of `Option`.

    Returns
    -------
    dataclasses.Field
    """
    return field(default=default, metadata={"option": Option(help, **details)})


def options_of(request: type, *names: str) -> tuple[Field, ...]:
    """Return the fields of a request that are options.

    Parameters
    ----------
    request : type
        Dataclass of the request.
    *names : str
        Names of fields. Without any, all options.

    Returns
    -------
    tuple of Field
    """
    found = {each.name: each for each in fields(request) if "option" in each.metadata}
    return tuple(found[name] for name in names) if names else tuple(found.values())


def kind_of(each: Field) -> type:
    """Return the type of an option's values other than None.

    Parameters
    ----------
    each : Field
        Field of an option.

    Returns
    -------
    type
        str for int
    """
    return [kind for kind in _types(each) if kind is not NoneType][-1]


def _types(each: Field) -> tuple[type, ...]:
    return (tuple,) if get_origin(each.type) is tuple else getattr(each.type, "__args__", (each.type,))


def choices_of(each: Field) -> tuple[str, ...]:
    """Return the values of an option that is an enumeration.

    Parameters
    ----------
    each : Field
        Field of an option.

    Returns
    -------
    tuple of str
        Empty for any other option.
    """
    kind = kind_of(each)
    return tuple(map(str, each.metadata["option"].choices or kind)) if issubclass(kind, StrEnum) else ()


def read(each: Field, value: Any) -> Any:
    """Return the value of an option as the request holds it.

    Parameters
    ----------
    each : Field
        Field of an option.
    value : object
        Value from the command line or from Python.

    Returns
    -------
    object

    Raises
    ------
    HolonomError
        The value is not one of the choices, not in the range, no time, or of another type.
    """
    kind, stated = kind_of(each), each.metadata["option"]
    if value is None and (kind is tuple or NoneType in _types(each)):
        return () if kind is tuple else None
    if choices := choices_of(each):
        if str(value) not in choices:
            raise _unexpected(each, value, ", ".join(choices))
        return kind(str(value))
    if kind is Fraction:
        return read_time(value, spelt_of(each))
    if kind is tuple:
        given = value.split(",") if isinstance(value, str) else value
        names = tuple(given) if isinstance(given, Iterable) else (None,)
        if not all(isinstance(name, str) for name in names):
            raise _unexpected(each, value, translatable("names"))
        return tuple(dict.fromkeys(name.strip() for name in names if name.strip()))
    expected = [EXPECTED[kind] for kind in _types(each) if kind is not NoneType]
    if not any(isinstance(value, taken) for taken, _ in expected):
        raise _unexpected(each, value, reduce(_or, [name for _, name in expected]))
    if isinstance(value, str):
        return value
    with suppress(OverflowError):  # an integer beyond every double stays
        value = kind(value) if kind in (int, float) else value
    if stated.least is not None and not value >= stated.least:
        bound = translatable("%(least)s or more", least=f"{stated.least:g}")
    elif stated.above is not None and not value > stated.above:
        bound = translatable("more than %(above)s", above=f"{stated.above:g}")
    elif stated.most is not None and not value <= stated.most:
        bound = translatable("at most %(most)s", most=f"{stated.most:g}")
    else:
        return value
    raise HolonomError(
        ErrorKind.NOT_IN_RANGE,
        detail=translatable("expected %(bound)s, not %(value)s", bound=bound, value=value),
        option=spelt_of(each),
    )


def _unexpected(each: Field, value: Any, expected: str) -> HolonomError:
    return HolonomError(
        ErrorKind.NOT_A_CHOICE,
        detail=translatable("'%(value)s': expected %(expected)s", value=value, expected=expected),
        option=spelt_of(each),
    )


def _or(first: Message, last: Message) -> Message:
    return translatable("%(first)s or %(last)s", first=first, last=last)


def spelt_of(each: Field) -> str:
    """Return the option of the command line that a field is.

    Parameters
    ----------
    each : Field
        Field of an option.

    Returns
    -------
    str
        Such as ``--max-step``.
    """
    return next(iter(each.metadata["option"].spelt or ()), "--" + each.name.replace("_", "-"))


def read_time(value: Any, option: str = "") -> Fraction:
    """Return a time exactly.

    Parameters
    ----------
    value : object
        An integer, a decimal or a quotient of integers, as a number or text.
    option : str
        Option that gives the time, for the error.

    Returns
    -------
    Fraction

    Raises
    ------
    HolonomError
        It has none of these forms, or exceeds a double.
    """
    text = str(value)
    with suppress(ValueError, ZeroDivisionError):
        if within_reach(text):
            return Fraction(text)
    shown = text if len(text) <= SHOWN else f"{text[:SHOWN]}..."
    raise HolonomError(ErrorKind.NOT_A_TIME, detail=shown, option=option)


def within_reach(number: str) -> bool:
    """Return True if a double holds the parts of a decimal number or quotient.

    The parts are not computed.

    Parameters
    ----------
    number : str
        Decimal number, or quotient of two.

    Returns
    -------
    bool
    """
    for part in number.lower().split("/"):
        digits, _, exponent = part.partition("e")
        if len(digits) > LONGEST or len(exponent) > 4 or not abs(int(exponent or 0)) + len(digits) <= LARGEST_EXPONENT:
            return False
    return True


def takes_options(*taken: Field) -> Callable[[Function], Function]:
    """Give a function options as keyword arguments.

    They are passed on as the mapping `options`, and replace ``{options}`` in the docstring.

    Parameters
    ----------
    *taken : Field
        Fields that are options.

    Returns
    -------
    callable
        Decorator.
    """

    def decorate(function: Function) -> Function:
        own = inspect.signature(function)
        rest = {each.kind: each for each in own.parameters.values() if each.kind is each.VAR_KEYWORD}
        before = [each for each in own.parameters.values() if each.name != "options" and each.kind not in rest]
        aliases = {stated.alias: each.name for each in taken if (stated := each.metadata["option"]).alias}
        signature = own.replace(parameters=[*before, *map(_parameter, taken), *rest.values()])

        @wraps(function)
        def called(*arguments: Any, **keywords: Any) -> Any:
            given = signature.bind(*arguments, **{aliases.get(name, name): value for name, value in keywords.items()})
            given.apply_defaults()
            values = dict(given.arguments)
            options = {each.name: read(each, values.pop(each.name)) for each in taken}
            more = values.pop(rest[inspect.Parameter.VAR_KEYWORD].name) if rest else {}
            return function(**values, options=options, **more)

        called.__signature__ = signature
        called.__doc__ = inspect.cleandoc(function.__doc__ or "").replace("{options}", _documented(taken))
        return called

    return decorate


def _parameter(each: Field) -> inspect.Parameter:
    other = each.metadata["option"].in_python
    default = each.default if other is None else other
    default = str(default) if isinstance(default, StrEnum) else default
    return inspect.Parameter(each.name, inspect.Parameter.POSITIONAL_OR_KEYWORD, default=default)


def _documented(taken: Iterable[Field]) -> str:
    """Return the options as entries of the section "Parameters" of a docstring."""
    return "\n".join(f"{each.name} : {_type_name(each)}\n    {each.metadata['option'].help}" for each in taken)


def _type_name(each: Field) -> str:
    choices = choices_of(each)
    return f"{{{', '.join(map(repr, choices))}}}" if choices else " or ".join(NAMES[kind] for kind in _types(each))
