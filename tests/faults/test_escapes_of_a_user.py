"""The attacks of `test_escapes` once more, as a user without privileges if root runs the tests."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

USER = 54321
AS_USER = ["setpriv", f"--reuid={USER}", f"--regid={USER}", "--clear-groups", sys.executable]
# The interpreter, also from a process that the user starts, which has no privileges of root left.
REACHED = "import subprocess, sys, holonom.scene, pytest; subprocess.run([sys.executable, '-c', ''], check=True)"
ATTACKS = Path(__file__).with_name("test_escapes.py")


@pytest.fixture
def home() -> Iterator[Path]:
    """A home of the user, where another user can reach it."""
    with tempfile.TemporaryDirectory() as folder:
        yield Path(folder)


@pytest.mark.long
@pytest.mark.skipif(os.geteuid() != 0, reason="this user has no privileges")
def test_attacks_reach_nothing_of_an_ordinary_user(home):
    os.chown(home, USER, USER)
    environment = {"PATH": os.environ["PATH"], "HOME": str(home), "LANG": "C.UTF-8", "PYTHONDONTWRITEBYTECODE": "1"}
    tried = subprocess.run([*AS_USER, "-c", REACHED], env=environment, capture_output=True, check=False)
    if tried.returncode != 0:
        pytest.skip("the interpreter is out of the reach of other users")
    command = [*AS_USER, "-m", "pytest", "-q", "-n", "0", "-p", "no:cacheprovider", f"--basetemp={home}/tests", ATTACKS]
    done = subprocess.run(command, env=environment, cwd=ATTACKS.parents[2], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-3000:]
