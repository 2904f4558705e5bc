"""Every snippet of the README runs as it stands there."""

import re
import shlex
from functools import partial
from itertools import pairwise
from pathlib import Path

import pytest
from snippets import LONG, in_a_process, require_parts, snippets_of

from holonom import system
from holonom.cli import holonom

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = snippets_of(ROOT / "README.md")
OUTPUTS = {
    before.splitlines()[-1].partition("#")[0]: text for (_, before), (kind, text) in pairwise(BLOCKS) if kind == "text"
}


def blocks(language: str) -> list[str]:
    return [text for kind, text in BLOCKS if kind == language]


def commands() -> list[list[str]]:
    lines = "".join(blocks("sh")).splitlines()
    return [words for line in lines if (words := shlex.split(line, comments=True))]


def test_the_chinese_readme_says_the_same_to_the_machine():
    """Its commands, scenes and outputs are those that are compared with runs here."""
    text = (ROOT / "README.zh.md").read_text(encoding="utf-8")
    found = snippets_of(ROOT / "README.zh.md")
    lines = [shlex.split(line, comments=True) for kind, block in found if kind == "sh" for line in block.splitlines()]
    assert [line for line in lines if line not in commands()] == []
    assert [block for block in found if block[0] in ("maxima", "text")] == [
        block for block in BLOCKS if block[0] in ("maxima", "text")
    ]
    assert all((ROOT / link).exists() for link in re.findall(r"\]\(([^)]+)\)", text))


@pytest.fixture(scope="module")
def place(tmp_path_factory) -> Path:
    """A directory with the README's scene and the examples."""
    directory = tmp_path_factory.mktemp("readme")
    scene, _ = blocks("maxima")
    (directory / "my_pendulum.mac").write_text(scene, encoding="utf-8")
    for name in ("examples", "maxima"):
        (directory / name).symlink_to(ROOT / name)
    return directory


@pytest.mark.parametrize("name", ["README.md", "README.zh.md"])
def test_a_readme_is_short(name):
    assert len((ROOT / name).read_text(encoding="utf-8").splitlines()) <= 220


def test_there_are_snippets_of_each_kind():
    assert {kind for kind, _ in BLOCKS} == {"sh", "text", "python", "maxima"}


def test_each_output_follows_a_command_that_is_run():
    assert len(OUTPUTS) == 3
    assert {*OUTPUTS} <= {shlex.join(command) for command in commands()}


def test_times_beside_peers_are_those_of_the_benchmark():
    header, _, row = README[README.index("| Holonom | ") :].splitlines()[:3]
    names, shown = ([cell.strip() for cell in line.strip("|").split("|")] for line in (header, row))
    measured = (ROOT / "tests" / "benchmarks" / "simulation.txt").read_text(encoding="utf-8")
    for name, number in zip(names, shown, strict=True):
        method = {"Holonom": "Holonom, Taylor"}.get(name, name)
        found = re.search(rf"^pendulum +{method} +([0-9.]+)", measured, re.MULTILINE)[1]
        assert number == f"{float(found):.3g}", name


@pytest.mark.parametrize("command", commands(), ids=" ".join)
def test_a_command_of_the_readme_runs(command, place, monkeypatch, holonom_here, request):
    if "fmu" in command:
        request.getfixturevalue("c_compiler")
    monkeypatch.chdir(place)
    program, *arguments = command
    if program == "make":
        targets = re.findall(r"^(\w+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
        assert set(arguments) <= set(targets)
    elif program == "holonom" and arguments[0] in LONG:
        subcommand = holonom.get_command(None, arguments[0])
        subcommand.make_context(arguments[0], arguments[1:])
    else:
        run = holonom_here if program == "holonom" else partial(in_a_process, program)
        done = run(*arguments)
        assert done.returncode == 0, done.stderr
        assert "Traceback" not in done.stderr
        assert " error" not in done.stdout.replace("energy error", "")
        require_parts(OUTPUTS.get(shlex.join(command), ""), done.stdout.split())


def test_the_python_of_the_readme_runs(place, monkeypatch):
    monkeypatch.chdir(place)
    names: dict[str, object] = {}
    for text in blocks("python"):
        exec(compile(text, "README.md", "exec"), names)
    assert names["numbers"] == pytest.approx(names["same"], rel=1e-12)
    assert names["motion"]["x"][0] == 0.6
    assert (place / "swing.svg").exists()


def test_what_the_readme_points_to_is_there():
    targets = re.findall(r"\]\(([^)#:]+)\)", README)
    assert [target for target in targets if not (ROOT / target).exists()] == []


def test_the_parts_of_the_readme_make_a_pendulum():
    _, parts = blocks("maxima")
    described = system(parts).system
    assert described.coordinates == ("x", "y")
    assert [str(constraint) for constraint in described.constraints] == ["-l**2/2 + y**2/2 + (-u + x)**2/2"]
