"""Truth: scenes that cannot be measured are refused in one sentence, before anything is."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from confinement import without_notice
from refusing import message_of

from holonom.benchmark.work_precision import study
from holonom.cli import holonom
from holonom.failures import ErrorKind

PAPER = Path(__file__).parents[3] / "examples" / "paper" / "paper.mac"
SCENE = """
load("holonom.mac")$
bob : holonomic_system(
  coordinates    = [x, y],
  kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  constraints    = [{constraints}])$
slide : holonomic_scene(bob, initial_state = [x = 0, y = 0, dot(x) = 1, dot(y) = 1]{span})$
"""


@pytest.mark.parametrize(
    ("constraints", "span", "said"),
    [
        ("x - y", "", message_of(ErrorKind.NO_END, "slide")),
        ("(x - y)^2", ", time_span = [0, 1]", message_of(ErrorKind.REFUSED, "constraint 1")),
    ],
)
def test_a_scene_that_cannot_be_measured_is_refused_in_one_sentence(write_scene, tmp_path, constraints, span, said):
    written = tmp_path / "study.json"
    scene = write_scene(SCENE.format(constraints=constraints, span=span))
    command = [sys.executable, "-m", "holonom", "accuracy", str(scene), "--json", str(written)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 2
    assert re.search(said, done.stderr)
    assert len(without_notice(done.stderr).splitlines()) == 1
    assert done.stdout == ""
    assert not written.exists()


@pytest.mark.parametrize("option", ["--json", "--plot"])
def test_an_output_that_cannot_be_written_was_noticed_after_the_measurements(monkeypatch, tmp_path, capsys, option):
    monkeypatch.setattr(study, "study", lambda *_, **__: pytest.fail("it was measured first"))
    output = tmp_path / "no" / "such.svg"
    assert holonom(["accuracy", str(PAPER), option, str(output)], standalone_mode=False) == 2
    assert re.search(message_of(ErrorKind.UNWRITABLE), capsys.readouterr().err)
