"""Every entry, command, option, field and public name has its place in the reference."""

import io
import json
import re
import shutil
import subprocess
from pathlib import Path

import click
import pytest
from sphinx.application import Sphinx
from sphinx.util.docutils import docutils_namespace

import holonom
from holonom.cli import holonom as command_line
from holonom.document_types import TYPES, schema
from holonom.reference.entries import function_texts, part_texts, step_texts, tool_texts
from holonom.reference.pages import fields_of

SOURCE = Path(holonom.__file__).parent / "companion"
ALONE = {"root_doc": "reference/index", "include_patterns": ["reference/*"]}


def build(folder: Path, builder: str) -> Sphinx:
    """Build the reference alone; a warning of Sphinx is a failure."""
    warnings = io.StringIO()
    with docutils_namespace():
        app = Sphinx(SOURCE, SOURCE, folder, folder / "doctrees", builder, dict(ALONE), None, warnings)
        app.build()
    assert warnings.getvalue() == ""
    return app


@pytest.fixture(scope="module")
def reference(tmp_path_factory) -> Sphinx:
    return build(tmp_path_factory.mktemp("reference"), "man")


@pytest.fixture(scope="module")
def objects(reference) -> set[tuple[str, str]]:
    """Kind and name of all that the reference describes."""
    domains = reference.env.domains.sorted()
    return {(kind, name) for domain in domains for name, _, kind, *_ in domain.get_objects()}


def test_every_maxima_entry_and_function_has_a_place(objects):
    entries = {f"{function.name}: {entry.name}" for function in function_texts() for entry in function.entries}
    functions = {each.name for each in (*function_texts(), *part_texts(), *step_texts(), *tool_texts())}
    assert {("maxima-entry", name) for name in entries} <= objects
    assert {("maxima-function", name) for name in functions} <= objects


@pytest.mark.parametrize("name", command_line.commands)
def test_every_command_and_every_option_has_a_place(name, objects):
    command = command_line.commands[name]
    assert command.help
    for option in (each for each in command.params if isinstance(each, click.Option) and not each.hidden):
        assert option.help, option.name
        assert all(("cmdoption", f"holonom-{name}.{each}") in objects for each in option.opts)


def test_options_of_the_command_line_itself_are_explained(objects):
    assert {("cmdoption", f"holonom.{each}") for each in ("-v", "--verbose", "-q", "--quiet", "--version")} <= objects


@pytest.mark.parametrize("name", TYPES)
def test_every_field_of_a_document_is_described(name):
    assert [path for path, _, text in fields_of(schema(name)) if not text] == []


@pytest.mark.long
def test_the_page_about_documents_links_to_their_schemas(tmp_path):
    build(tmp_path, "html")
    links = re.findall(r'href="(\.\./_static/schemas/[^"]*)"', (tmp_path / "reference" / "documents.html").read_text())
    schemas = [json.loads((tmp_path / "reference" / link).read_text()) for link in links]
    assert {each["title"] for each in schemas} == {f"holonom-{name}" for name in TYPES}


@pytest.mark.parametrize("name", holonom.__all__)
def test_every_public_name_has_a_place(name, objects):
    assert f"holonom.{name}" in {name for _, name in objects}


def returned_classes() -> set[str]:
    """Names of the classes of Holonom that public methods of a scene and `sweep` return."""
    methods = [holonom.sweep, *(each for name, each in vars(holonom.Scene).items() if not name.startswith("_"))]
    functions = [getattr(each, "func", None) or getattr(each, "fget", None) or each for each in methods]
    returned = " ".join(str(each.__annotations__.get("return")) for each in functions)
    return set(re.findall(r"\b[A-Z]\w+", returned)) - {"Mapping", "None"}


@pytest.mark.parametrize("name", sorted(returned_classes()))
def test_every_returned_class_has_a_place(name, objects):
    assert name in {each.rpartition(".")[2] for kind, each in objects if kind == "class"}


@pytest.mark.skipif(shutil.which("groff") is None, reason="groff is not installed")
def test_groff_accepts_the_manual_page(reference):
    command = ["groff", "-man", "-ww", "-Tutf8", str(reference.outdir / "holonom.1")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stderr == ""
    assert all(re.search(rf"^\s*holonom {name} ", done.stdout, re.MULTILINE) for name in command_line.commands)
