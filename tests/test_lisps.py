"""Every Lisp finds the same: sorting, hash tables, text and numbers are the library's own, to the last operation.

Maximas on other Lisps are those that `maxima --list-avail` tells of, where they are several, and those that the
variable HOLONOM_TEST_MAXIMAS names: paths with colons between them.
"""

import json
import os
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest
from rtests import run_rtest

from holonom.documents import ask
from holonom.formats import Document
from holonom.program.forms import MotionProgram
from holonom.program.request import Request, Solve
from holonom.sandbox import Limits

HERE = Path(__file__).parent
EXAMPLES = HERE.parent / "examples"
RTESTS = ("rtest_scene", "rtest_elimination", "rtest_kernels")
SCENES = {"pendulum.mac": {}, "linkage.mac": {}, "chain.mac": {"N": "5"}, "paper/paper.mac": {}}
LETTERS = "Gruß aus Αθήνα, 受控系统"
# h and l are in two of the three terms that stay when a is taken out, k and m in one: either can be taken out next.
TIE = """
load("holonom.mac")$
system : holonomic_system(coordinates = [a, b, c, d, h, k, l, m], controls = [], parameters = [],
  kinetic_energy = (dot(a)^2 + dot(b)^2 + dot(c)^2 + dot(d)^2 + dot(h)^2 + dot(k)^2 + dot(l)^2 + dot(m)^2)/2,
  forces = [push = [a*b + a*c + a*d + h*k + h*l + l*m, 0, 0, 0, 0, 0, 0, 0]],
  constraints = [a - b])$
"""


def others() -> list[str]:
    """Commands that start another Maxima."""
    named = [path for path in os.environ.get("HOLONOM_TEST_MAXIMAS", "").split(":") if path]
    if (first := shutil.which("maxima")) is None:
        return named
    told = subprocess.run([first, "--list-avail"], capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=60)
    known = re.findall(r"^version (\S+), lisp (\S+)", told.stdout, re.MULTILINE)
    return [*named, *(f"{first} -u {version} -l {lisp}" for version, lisp in known if len(known) > 1)]


@pytest.fixture(scope="module", params=others() or [pytest.param("", marks=pytest.mark.skip("there is one Lisp"))])
def other(request, tmp_path_factory) -> Path:
    """A directory whose `maxima` is on another Lisp."""
    place = tmp_path_factory.mktemp("lisp")
    command = place / "maxima"
    command.write_text(f'#!/bin/sh\nexec {" ".join(map(shlex.quote, request.param.split()))} "$@"\n', encoding="utf-8")
    command.chmod(0o755)
    return place


@pytest.fixture
def on_the_other(other, monkeypatch) -> None:
    monkeypatch.setenv("PATH", f"{other}:{os.environ['PATH']}")


@pytest.mark.usefixtures("on_the_other")
@pytest.mark.parametrize("name", RTESTS)
def test_rtest_passes_on_another_lisp(name):
    assert run_rtest(HERE / "maxima" / f"{name}.mac") > 0


def program(file: Path, solve: Solve, settings: dict[str, str]) -> dict:
    return json.loads(MotionProgram(file, Request(None, solve, settings), Limits()).document)


def record(file: Path, settings: dict[str, str]) -> dict:
    """The record, but for the version of the Maxima that wrote it."""
    written = json.loads(ask(Document.RECORD, file, settings=settings))
    return {name: part for name, part in written.items() if name != "maxima"}


@pytest.mark.parametrize("solve", Solve)
@pytest.mark.parametrize("file", SCENES)
def test_programs_are_the_same_to_the_last_operation(file, solve, other, monkeypatch):
    first = program(EXAMPLES / file, solve, SCENES[file])
    monkeypatch.setenv("PATH", f"{other}:{os.environ['PATH']}")
    assert program(EXAMPLES / file, solve, SCENES[file]) == first


@pytest.mark.parametrize("file", SCENES)
def test_records_are_the_same(file, other, monkeypatch):
    first = record(EXAMPLES / file, SCENES[file])
    monkeypatch.setenv("PATH", f"{other}:{os.environ['PATH']}")
    assert record(EXAMPLES / file, SCENES[file]) == first


def test_of_letters_as_common_every_lisp_takes_the_same_out(write_scene, other, monkeypatch):
    scene = write_scene(TIE)
    first = program(scene, Solve.DIRECT, {})
    monkeypatch.setenv("PATH", f"{other}:{os.environ['PATH']}")
    assert program(scene, Solve.DIRECT, {}) == first


@pytest.mark.usefixtures("on_the_other")
def test_letters_of_every_script_come_through(write_scene):
    text = (EXAMPLES / "pendulum.mac").read_text(encoding="utf-8")
    scene = write_scene(re.sub(r'title( *)= "[^"]*"', f'title\\1= "{LETTERS}"', text, count=1))
    assert json.loads(ask(Document.RECORD, scene))["system"]["title"] == LETTERS
