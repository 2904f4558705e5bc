"""The modules of the package import one another in layers, without a circle; imports inside functions count."""

import ast
import tomllib
from collections.abc import Iterator
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import holonom

PACKAGE = Path(holonom.__file__).resolve().parent
MODULES = {
    ".".join(("holonom", *path.relative_to(PACKAGE).with_suffix("").parts)).removesuffix(".__init__"): path
    for path in PACKAGE.rglob("*.py")
}
EDGES = ("display", "cli", "companion", "reference")  # import results; no result imports them


def imported(name: str) -> Iterator[str]:
    """Yield the modules of the package that a module imports, not those that only its annotations name."""
    tree = ast.parse(MODULES[name].read_text(encoding="utf-8"))
    for_types = [
        each for each in ast.walk(tree) if isinstance(each, ast.If) and "TYPE_CHECKING" in ast.unparse(each.test)
    ]
    left_out = {id(node) for each in for_types for node in ast.walk(each)}
    package = name if MODULES[name].name == "__init__.py" else name.rpartition(".")[0]
    for node in ast.walk(tree):
        if id(node) in left_out:
            continue
        if isinstance(node, ast.Import):
            yield from (each.name for each in node.names if each.name in MODULES)
        elif isinstance(node, ast.ImportFrom):
            above = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            base = ".".join(filter(None, [*above, node.module]))
            for each in node.names:
                full = f"{base}.{each.name}"
                assert not node.level or {base, full} & MODULES.keys(), f"{name} imports {base}, which is not there"
                yield from (found for found in [full if full in MODULES else base] if found in MODULES)


@cache
def graph() -> dict[str, set[str]]:
    return {name: set(imported(name)) - {name} for name in MODULES}


def test_no_module_imports_itself_by_way_of_others():
    assert len(list(TopologicalSorter(graph()).static_order())) == len(MODULES)  # CycleError names the circle


def test_the_graph_holds_imports_of_every_form():
    assert "holonom.display.motion" in graph()["holonom.display"]  # inside a function, from a module beside
    assert "holonom.failures" in graph()["holonom.simulation.output"]  # from two levels up
    assert "holonom.cli" in graph()["holonom.__main__"]  # a package


@pytest.mark.parametrize("layer", EDGES)
def test_results_import_nothing_that_shows_them(layer):
    above = {name for name in MODULES if name.split(".")[1:2] and name.split(".")[1] in EDGES}
    importing = {name for name in MODULES if any(each.split(".")[1:2] == [layer] for each in graph()[name])}
    assert importing - above <= {"holonom.__main__", "holonom.scene", "holonom.installation"}


def test_every_package_is_installed():
    project = tomllib.loads((PACKAGE.parent / "pyproject.toml").read_text(encoding="utf-8"))
    listed = set(project["tool"]["setuptools"]["packages"])
    assert {name for name, path in MODULES.items() if path.name == "__init__.py"} <= listed


def test_only_the_crosscheck_differentiates_symbols():
    found = {
        name
        for name, path in MODULES.items()
        if not name.startswith("holonom.crosscheck.")
        for call in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(call, ast.Call) and differentiates(call.func)
    }
    assert found == set()


def differentiates(function: ast.expr) -> bool:
    """Return True for SymPy's derivatives, by method or by function, but not NumPy's differences."""
    name = ast.unparse(function)
    return name.rpartition(".")[2] in {"diff", "Derivative", "jacobian"} and not name.startswith("np.")
