"""The LaTeX document holds every equation under its number, and a plain TeX Live compiles it."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from confinement import without_notice
from refusing import message_of

from holonom.failures import ErrorKind
from holonom.record import derived_record, read_record
from holonom.typeset.document import tex_document

EXAMPLES = Path(__file__).parents[2] / "examples"
HARD_TO_TYPESET = r"""
load("holonom.mac")$
system : holonomic_system(
  title = "100 % of $x_1$ & {θ} #1 ~ ^ \\ → naïve <a_b>",
  coordinates      = [θ, x_l, mass2, %a_b],
  controls         = [u],
  parameters       = [ell, k_spring],
  kinetic_energy   = (dot(θ)^2 + dot(x_l)^2 + dot(mass2)^2 + cos(θ)*dot(%a_b)^2)/2,
  potential_energy = [my_spring = k_spring*x_l^2/2],
  constraints      = [x_l^2 + mass2^2 - u^2*ell])$
"""
needs_tex = pytest.mark.skipif(not shutil.which("pdflatex"), reason="pdflatex is not installed")


def document(scene: Path) -> str:
    return tex_document(derived_record(scene))


def complaints(text: str, directory: Path) -> list[str]:
    """What pdflatex finds wrong: errors, characters that are missing, boxes wider or higher than the page."""
    (directory / "derivation.tex").write_text(text, encoding="utf-8")
    command = ["pdflatex", "-interaction=nonstopmode", "-no-shell-escape", "derivation.tex"]
    done = subprocess.run(command, cwd=directory, capture_output=True, timeout=120)
    log = (directory / "derivation.log").read_text(encoding="latin-1")
    found = re.findall(r"^(?:! |Overfull|Missing character).*", log, re.MULTILINE)
    return found or [f"pdflatex left with {done.returncode}"] * bool(done.returncode)


@needs_tex
@pytest.mark.parametrize(
    "example",
    [
        "paper/paper.mac",
        "andrews.mac",
        *(pytest.param(name, marks=pytest.mark.long) for name in ("spherical_pendulum.mac", "linkage.mac")),
    ],
)
def test_tex_compiles_every_kind_of_example_without_complaint(example, tmp_path):
    assert complaints(document(EXAMPLES / example), tmp_path) == []


@needs_tex
def test_tex_compiles_titles_and_names_in_any_writing(write_scene, tmp_path):
    assert complaints(document(write_scene(HARD_TO_TYPESET)), tmp_path) == []


def test_every_equation_stands_under_its_number(particle_record):
    record = read_record(particle_record)
    text = tex_document(record)
    equations = [equation for part in (*record.derivations, *record.scenes) for equation in part.equations]
    headings = [f"\\paragraph{{({equation.number}) {equation.name}}}" for equation in equations]
    assert [line for line in text.splitlines() if line.startswith("\\paragraph")] == headings
    tagged = {equation.number for equation in equations if equation.relations}
    assert set(re.findall(r"\\tag\{(\w+)\}", text)) == tagged


def test_the_mass_matrix_is_a_matrix(particle_record):
    assert r"A &= \begin{pmatrix} m & 0 \\ 0 & m \end{pmatrix} \tag{3a}" in tex_document(read_record(particle_record))


def test_derive_writes_the_document(particle_scene, tmp_path):
    file = tmp_path / "particle.tex"
    command = [sys.executable, "-m", "holonom", "derive", str(particle_scene), "--tex", str(file)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert (done.returncode, without_notice(done.stderr)) == (0, "")
    assert file.read_text(encoding="utf-8") == document(particle_scene)
    assert "Lagrange's equations" in done.stdout


def test_derive_says_where_the_document_cannot_be_written(particle_scene, tmp_path):
    file = tmp_path / "no such directory" / "particle.tex"
    command = [sys.executable, "-m", "holonom", "derive", str(particle_scene), "--tex", str(file)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout) == (2, "")
    assert re.search(message_of(ErrorKind.UNWRITABLE, str(file)), done.stderr)


def test_a_mass_matrix_without_its_zeros_is_no_smaller_matrix(particle_scene):
    text = tex_document(derived_record(particle_scene, {"closed_form_size": "1"}))
    assert "m & 0" not in text
    assert "\\text{and zero for all other indices}" in text
