"""The fault table: every fault is one sentence, and nothing is left of it."""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from confinement import without_notice
from particle import PARTICLE
from table import TABLE, Fault

SENTENCE = re.compile(r"^holonom: error: .+\S$", re.MULTILINE)


def rows() -> list:
    return [pytest.param(row, id=row.name[:60], marks=[pytest.mark.long] if row.long else []) for row in TABLE]


@pytest.mark.parametrize("fault", rows())
def test_a_fault_is_one_sentence(fault: Fault, tmp_path: Path, holonom_here, monkeypatch):
    here, temporary = tmp_path / "here", tmp_path / "temporary"
    here.mkdir()
    temporary.mkdir()
    (here / "scene.mac").write_text(PARTICLE, encoding="utf-8")
    if fault.prepare:
        fault.prepare(here)
    before = contents(here)
    if fault.environment or fault.shell or "--time-limit" in fault.command:  # nothing limits the time of this process
        done = run(fault, here, environment(fault, here, temporary))
    else:
        monkeypatch.chdir(here)
        monkeypatch.setattr(tempfile, "tempdir", str(temporary))
        done = holonom_here(*fault.command.split(" "))
    assert "Traceback" not in done.stderr
    assert done.returncode == fault.status, done.stderr
    assert re.search(fault.says, done.stderr)
    if fault.status in (2, 3):
        assert len(SENTENCE.findall(done.stderr)) == 1, done.stderr
        assert contents(here) == before
    assert list(temporary.iterdir()) == []


def test_the_table_has_a_hundred_rows_and_no_row_twice():
    assert len({row.name for row in TABLE}) == len(TABLE) >= 100


def run(fault: Fault, here: Path, environment: dict[str, str]) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "holonom", *fault.command.split(" ")]
    if fault.shell:
        command = ["/bin/bash", "-c", fault.shell, "bash", *command]
    done = subprocess.run(
        command, cwd=here, env=environment, capture_output=True, text=True, errors="replace", timeout=100, check=False
    )
    done.stderr = without_notice(done.stderr)
    return done


def environment(fault: Fault, here: Path, temporary: Path) -> dict[str, str]:
    changed = {name: text.replace("{here}", str(here)) for name, text in fault.environment.items()}
    return os.environ | {"TMPDIR": str(temporary)} | changed


def contents(directory: Path) -> dict[str, bytes | None]:
    """The regular files of a directory and what they hold."""
    return {
        str(path.relative_to(directory)): path.read_bytes() if path.is_file() else None
        for path in sorted(directory.rglob("*"))
    }
