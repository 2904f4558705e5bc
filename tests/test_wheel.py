"""A wheel, installed where no repository is, works; what is not installed is named in one sentence."""

import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest
from refusing import message_of

from holonom import extras
from holonom.failures import ErrorKind

ROOT = Path(__file__).parents[1]
TRAVELS = ("harness", "maxima", "examples", "pyproject.toml", "LICENSE", "README.md")


def run(*command, **options) -> subprocess.CompletedProcess:
    return subprocess.run([str(each) for each in command], capture_output=True, text=True, **options)


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel, built from the files that git knows in a directory of their own."""
    place = tmp_path_factory.mktemp("wheel")
    source = place / "source"
    source.mkdir()
    listed = run("git", "ls-files", "--cached", "--others", "--exclude-standard", *TRAVELS, cwd=ROOT, check=True)
    for name in listed.stdout.splitlines():
        if (ROOT / name).is_file():
            (source / name).parent.mkdir(parents=True, exist_ok=True)
            (source / name).write_bytes((ROOT / name).read_bytes())
    options = ("--no-deps", "--no-build-isolation", "--no-index", "--quiet", "--wheel-dir", place)
    done = run(sys.executable, "-m", "pip", "wheel", *options, source)
    assert done.returncode == 0, done.stderr
    (made,) = place.glob("*.whl")
    return made


def environment(wheel: Path, place: Path, packages: Path | None = None) -> Path:
    """A fresh environment with the wheel in it, and its directory of commands."""
    run(sys.executable, "-m", "venv", "--without-pip", place / "venv", check=True)
    python = place / "venv" / "bin" / "python"
    options = ("--no-deps", "--no-index", "--quiet")
    run(sys.executable, "-m", "pip", "--python", python, "install", *options, wheel, check=True)
    if packages is not None:
        (site,) = (place / "venv").glob("lib/python*/site-packages")
        (site / "borrowed.pth").write_text(f"{packages}\n", encoding="utf-8")  # only a path: no editable installation
    return python.parent


@pytest.fixture(scope="module")
def commands(wheel, tmp_path_factory):
    return environment(wheel, tmp_path_factory.mktemp("fresh"), Path(sysconfig.get_path("purelib")))


@pytest.mark.long
def test_the_wheel_holds_every_file_of_the_package_and_its_data(wheel):
    from zipfile import ZipFile

    contained = set(ZipFile(wheel).namelist())
    listed = run("git", "ls-files", "harness", "maxima", "examples", cwd=ROOT, check=True).stdout.splitlines()
    present = [name for name in listed if (ROOT / name).is_file()]
    places = {"harness": "holonom", "maxima": "holonom/share/maxima", "examples": "holonom/share/examples"}
    missing = [name for name in present if f"{places[name.split('/')[0]]}/{name.split('/', 1)[1]}" not in contained]
    assert missing == []


@pytest.mark.long
@pytest.mark.parametrize(
    ("command", "said"),
    [
        (("derive", "pendulum.mac"), "multipliers"),
        (("check", "pendulum.mac"), "proved"),
        (("series", "pendulum.mac", "--order", "12"), "lambda1"),
        (("simulate", "pendulum.mac", "--until", "1"), "lambda1"),
        (("errata",), "misprint"),
    ],
)
def test_it_works_in_an_empty_directory(commands, tmp_path, command, said):
    shutil.copy(ROOT / "examples" / "pendulum.mac", tmp_path)
    done = run(commands / "holonom", *command, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert said in done.stdout


@pytest.mark.long
def test_what_is_imported_is_the_wheel(commands, tmp_path):
    done = run(commands / "python", "-c", "import holonom; print(holonom.__file__)", cwd=tmp_path, check=True)
    assert str(commands.parent) in done.stdout


@pytest.mark.long
def test_maxima_loads_the_library_of_the_wheel(commands, tmp_path):
    options = {"cwd": tmp_path, "env": os.environ | {"MAXIMA_USERDIR": str(tmp_path / "user")}}
    run(commands / "holonom", "maxima-path", check=True, **options)
    assert str(commands.parent) in (tmp_path / "user" / "holonom.mac").read_text(encoding="utf-8")
    shown = 'load(holonom)$ example(holonomic_scene)$ describe("initial_guess", exact)$'
    done = run("maxima", "--very-quiet", f"--batch-string={shown}", stdin=subprocess.DEVNULL, **options)
    assert "(18)  " in done.stdout
    assert "holonomic_scene: initial_guess" in done.stdout


@pytest.mark.parametrize(
    ("package", "extra", "command"),
    [
        ("heyoka", "motion", ("simulate", "examples/pendulum.mac")),
        ("scipy", "motion", ("simulate", "examples/pendulum.mac", "--engine", "robust")),
        ("numpy", "motion", ("series", "examples/pendulum.mac", "--order", "4")),
        ("pyarrow", "sweep", ("simulate", "examples/pendulum.mac", "-o", "motion.parquet")),
        ("matplotlib", "companion", ("simulate", "examples/pendulum.mac", "--plot", "motion.svg")),
    ],
)
def test_a_missing_package_is_one_sentence_with_the_command_that_installs_it(package, extra, command):
    hidden = f"import sys; sys.modules[{package!r}] = None; from holonom.cli import main; main()"
    done = run(sys.executable, "-c", hidden, *command, cwd=ROOT)
    assert done.returncode == 3
    assert re.search(message_of(ErrorKind.EXTRA_MISSING, package, f"holonom[{extra}]"), done.stderr)
    assert "Traceback" not in done.stderr


def test_all_incomplete_extras_are_named_at_once(monkeypatch):
    absent = {"heyoka", "dask", "build"}  # of motion, of sweep, and for those who develop alone
    monkeypatch.setattr(extras, "version_of", lambda package: None if package in absent else "1")
    assert "holonom[companion,motion,sweep]" in str(extras.missing_package("matplotlib"))


def test_free_motion_is_reported_by_the_core_alone_where_it_broke_off_after_two_lines():
    hidden = "import sys; sys.modules['numpy'] = None; from holonom.cli import main; main()"
    done = run(sys.executable, "-c", hidden, "free", "examples/pendulum.mac", cwd=ROOT)
    assert done.returncode == 0, done.stderr
    assert "u = sqrt(" in done.stdout
