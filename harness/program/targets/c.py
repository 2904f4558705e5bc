"""A scene's model as a C11 library: source, header, CMakeLists.txt and a driver.

Every public name begins with the library's name, so several libraries link into one program. Vectors are arrays whose
indices the header enumerates. The array ``u`` contains the controls, then their time derivatives, then their second
time derivatives.
"""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from textwrap import fill, indent

from ...failures import ErrorKind, HolonomError
from ..c_source import (
    MANY,
    ONE,
    SourceParts,
    batch_support,
    body_of,
    comment_text,
    helpers_of,
    in_pieces,
    names_of,
    statements,
    title_of,
)
from ..identifiers import identifiers, require_identifier
from ..model import Model
from ..motion_program import Program, names_in
from ..rewriting import computing
from ..templates import filled, template

GIVEN = "double t, const double *q, const double *v, const double *u, const double *p"
UNKNOWN = "NAN"  # what has no value
NOT_A_NAME = re.findall(
    r"\w+",
    "assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp signal stdalign stdarg stdatomic "
    "stdbool stddef stdint stdio stdlib stdnoreturn string tgmath threads time uchar wchar wctype features strings "
    "c m all clean help install package test",
)  # headers of the C library, which NAME.h would hide, its parts that programs link, and targets of CMake
ENTRY = re.compile(r"J\[(\d+),(\d+)\]")  # of the constraints' Jacobian, counted from one


def write_model(model: Model, name: str) -> dict[str, str]:
    """Write a model as a library in C11.

    Parameters
    ----------
    model : Model
    name : str
        Name of the library, with which public names begin.

    Returns
    -------
    dict of str to str
        Text of each file by its name: NAME.h, NAME.c, NAME_driver.c, CMakeLists.txt.

    Raises
    ------
    HolonomError
        The name cannot name a C function, or is that of a header of the C library or a target of CMake.
    """
    require_identifier(name)
    if name.lower() in NOT_A_NAME:
        raise HolonomError(ErrorKind.NAME_TAKEN, detail=name)
    written = {"name": name, "NAME": name.upper(), "title": comment_text(f"{model.system.title}: {model.title}")}
    return {
        f"{name}.h": filled(
            "library.h",
            **written,
            explanation=fill(comment_text(explanation(model)), 112, initial_indent="   ", subsequent_indent="   "),
            enumerations="\n".join(_enumerations(model, name.upper())),
            law=comment_text(", ".join(model.under_law) or "the scene has none"),
            found=comment_text(", ".join(model.found) or "the scene has none"),
            outputs=comment_text(", ".join(model.observed) or "the scene has none"),
        ),
        f"{name}.c": _source(model, written),
        f"{name}_driver.c": filled("driver.c", **written),
        "CMakeLists.txt": filled("CMakeLists.txt", **written),
    }


def explanation(model: Model) -> str:
    """Return a paragraph on the inputs of a model.

    Parameters
    ----------
    model : Model

    Returns
    -------
    str
        Text for the header.
    """
    inputs = []
    if model.controls:
        inputs.append(f"u, the controls {', '.join(model.controls)}, then all their first, then all second derivatives")
    if model.parameters:
        inputs.append(f"p, the parameters {', '.join(model.parameters)}")
    given = "; ".join(inputs) or "none"
    return f"{title_of(model.motion)}. Inputs besides t, q and v: {given}. Other parameters have the scene's values."


def _enumerations(model: Model, prefix: str) -> Iterator[str]:
    groups = {
        "COORDINATE": model.coordinates,
        "MULTIPLIER": model.multipliers,
        "CONTROL": model.controls,
        "FOUND_CONTROL": model.found,
        "OUTPUT": model.observed,
        "PARAMETER": model.parameters,
    }
    for group, names in groups.items():
        members = [f"{prefix}_{group}_{identifier}" for identifier in identifiers(names)]
        yield f"enum {{ {', '.join([*members, f'{prefix}_{group}S'])} }};"


def _source(model: Model, written: Mapping[str, str]) -> str:
    many = in_pieces(
        model.motion,
        MANY,
        [f"lanes_at({place})" for place in _places(model, "{array} + {index}*points + i", "t + i")],
        [f"put_lanes({place}, {{value}});" for place in _results(model, "{array} + {index}*points + i")],
        "motion_batch",
        f"size_t points, size_t i, {GIVEN.replace('double t', 'const double *t')}, double *a, double *lambda",
    )
    one = partial(_function, inputs=_places(model, "{array}[{index}]", "t"))
    corrections = {
        f"{kind}_correction[{s}]": f"{array}[{s - 1}]"
        for kind, array in (("position", "dq"), ("velocity", "dv"))
        for s in range(1, len(model.coordinates) + 1)
    }
    functions = {
        "motion": one("motion", "a lambda", model.motion, _results(model, "{array}[{index}]")),
        "residual": _residual(model, one),
        "jacobian": _jacobian(model, one),
        "servo": _found("servo", model.servo, one, "found"),
        "outputs": _found("observe", model.outputs, one, "y"),
        "corrections": one(
            "corrections", "dq dv", model.projection, [corrections[name] for name in model.projection.outputs]
        ),
    }
    parts = _parts(model)
    return filled(
        "library.c",
        **written,
        part=", ".join(map(str, parts)),
        parts=max(parts) + 1,
        **{name: function.body for name, function in functions.items()},
        pieces="".join(function.functions for function in functions.values()),
        helpers=helpers_of(model.motion),
        names="\n".join(_names(model, written["name"])),
        start=body_of(_start(model), ["t", "q", "v"]),
        values=body_of((f"p[{i}] = {model.values.get(p, UNKNOWN)};" for i, p in enumerate(model.parameters)), ["p"]),
        tables="".join(_tables(model)),
        law=_law(model),
        operations=model.motion.operations,
        lanes=batch_support(many),
        many=indent(many.body, " " * 8),
        n=len(model.coordinates),
        m=len(model.controls),
        k=len(model.parameters),
        g=len(model.multipliers),
    )


def _function(
    name: str, arrays: str, program: Program | None, results: Sequence[str], inputs: Sequence[str]
) -> SourceParts:
    """Return a function's body that computes a program's outputs, perhaps empty."""
    parameters = ", ".join([GIVEN, *(f"double *{array}" for array in arrays.split())])
    if program is None:
        return SourceParts("", body_of((), names_of(parameters)))
    pieces = in_pieces(program, ONE, inputs, [f"{place} = {{value}};" for place in results], name, parameters)
    return replace(pieces, body=body_of([pieces.body], names_of(parameters)))


def _places(model: Model, item: str, time: str) -> list[str]:
    """Return the places of the inputs of the model's programs, in order."""
    lengths = {"q": len(model.coordinates), "v": len(model.coordinates), "u": 3 * len(model.controls)}
    lengths["p"] = len(model.parameters)
    return [time, *(item.format(array=array, index=i) for array, length in lengths.items() for i in range(length))]


def _results(model: Model, item: str) -> list[str]:
    """Return the places of the outputs of the motion program, in order."""
    lengths = {"a": len(model.coordinates), "lambda": len(model.multipliers)}
    return [item.format(array=array, index=i) for array, length in lengths.items() for i in range(length)]


def _names(model: Model, name: str) -> Iterator[str]:
    groups = {group: getattr(model, group) for group in ("coordinates", "multipliers", "controls", "parameters")}
    for group, members in {**groups, "found_controls": model.found, "outputs": model.observed}.items():
        listed = ", ".join([*map(_c_string, members), "NULL"])
        yield f"const char *const {name}_{group}[] = {{{listed}}};"


def _c_string(text: str) -> str:
    """Return a string literal of C that holds the text as UTF-8."""
    plain = "".join(
        chr(byte) if 32 <= byte < 127 and byte not in b'"\\?' else f"\\{byte:03o}" for byte in text.encode()
    )
    return f'"{plain}"'


def _start(model: Model) -> Iterator[str]:
    def value(name: str) -> str:
        return UNKNOWN if model.start is None else model.start[name]

    yield f"*t = {value('t')};"
    yield from (f"q[{s}] = {value(name)};" for s, name in enumerate(model.coordinates))
    yield from (f"v[{s}] = {value(f'dot({name})')};" for s, name in enumerate(model.coordinates))


def _tables(model: Model) -> Iterator[str]:
    """Yield the tables of the law as data, and the search for a time's polynomial."""
    for number, table in enumerate(model.tables):
        rows = ",\n".join(f"    {{{', '.join(map(repr, row))}}}" for row in table.rows)
        yield f"static const double table{number}[][{len(table.inputs)}] = {{\n{rows}}};\n\n"
    if model.tables:
        yield template("search.c")


def _law(model: Model) -> str:
    if model.law is None:
        return body_of((), ["t", "p", "u"])
    inputs = ["t", *(f"p[{index}]" for index in range(len(model.parameters)))]
    found = []
    for number, table in enumerate(model.tables):
        size = f"sizeof table{number}/sizeof *table{number}"
        found.append(f"const double *const piece{number} = piece_at(t, table{number}, {size});")
        inputs += [f"piece{number}[{place}]" for place in range(len(table.inputs))]
    results = [f"u[{model.histories.index(name)}] = {{value}};" for name in model.law.outputs]
    return body_of([*found, *statements(model.law, ONE, inputs, results)], ["t", "p", "u"])


def _residual(model: Model, function: Callable[..., SourceParts]) -> SourceParts:
    g = range(1, len(model.multipliers) + 1)
    places = {f"residual[{b}]": f"f[{b - 1}]" for b in g} | {f"residual_rate[{b}]": f"rate[{b - 1}]" for b in g}
    return _computed("residual", "f rate", model.constraints, places, function)


def _parts(model: Model) -> list[int]:
    """Return for each coordinate the number of the part that it is corrected with."""
    names = {f"position_correction[{s}]": name for s, name in enumerate(model.coordinates, start=1)}
    program = computing(model.projection, names)
    owner = {name: name for name in model.coordinates}  # of the names that coordinates determine, up to one of a part

    def part(name: str) -> str:
        while owner[name] != name:
            owner[name] = name = owner[owner[name]]
        return name

    for name, expression in (*program.assignments, *((names[name], value) for name, value in program.outputs.items())):
        for known in names_in(expression) & owner.keys():
            owner.setdefault(name, name)
            owner[part(known)] = part(name)
    first = list(dict.fromkeys(map(part, model.coordinates)))
    return [first.index(part(name)) for name in model.coordinates]


def _found(name: str, program: Program | None, function: Callable[..., SourceParts], array: str) -> SourceParts:
    """Return a function's body that computes a program's outputs into an array."""
    outputs = program.outputs if program else ()
    places = {output: f"{array}[{place}]" for place, output in enumerate(outputs)}
    return _computed(name, array, program, places, function)


def _jacobian(model: Model, function: Callable[..., SourceParts]) -> SourceParts:
    n = len(model.coordinates)
    outputs = model.constraints.outputs if model.constraints else ()
    entries = (ENTRY.fullmatch(name) for name in outputs)
    places = {entry[0]: f"J[{(int(entry[1]) - 1) * n + int(entry[2]) - 1}]" for entry in entries if entry}
    written = _computed("jacobian", "J", model.constraints, places, function)
    zeros = f"    memset(J, 0, {n * len(model.multipliers)}*sizeof *J);\n" if model.constraints else ""
    return replace(written, body=zeros + written.body)


def _computed(
    name: str, arrays: str, program: Program | None, places: Mapping[str, str], function: Callable[..., SourceParts]
) -> SourceParts:
    """Return a function's body that computes outputs of a program in their places."""
    wanted = program and computing(program, places)
    return function(name, arrays, wanted, [places[output] for output in wanted.outputs] if wanted else ())
