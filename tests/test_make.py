"""What make does: nothing twice, and without root rights what can be done, after one list of all that is missing."""

import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

MAKEFILE = Path(__file__).resolve().parents[1] / "Makefile"
CI = MAKEFILE.parent / ".ci" / "run"
TOOLS = ("sh", "env", "find", "sort", "mkdir", "dirname", "touch", "id", "sed", "expand", "nice", "true")
HOLONOM = """#!/bin/sh
echo "$1" >> calls
while [ $# -gt 0 ]; do
  case $1 in
    --json) mkdir -p "$(dirname "$2")"; : > "$2" ;;
    -o) mkdir -p "$2"; : > "$2/index.html" ;;
  esac
  shift
done
"""
SPHINX = """#!/bin/sh
echo man >> calls; : > build/holonom.1
"""
EVERYTHING = ("maxima", "cc", "bwrap")

pytestmark = pytest.mark.skipif(shutil.which("make") is None, reason="make is not installed")


def program(file: Path, text: str) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)
    file.chmod(0o755)


@pytest.fixture
def make(tmp_path: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Run make in a house of empty rooms, with no programs but these."""
    programs, house = tmp_path / "programs", tmp_path / "house"
    house.mkdir()
    shutil.copy(MAKEFILE, house)
    rooms = ("examples/one.mac", "examples/paper/paper.mac", "examples/paper/printed.mac", "examples/paper/by_hand.mac")
    rooms = (*rooms, "examples/hard/case.mac")
    for name in (*rooms, "maxima/holonom.mac", "harness/scene.py", "pyproject.toml", "constraints.txt"):
        (house / name).parent.mkdir(parents=True, exist_ok=True)
        (house / name).touch()
    program(house / ".venv/bin/holonom", HOLONOM)
    program(house / ".venv/bin/sphinx-build", SPHINX)
    (house / ".venv/installed").touch()
    program(programs / "python3.11", "#!/bin/sh\n")
    for name in TOOLS:
        (programs / name).symlink_to(shutil.which(name))

    def run(*targets: str, present: tuple[str, ...] = EVERYTHING, **stubs: str) -> subprocess.CompletedProcess[str]:
        for name in present:
            program(programs / name, "#!/bin/sh\n")
        for name, text in stubs.items():
            (programs / name).unlink(missing_ok=True)
            program(programs / name, f"#!/bin/sh\n{text}\n")
        return subprocess.run(
            [shutil.which("make"), *targets],
            cwd=house,
            env=os.environ | {"PATH": str(programs), "MAKEFLAGS": ""},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            check=False,
        )

    run.house = house
    return run


def calls(make: Callable) -> list[str]:
    """What has been made since the last time."""
    log = make.house / "calls"
    made = sorted(log.read_text().split()) if log.exists() else []
    log.unlink(missing_ok=True)
    return made


def test_a_second_make_makes_nothing(make):
    assert make().returncode == 0
    assert calls(make) == ["check", "companion", "derive", "derive", "errata", "man"]
    done = make()
    assert (done.returncode, calls(make)) == (0, [])
    assert "build/site/index.html" in done.stdout


@pytest.mark.parametrize(
    ("changed", "made"),
    [
        ("examples/one.mac", ["check", "companion", "derive", "errata", "man"]),
        ("examples/hard/case.mac", ["companion", "man"]),
        ("examples/paper/printed.mac", ["companion", "errata", "man"]),
        ("maxima/holonom.mac", ["check", "companion", "derive", "derive", "errata", "man"]),
    ],
)
def test_what_a_change_touches_is_made_again(make, changed, made):
    make()
    calls(make)
    newer = (make.house / "build/check.json").stat().st_mtime + 5
    os.utime(make.house / changed, (newer, newer))
    assert make().returncode == 0
    assert calls(make) == made


def test_a_check_that_fails_is_made_again(make):
    program(make.house / ".venv/bin/holonom", HOLONOM + 'case "$(tail -n 1 calls)" in check) exit 1 ;; esac\n')
    assert make(tail="echo check").returncode == 2
    assert not (make.house / "build/check.json").exists()


def test_without_root_rights_all_that_is_missing_is_reported_at_once_and_make_goes_on(make):
    (make.house / "calls").touch()
    done = make("setup", present=("cc",), id="echo 1000")
    assert done.returncode == 0
    assert done.stderr.count("Missing here") == 1
    assert "apt-get update && apt-get install maxima bubblewrap\n" in done.stderr


def test_with_root_rights_what_is_missing_is_installed_and_nothing_else(make):
    install = 'echo "$@" >> asked'
    done = make("setup", present=("maxima", "cc"), id="echo 0", **{"apt-get": install})
    assert (done.returncode, done.stderr) == (0, "")
    assert (make.house / "asked").read_text() == "update -qq\ninstall -qq bubblewrap\n"


def test_a_package_that_cannot_be_installed_is_reported(make):
    done = make("setup", present=("maxima", "cc"), id="echo 0", **{"apt-get": "exit 100"})
    assert done.returncode == 0
    assert "apt-get install bubblewrap" in done.stderr


def test_no_python_that_is_new_enough_is_one_sentence(make):
    """There is nothing to continue with."""
    newer = (make.house / "pyproject.toml").stat().st_mtime + 5
    os.utime(make.house / "pyproject.toml", (newer, newer))
    refusing = "exit 1"
    done = make("setup", id="echo 1000", python3=refusing, **{"python3.11": refusing})
    assert done.returncode == 2
    assert "Holonom needs Python 3.11 or later: please install it." in done.stderr
    assert "apt-get install python3-venv" in done.stderr


@pytest.mark.parametrize(
    ("check", "check_long", "at_hand", "status", "told"),
    [
        ("exit 0", "exit 0", "3600", 0, ""),
        ("exit 2", "echo must not run >&2", "3600", 2, ""),
        ("exit 0", "exit 2", "3600", 2, ""),
        ("exit 0", "sleep 60", "2", 0, "no time left"),
        ("exit 0", "echo must not run >&2", "0", 0, "no time left"),
    ],
)
def test_ci_runs_the_long_tests_only_while_there_is_time(check, check_long, at_hand, status, told, tmp_path):
    for name in ("chromium", "chromedriver", "pdflatex", "maxima-sage"):
        program(tmp_path / name, "#!/bin/sh\n")
    program(tmp_path / "make", f"#!/bin/sh\ncase $1 in check) {check} ;; check-long) {check_long} ;; esac\n")
    environment = os.environ | {"PATH": f"{tmp_path}:{os.environ['PATH']}", "SECONDS_AT_HAND": at_hand}
    done = subprocess.run([CI], env=environment, capture_output=True, text=True, check=False, timeout=100)
    assert done.returncode == status, done.stderr
    assert told in done.stderr
    assert bool(told) == bool(done.stderr)
