"""A scene's model as a MATLAB or Octave function that returns function handles."""

import re
from collections.abc import Iterable, Iterator
from textwrap import indent

from ...failures import ErrorKind, HolonomError
from ...hidden import visible_line
from ..c_source import IN_SPAN, ONE, Target, comment_text, title_of
from ..identifiers import require_identifier
from ..model import Model
from ..model_functions import ModelFunction, body, called, given, has_law, model_functions
from ..templates import filled

MATLAB = Target("{name} = {formula};", ONE.arithmetic)
HELPERS = {
    "fabs": "y = fabs(x)\ny = abs(x);",
    "square": "y = square(x)\ny = x*x;",
    "cube": "y = cube(x)\ny = x*x*x;",
    "pow": "z = pow(x, y)\nz = real_or_nan(x^y);",
    **{
        name: f"y = {name}(x)\ny = real_or_nan(builtin('{name}', x));"
        for name in ("sqrt", "log", "asin", "acos", "acosh", "atanh")
    },
}
"""Functions that MATLAB lacks, or that have complex values there."""
KEYWORDS = re.findall(
    r"\w+",
    "break case catch continue else elseif end for function global if otherwise parfor persistent return spmd switch "
    "try until while",
)  # of MATLAB and Octave
REAL_OR_NAN = "y = real_or_nan(y)\nif ~isreal(y), y = NaN; end"
NOT_IN_SPAN = "t = in_span(t)\nif t < {} || t > {}, t = NaN; end"
PIECE = "piece = piece_at(t, pieces)\npiece = pieces(max([1; find(pieces(:, 1) <= t, 1, 'last')]), :);"


def write_model(model: Model, name: str) -> str:
    """Write a model as a file for MATLAB and GNU Octave.

    Parameters
    ----------
    model : Model
    name : str
        Name of the function and of its file.

    Returns
    -------
    str
        Source text.

    Raises
    ------
    HolonomError
        The name cannot name a function, or the functions contain it.
    """
    require_identifier(name)
    functions = list(model_functions(model))
    parts = [*(_formulas(each, model) for each in functions)]
    if has_law(model):
        parts.append(_rhs(model))
    helpers = [text for helper, text in HELPERS.items() if helper in called("\n".join(parts))]
    real = [REAL_OR_NAN] if any("real_or_nan" in each for each in helpers) else []
    pieces = [PIECE] if model.tables else []
    in_span = [NOT_IN_SPAN.format(*model.motion.times)] if IN_SPAN in called("\n".join(parts)) else []
    written = "\n\n\n".join(f"function {each}\nend" for each in [*parts, *pieces, *in_span, *helpers, *real])
    if name in {*KEYWORDS, *re.findall(r"[A-Za-z]\w*", written)}:
        raise HolonomError(ErrorKind.NAME_TAKEN, detail=name)
    return filled(
        "functions.m",
        name=name,
        title=comment_text(title_of(model.motion)),
        state=_names(model.state),
        controls=_names(model.histories),
        parameters=_names(model.parameters),
        time=given(model, ["t"], "NaN"),
        start=given(model, model.state, "NaN"),
        values=given(model, model.parameters, "NaN"),
        handles="\n".join(_handles(functions, model)),
        functions=written,
    )


def _names(names: Iterable[str]) -> str:
    """Return the inside of a cell array of names."""
    return ", ".join("'" + visible_line(name).replace("'", "''") + "'" for name in names)


def _handles(functions: Iterable[ModelFunction], model: Model) -> Iterator[str]:
    for each in functions:
        yield f"model.{each.name} = @{each.name};"
        yield f"model.outputs.{each.name} = {{{_names(each.program.outputs)}}};"
    if has_law(model):
        yield "model.rhs = @rhs;  % the time derivatives of y under the law"


def _formulas(function: ModelFunction, model: Model) -> str:
    places = {"t": 1, "y": len(model.state), "u": len(model.histories), "p": len(model.parameters)}
    inputs = [
        "t" if name == "t" else f"{name}({place})"
        for name in function.arguments
        for place in range(1, places[name] + 1)
    ]
    tables = []
    for number, table in enumerate(model.tables if function.name == "law" else (), start=1):
        rows = ";\n".join(", ".join(map(repr, row)) for row in table.rows)
        tables.append(f"piece{number} = piece_at(t, [\n{indent(rows, '    ')}]);")
        inputs += [f"piece{number}({place})" for place in range(1, len(table.inputs) + 1)]
    assignments, rows = body(function, MATLAB, inputs)
    taken = f"rows = {function.name}({', '.join(function.arguments)})"
    return "\n".join([taken, *tables, *assignments, f"rows = [{'; '.join(rows)}];"])


def _rhs(model: Model) -> str:
    n, u = len(model.coordinates), "law(t, p)" if model.controls else "[]"
    return f"dy = rhs(t, y, p)\nrows = motion(t, y, {u}, p);\ndy = [y({n + 1}:{2 * n}); rows(1:{n})];"
