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

from holonom.confined import Limits
from holonom.documents import Document, ask
from holonom.maxima import run_rtest
from holonom.program.forms import MotionProgram
from holonom.program.motion_program import Solve
from holonom.program.request import Request

HERE = Path(__file__).parent
EXAMPLES = HERE.parent / "examples"
RTESTS = ("rtest_scene", "rtest_elimination", "rtest_kernels")
SCENES = {"pendulum.mac": {}, "linkage.mac": {}, "chain.mac": {"N": "5"}, "paper/paper.mac": {}}
LETTERS = "Gruß aus Αθήνα, 受控系统"


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


def programs(file: str, solve: Solve) -> dict:
    return json.loads(MotionProgram(EXAMPLES / file, Request(None, solve, SCENES[file]), Limits()).document)


@pytest.mark.parametrize("solve", Solve)
@pytest.mark.parametrize("file", SCENES)
def test_programs_are_the_same_to_the_last_operation(file, solve, other, monkeypatch):
    first = programs(file, solve)
    monkeypatch.setenv("PATH", f"{other}:{os.environ['PATH']}")
    assert programs(file, solve) == first


@pytest.mark.usefixtures("on_the_other")
def test_letters_of_every_script_come_through(write_scene):
    text = (EXAMPLES / "pendulum.mac").read_text(encoding="utf-8")
    scene = write_scene(re.sub(r'title( *)= "[^"]*"', f'title\\1= "{LETTERS}"', text, count=1))
    assert json.loads(ask(Document.RECORD, scene))["system"]["title"] == LETTERS
