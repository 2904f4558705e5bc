"""Maxima finds the library in its user directory, from anywhere, and what lies there already is safe."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from refusing import message_of

from holonom.failures import ErrorKind
from holonom.installation import put_into_maxima
from holonom.reference.entries import function_texts, step_texts
from holonom.reference.maxima_help import help_files

ROOT = Path(__file__).parents[1]
README_SCENE, *_ = re.findall(r"^```maxima\n(.*?)^```$", (ROOT / "README.md").read_text(encoding="utf-8"), re.M | re.S)


def run(*command: object, user_directory: Path, **options) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"MAXIMA_USERDIR": str(user_directory)}
    return subprocess.run(
        list(map(str, command)), env=environment, capture_output=True, text=True, timeout=120, **options
    )


def holonom_maxima_path(user_directory: Path) -> subprocess.CompletedProcess[str]:
    return run(sys.executable, "-m", "holonom", "maxima-path", user_directory=user_directory)


@pytest.fixture(scope="module")
def user_directory(tmp_path_factory) -> Path:
    """Maxima's, with Holonom in it, in a place whose name is hard to write."""
    directory = tmp_path_factory.mktemp("user") / 'a "quoted" place' / ".maxima"
    done = holonom_maxima_path(directory)
    assert (done.returncode, done.stderr) == (0, "")
    assert str(directory / "holonom.mac") in done.stdout
    return directory


@pytest.fixture
def batch(user_directory, tmp_path):
    """What bare Maxima prints while it runs a file in a directory of no account."""

    def batch(text: str, answers: str = "") -> str:
        (tmp_path / "session.mac").write_text(text, encoding="utf-8")
        command = ("maxima", "-b", "session.mac")
        return run(*command, user_directory=user_directory, cwd=tmp_path, input=answers).stdout

    return batch


@pytest.mark.parametrize("loading", ["load(holonom)$", 'load("holonom")$', 'load("holonom.mac")$'])
def test_the_scene_of_the_readme_runs_in_bare_maxima(batch, loading):
    scene = README_SCENE.replace('load("holonom.mac")$', loading)
    assert loading in scene
    printed = batch(f"{scene}\nprint_derivation(system, swing)$\n")
    assert "(18)  " in printed
    assert "error" not in printed


@pytest.mark.parametrize("topic", [*(f.name for f in function_texts()), "kinetic_energy", "initial_guess"])
def test_maxima_describes(batch, topic):
    printed = " ".join(batch(f"load(holonom)$\n? {topic}\n").split())
    summaries = {each.name: each.summary for each in function_texts()}
    texts = {entry.name: entry.text for function in function_texts() for entry in function.entries}
    assert (summaries | texts)[topic] in printed


def test_examples_run_and_maximas_own_still_do(batch):
    printed = batch('load(holonom)$\nload(holonom)$\nexample(holonomic_system)$\nexample("holonomic_scene")$\n')
    assert printed.count("(10)  ") == 3  # of both systems, and under the law of the scene
    assert printed.count("(18)  ") == 1
    assert "error" not in printed
    assert "x = 0.8296749902129361" in batch("load(holonom)$\nexample(allroots)$\n")
    assert "not found" in batch("load(holonom)$\nexample(no_such_topic)$\n")


@pytest.mark.parametrize("step", step_texts(), ids=lambda step: step.name)
def test_the_example_of_a_step_is_found(step):
    assert f"\n&& {step.name}\n" in help_files()["examples.demo"]


def test_steps_are_described_and_their_examples_run(batch):
    names = [step.name for step in step_texts()]
    printed = batch("load(holonom)$\n" + "".join(f"example({name})$\n" for name in names) + "? mass_matrix\n")
    assert "error" not in printed
    assert "Function: mass_matrix(T, v)" in printed


def test_the_demonstration_waits_as_maximas_own_do_and_runs_to_its_end(batch):
    printed = batch("load(holonom)$\ndemo(holonom)$\n", answers=";\n" * 60)
    waiting = "type ';' and <enter> to proceed with the demonstration"
    assert waiting in printed
    assert waiting in batch("demo(cf)$\n", answers=";\n" * 40)
    assert "error" not in printed
    assert "dot(q3)_0 = " in printed


@pytest.mark.parametrize("name", ["holonom.mac", "holonom/holonom.info"])
def test_a_file_of_somebody_elses_is_not_replaced(tmp_path, name):
    foreign = tmp_path / name
    foreign.parent.mkdir(exist_ok=True)
    foreign.write_text("/* mine */\n", encoding="utf-8")
    before = sorted(tmp_path.rglob("*"))
    done = holonom_maxima_path(tmp_path)
    assert done.returncode == 2
    assert re.search(message_of(ErrorKind.UNRELATED_IN_MAXIMA, str(foreign)), done.stderr)
    assert foreign.read_text(encoding="utf-8") == "/* mine */\n"
    assert sorted(tmp_path.rglob("*")) == before


def test_it_is_put_there_anew_beside_other_files(tmp_path):
    (tmp_path / "maxima-init.mac").write_text("mine : 1$\n", encoding="utf-8")
    stub = put_into_maxima(tmp_path)
    whole = stub.read_text(encoding="utf-8")
    stub.write_text(whole.splitlines()[0] + '\nload("/where/the/library/was/holonom.mac")$\n', encoding="utf-8")
    assert put_into_maxima(tmp_path) == stub
    assert stub.read_text(encoding="utf-8") == whole
    assert (tmp_path / "maxima-init.mac").read_text(encoding="utf-8") == "mine : 1$\n"


def test_make_install_does_it(tmp_path):
    make = ("make", "-o", "setup", "install", f"BIN={Path(sys.executable).parent}")
    done = run(*make, user_directory=tmp_path, cwd=ROOT)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "holonom.mac").exists()


# The sign of k, and whether n is -1, are what integrate and desolve ask about.
SIGN = "parameters=[k], potential_energy=k*x^2/2, constraints=[y-u*x]"
POWER = "parameters=[n], forces=[0,(1+t)^n], constraints=[y-u]"


@pytest.mark.parametrize("entries", [SIGN, POWER], ids=["sign", "power"])
def test_no_question_is_asked_in_a_batch_run(batch, entries):
    printed = batch(f"""
load(holonom)$
system : holonomic_system(coordinates=[x,y], controls=[u], kinetic_energy=(dot(x)^2+dot(y)^2)/2, {entries})$
s : holonomic_scene(system, control_law=[u=1+t], initial_state=[x=1,dot(x)=0])$
print_derivation(system, s)$
write_free_motion("free.json", 's, false)$
print("the end")$
""")
    assert "the end " in printed.splitlines()
    assert not re.search(r"\?\s*$", printed, re.MULTILINE)
    assert "error" not in printed


def test_a_scene_under_prescribed_reactions_is_printed_with_the_accelerations_of_its_controls(batch):
    printed = batch("""
load(holonom)$
system : holonomic_system(coordinates=[x,y], controls=[u], kinetic_energy=(dot(x)^2+dot(y)^2)/2, constraints=[y-u])$
pulled : holonomic_scene(system, prescribed_reactions=[lambda1=3], initial_state=[x=1,dot(x)=0,y=0,dot(y)=0])$
print_derivation(system, pulled)$
""")
    assert {"ddot(y) = 3", "ddot(u) = 3"} <= {line.strip() for line in printed.splitlines()}
    assert "(18)  " not in printed


def test_the_size_of_a_correction_is_printed(batch):
    """y = 0.942809041582063365867792482806 is read as a double, 2.4e-17 off the circle."""
    printed = batch("""
load(holonom)$
system : holonomic_system(coordinates=[x,y], kinetic_energy=(dot(x)^2+dot(y)^2)/2, constraints=[x^2+y^2-1])$
rounded : holonomic_scene(system, initial_state=[x=1/3,y=0.942809041582063365867792482806,dot(x)=0,dot(y)=0])$
print_derivation(system, rounded)$
""")
    (size,) = re.findall(r"\by_0 .*?\b(\d\.\d+e-\d+)", " ".join(printed.split()))
    assert float(size) == pytest.approx(2.4e-17, rel=0.1)
