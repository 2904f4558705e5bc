"""What a scene says reaches terminals, pictures, XML and tables as text, and as nothing else."""

import csv
import io
import json
import re
import subprocess
import sys
import zipfile
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from particle import PARTICLE
from rich.table import Table
from rich.text import Text

from holonom.display.progress import motion_progress
from holonom.display.text import PlainConsole, html_of, text_of
from holonom.failures import ErrorKind, HolonomError
from holonom.figures.style import Picture, figure_style, new_figure, svg_text
from holonom.hidden import visible, visible_line
from holonom.program.model import scene_model
from holonom.program.request import Request
from holonom.program.targets import fmu
from holonom.sandbox import Limits
from holonom.simulation.output import sample_file
from holonom.simulation.result import Sampled

STEERING = "\x1b[2J\x1b]0;mine\x07 \x9b31m \r forged \x08\x7f"
TURNING = "\u202eproved\u202c \u2066a\u2069 \u200e\u200f\u061c \u2028\u2029 \ufeff\u200b\U000e0041"
HOSTILE = STEERING + TURNING + "\x00\x01\ufffe\udc80"
MARKUP = "[/nope] [red]a[/red] [link=https://example.org]b[/link] :smile: $\\frac$ $x & <b> ]]> -->"
UNSEEN = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200b-\u200f\u2028-\u202e\u2066-\u2069\ufeff\ud800-\udfff]")


def test_each_character_is_seen_and_what_is_seen_stays():
    assert visible("\x1b\x9b\u202e\U000e0041") == r"\x1b\x9b\u202e\U000e0041"
    plain = "λ₁ = φ̇ 导出 \N{COMBINING DIAERESIS} é \\x1b\n\tx"
    assert visible(plain) == plain
    assert visible_line("a\nproved\t1\r") == r"a\nproved 1\x0d"
    assert not UNSEEN.search(visible(HOSTILE))


def shown(console) -> None:
    table = Table("name", title=HOSTILE)
    table.add_column(HOSTILE)
    table.add_row(MARKUP, HOSTILE)
    table.add_row(Text(HOSTILE), "1")
    console.print(HOSTILE, style="bold")
    console.print(MARKUP)
    console.print(table)


@pytest.mark.parametrize("terminal", [False, True])
def test_a_console_takes_text_for_text(terminal):
    printed = io.StringIO()
    shown(PlainConsole(file=printed, width=1000, force_terminal=terminal, color_system=None))
    own_styles = re.sub(r"\x1b\[[\d;]*m", "", printed.getvalue())
    assert not UNSEEN.search(own_styles)
    assert own_styles.count(MARKUP) == 2


def test_what_a_notebook_shows_is_text():
    assert not UNSEEN.search(text_of(shown))
    assert not UNSEEN.search(html_of(shown))
    assert "<b>" not in html_of(shown)


def test_a_bar_of_progress_takes_a_title_for_text(monkeypatch):
    said = io.StringIO()
    monkeypatch.setattr(said, "isatty", lambda: True, raising=False)
    monkeypatch.setattr(sys, "stderr", said)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "1000")
    with motion_progress(HOSTILE + MARKUP) as done:
        done(0.5)
    assert "[/nope]" in said.getvalue()
    assert "mine\x07" not in said.getvalue()
    assert "\u202e" not in said.getvalue()


def test_a_sentence_is_seen():
    assert not UNSEEN.search(str(HolonomError(ErrorKind.REFUSED, HOSTILE, HOSTILE)))
    assert not UNSEEN.search(HolonomError(ErrorKind.REFUSED, HOSTILE, HOSTILE).message())


@pytest.mark.parametrize("text", [HOSTILE, MARKUP, "$x$ $\\frac$", "a$b", "\\$ $"])
def test_a_figure_takes_titles_and_names_for_text(text, tmp_path):
    with figure_style():
        figure = new_figure(60, 3)
        axes = figure.subplots()
        axes.semilogy([1, 2], [1, 1000], label=f"x{text}")
        axes.set_title(text)
        axes.set_xlabel(text)
        axes.legend()
        first = svg_text(figure)
    root = ElementTree.fromstring(first)
    texts = ["".join(each.itertext()) for each in root.iter("{http://www.w3.org/2000/svg}text")]
    assert visible(text).replace("\\$", "$") in [each.replace("\\$", "$") for each in texts]
    Picture(figure).save(tmp_path / "figure.svg")
    again = ElementTree.parse(tmp_path / "figure.svg").getroot()
    assert ["".join(each.itertext()) for each in again.iter("{http://www.w3.org/2000/svg}text")] == texts
    Picture(figure).save(tmp_path / "figure.png")
    assert (tmp_path / "figure.png").read_bytes().startswith(b"\x89PNG")


def test_a_unit_holds_xml(write_scene, c_compiler):
    file = write_scene(PARTICLE.partition("\n")[2])
    model = replace(scene_model(file, Request(), (), Limits()), title=HOSTILE + MARKUP, system=HOSTILE)
    with zipfile.ZipFile(io.BytesIO(fmu.write_model(model, "unit"))) as unit:
        root = ElementTree.fromstring(unit.read("modelDescription.xml"))
    assert root.get("modelName").replace("\r", r"\x0d") == visible(HOSTILE + MARKUP)


NAMES = ("a,b", 'a"b', "a\nb", "=cmd", "+x", "-x", "@x", "\tx", "\x1bx", "file")


def samples_of(names: tuple[str, ...]) -> Sampled:
    numbers = np.array([0.5, -1.5])
    empty: dict = {}
    return Sampled(np.array([0.0, 1.0]), dict.fromkeys(names, numbers), empty, empty, empty, empty, empty)


def test_a_heading_is_one_cell_and_no_formula(tmp_path):
    with sample_file(tmp_path / "x.csv", 17) as take:
        take(samples_of(NAMES))
        take(samples_of(NAMES))
    with (tmp_path / "x.csv").open(newline="") as file:
        heading, *rows = csv.reader(file)
    assert heading == ["t", "a,b", 'a"b', r"a\nb", "'=cmd", "'+x", "'-x", "'@x", "' x", r"\x1bx", "file"]
    assert rows == [["0.0", *["0.5"] * len(NAMES)], ["1.0", *["-1.5"] * len(NAMES)]] * 2


@pytest.mark.parametrize("suffix", [".npz", ".parquet"])
def test_a_quantity_may_have_any_name(suffix, tmp_path):
    with sample_file(tmp_path / f"x{suffix}", 17) as take:
        take(samples_of(NAMES))
    if suffix == ".npz":
        assert np.load(tmp_path / "x.npz")["file"].tolist() == [0.5, -1.5]


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "holonom", *arguments]
    return subprocess.run(command, capture_output=True, text=True, errors="surrogateescape", check=False)


@pytest.mark.parametrize("text", [STEERING.replace("\r", ""), TURNING, MARKUP.replace("\\", "")])
@pytest.mark.parametrize("command", [("derive",), ("simulate", "--until", "1"), ("check",)])
def test_nothing_that_a_title_says_steers_a_terminal(command, text, tmp_path: Path):
    """Whether such a title is refused or told."""
    file = tmp_path / "scene.mac"
    file.write_text(PARTICLE.replace("Particle", text).replace("particle", text), encoding="utf-8")
    done = run(command[0], str(file), *command[1:])
    assert done.returncode in (0, 2), done.stderr
    assert not UNSEEN.search(done.stdout + done.stderr)


def test_nothing_that_an_error_says_steers_a_terminal(tmp_path: Path):
    file = tmp_path / "scene.mac"
    file.write_text(f'error("{STEERING}{TURNING}")$', encoding="utf-8")
    for options in ((), ("-v",)):
        done = run(*options, "derive", str(file))
        assert done.returncode == 2
        assert not UNSEEN.search(done.stderr)


def test_a_document_on_a_terminal_is_seen(monkeypatch, capsys):
    from holonom.cli.options import json_text, publish
    from holonom.cli.outputs import STANDARD_OUTPUT

    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    publish(json_text({"title": HOSTILE[:-1]}), STANDARD_OUTPUT)
    assert not UNSEEN.search(capsys.readouterr().out)
    monkeypatch.setattr(sys.stdout, "isatty", lambda: False)
    publish(json_text({"title": HOSTILE[:-1]}), STANDARD_OUTPUT)
    assert json.loads(capsys.readouterr().out) == {"title": HOSTILE[:-1]}
