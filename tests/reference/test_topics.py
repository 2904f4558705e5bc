"""Every entry, command, option, field and public name has its place in the reference."""

import json
import shutil
import subprocess

import click
import pytest

import holonom
from holonom.cli import holonom as command_line
from holonom.formats import SCHEMAS
from holonom.reference.entries import function_texts, part_texts, step_texts
from holonom.reference.manual import manual_page
from holonom.reference.topic import Table, Topic
from holonom.reference.topics import command_options, topics

TOPICS = {topic.slug: topic for topic in topics()}


def rows(topic: Topic) -> dict[str, tuple[str, ...]]:
    return {row[0]: row[1:] for part in topic.parts if isinstance(part, Table) for row in part.rows}


def field_names(schema: object) -> set[str]:
    """Names of all properties that a schema states, at any depth."""
    if isinstance(schema, list):
        return set().union(*map(field_names, schema))
    if not isinstance(schema, dict):
        return set()
    own = set(schema["properties"]) if isinstance(schema.get("properties"), dict) else set()
    return own.union(*map(field_names, schema.values()))


def test_slugs_are_unique():
    assert len(TOPICS) == len(topics())


@pytest.mark.parametrize("function", function_texts(), ids=lambda function: function.name)
def test_every_entry_has_a_page(function):
    assert rows(TOPICS[function.name]).keys() >= {entry.name for entry in function.entries}
    assert all(f"{function.name}-{entry.name}" in TOPICS for entry in function.entries)


def test_every_function_for_bodies_has_a_page():
    assert all(f"part-{part.name}" in TOPICS for part in part_texts())


def test_every_step_has_a_page():
    assert all(f"step-{step.name}" in TOPICS for step in step_texts())


@pytest.mark.parametrize("name", command_line.commands)
def test_every_command_and_every_option_has_a_page(name):
    topic, command = TOPICS[f"holonom-{name}"], command_line.commands[name]
    assert topic.summary
    written = " ".join(rows(topic))
    for option in command_options(command):
        assert all(each in written.replace(",", " ").split() for each in option.opts)
    assert all(explained[0] for explained in rows(topic).values()), "an option without a description"


def test_options_of_the_command_line_itself_are_explained():
    options = [each for each in command_line.params if isinstance(each, click.Option)]
    assert all(option.help for option in options)
    assert {"-v, --verbose", "-q, --quiet"} <= {", ".join(sorted(o.opts, key=len)) for o in options}


@pytest.mark.parametrize("file", sorted(SCHEMAS.glob("*.json")), ids=lambda file: file.stem)
def test_every_document_and_every_field_has_a_page(file):
    schema = json.loads(file.read_text(encoding="utf-8"))
    topic = TOPICS[f"document-{file.stem}"]
    assert field_names(schema) <= {path.rpartition(".")[2] for path in rows(topic)}
    plain = [name for name, field in schema["properties"].items() if "const" not in field]
    assert [name for name in plain if not rows(topic)[name][0]] == [], "a field without a description"


@pytest.mark.parametrize("name", holonom.__all__)
def test_every_public_name_has_a_page(name):
    assert TOPICS[f"python-{name}"].summary


def test_every_method_of_a_scene_is_on_its_page():
    captions = {part.caption for part in TOPICS["python-Scene"].parts}
    assert {"equations", "check", "free", "effects", "series", "simulate", "rhs", "program", "symbols"} <= captions


@pytest.mark.skipif(shutil.which("groff") is None, reason="groff is not installed")
def test_groff_has_nothing_to_say_of_the_manual_page():
    command = ["groff", "-man", "-ww", "-Tutf8"]
    done = subprocess.run(command, input=manual_page(), capture_output=True, text=True, check=True)
    assert done.stderr == ""
    assert "holonom simulate" in done.stdout.lower()


def test_the_manual_page_names_every_command():
    text = manual_page()
    assert text.startswith(".TH HOLONOM 1")
    headings = text.replace("\\-", "-").splitlines()
    assert all(f'.SH "HOLONOM {name.upper()}"' in headings for name in command_line.commands)
