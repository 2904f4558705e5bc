"""A scene's model as the text of a Python module for a numerical package."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from textwrap import fill, indent

from .c_source import IN_SPAN, ONE, Target, comment_text, title_of
from .model import Model
from .model_functions import ModelFunction, body, called, given, has_law, model_functions
from .rewriting import with_joined_roots
from .templates import filled

PYTHON = Target("{name} = {formula}", ONE.arithmetic)
CUBE = """\
def cube(x):
    return x*x*x"""
USAGE = (
    "Functions of the time t, the state y, the controls u with their first and second time derivatives, and the "
    "parameters p. The names of arguments and results are below."
)
LAWLESS = " A control has no law. Therefore the module has no functions law and rhs."
RHS = '''\
def rhs(t, y, p):
    """Return the time derivatives of y under the law."""
    points, rows = _points(t, y=y, p=p), motion(t, y, {u}, p)
    return _stacked([*points[{n} + 1 : 2*{n} + 1], *(rows[place] for place in range({n}))], points)'''


@dataclass(frozen=True)
class Package:
    """The package that a module computes with."""

    module: str  # that has the functions
    usage: str  # lines of the description
    support: str  # ``_points`` and ``_stacked``
    imports: str  # what the support needs
    in_span: str  # the time if functions of it have values, between two ``{}``
    elsewhere: Mapping[str, str] = field(default_factory=dict)  # functions that another module has
    renamed: Mapping[str, str] = field(default_factory=dict)  # functions that it calls otherwise than C
    own: frozenset[str] = frozenset({"cube"})  # functions that the module itself has
    differentiates: bool = False  # whether its users do


def module_text(model: Model, name: str, package: Package, ending: str = "") -> str:
    """Return a model as a Python module with the functions of `model_functions`.

    Parameters
    ----------
    model : Model
    name : str
        Name of the module, for its title.
    package : Package
        Package that the module computes with.
    ending : str
        Text after the functions.

    Returns
    -------
    str
        Source text of the module.
    """
    functions = list(model_functions(model))
    if package.differentiates:
        functions = [each._replace(program=with_joined_roots(each.program)) for each in functions]
    text = "\n\n\n".join(_functions(model, functions))
    in_span = package.in_span.format(*model.motion.times) if IN_SPAN in called(text) else ""
    support = [package.support.rstrip(), CUBE if "cube" in called(text) else "", in_span, _tables(model)]
    return filled(
        "functions.py.txt",
        title=comment_text(f"{name}: {title_of(model.motion)}"),
        usage=fill(f"{USAGE}{'' if has_law(model) else LAWLESS} {package.usage}", 120),
        imports="\n".join(_imports(model, called(text) - package.own - {IN_SPAN}, package)),
        state=_names(model.state),
        controls=_names(model.histories),
        parameters=_names(model.parameters),
        outputs="\n".join(f'    "{each.name}": ({_names(each.program.outputs)}),' for each in functions),
        time=given(model, ["t"], "nan"),
        start=given(model, model.state, "nan"),
        values=given(model, model.parameters, "nan"),
        support="\n\n\n".join(filter(None, support)),
        functions=f"{text}\n\n\n{ending}".rstrip(),
    )


def _names(names: Iterable[str]) -> str:
    """Return the inside of a tuple of names."""
    return "".join(f"{name!a}, " for name in names).rstrip(" ")


def _imports(model: Model, functions: set[str], package: Package) -> Iterator[str]:
    yield package.imports
    if model.tables:
        yield "import numpy"
    modules = {function: package.elsewhere.get(function, package.module) for function in functions}
    for module in sorted(set(modules.values())):
        names = sorted(_imported(function, package) for function in functions if modules[function] == module)
        yield f"from {module} import {', '.join(names)}"


def _imported(function: str, package: Package) -> str:
    return f"{package.renamed[function]} as {function}" if function in package.renamed else function


def _functions(model: Model, functions: Iterable[ModelFunction]) -> Iterator[str]:
    for each in functions:
        yield _function(each, "points += _pieces(points[0])" if each.name == "law" and model.tables else "")
    if has_law(model):
        u = "law(t, p)" if model.controls else "p[:0]"
        yield RHS.format(u=u, n=len(model.coordinates))


def _function(function: ModelFunction, pieces: str) -> str:
    arguments = ", ".join(function.arguments)
    named = ", ".join(each if each == "t" else f"{each}={each}" for each in function.arguments)
    inputs = [f"points[{place}]" for place in range(len(function.program.inputs))]
    assignments, rows = body(function, PYTHON, inputs)
    lines = [
        f'"""Return OUTPUTS["{function.name}"]."""',
        f"points = _points({named})",
        *filter(None, [pieces]),
        *assignments,
        f"return _stacked([{', '.join(rows)}], points)",
    ]
    return f"def {function.name}({arguments}):\n" + indent("\n".join(lines), " " * 4)


def _tables(model: Model) -> str:
    """Return the tables of the law as arrays, and the search for a time's polynomials."""
    if not model.tables:
        return ""
    rows = (",\n        ".join(map(repr, map(list, table.rows))) for table in model.tables)
    tables = "\n".join(f"    [\n        {each},\n    ]," for each in rows)
    return filled("pieces.py.txt", tables=tables).strip()
