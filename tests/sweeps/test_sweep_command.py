"""The command sweep: its folder, what it refuses, and how it continues."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pyarrow.dataset
import pytest
from click.testing import CliRunner
from confinement import without_notice
from refusing import message_of

import holonom
import holonom.cli
from holonom.failures import ErrorKind
from holonom.program.request import Request
from holonom.sandbox import Limits
from holonom.sweeps import run
from holonom.sweeps.axes import read_axes
from holonom.sweeps.outputs import read_quantities
from holonom.sweeps.request import SweepRequest

EXAMPLES = Path(__file__).parents[2] / "examples"
CRANE = EXAMPLES / "crane.mac"
ASKED = (CRANE, "--grid", "m=50:500:6", "--list", "c=0,10,40", "--keep", "final,max(abs(lambda1))", "--chunk", "5")


class Done(NamedTuple):
    """How a command ended."""

    returncode: int
    stderr: str


def sweep(*arguments: str | Path, text: str | None = None) -> Done:
    """The command, in this process, with a text on standard input."""
    command = ["sweep", *map(str, arguments), "--workers", "1"]
    done = CliRunner(mix_stderr=False).invoke(holonom.cli.holonom, command, input=text, standalone_mode=False)
    assert done.exception is None
    return Done(done.return_value, without_notice(done.stderr))


def rows(folder: Path):
    return pyarrow.dataset.dataset(folder, format="parquet").to_table().sort_by("row")


@pytest.fixture(scope="module")
def swept(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("sweep")
    done = sweep(*ASKED, "-o", folder / "runs", "--plot", folder / "map.png", "--json", folder / "runs.json")
    assert (done.returncode, done.stderr) == (0, "")
    return folder


def test_the_folder_holds_a_part_a_chunk_and_says_of_what(swept):
    assert sorted(path.name for path in (swept / "runs").glob("part*")) == [f"part-000000{k}.parquet" for k in range(4)]
    document = json.loads((swept / "runs" / "_sweep.json").read_text())
    assert document["scene"]["text"] == CRANE.read_text()
    assert (document["rows"], document["seed"]) == (18, None)
    assert json.loads((swept / "runs.json").read_text()) == {**document, "statuses": {"ok": 18}}
    table = rows(swept / "runs")
    assert table.column_names == document["columns"]
    assert table["row"].to_pylist() == list(range(18))
    assert (swept / "map.png").read_bytes().startswith(b"\x89PNG")


def test_the_same_command_computes_the_missing_parts_alone(swept):
    first, second = swept / "runs" / "part-0000000.parquet", swept / "runs" / "part-0000002.parquet"
    whole, stamp = rows(swept / "runs"), first.stat().st_mtime_ns
    second.write_bytes(second.read_bytes()[:100])
    (swept / "runs" / ".holonom-0123456789abcdef.new").write_bytes(b"half")
    assert sweep(*ASKED, "-o", swept / "runs", "--resume").returncode == 0
    assert rows(swept / "runs").equals(whole)
    assert first.stat().st_mtime_ns == stamp
    assert not list((swept / "runs").glob(".holonom-*"))


def flip(folder: Path) -> None:
    """One bit of a number, so that the file still reads."""
    file = folder / "part-0000001.parquet"
    content = bytearray(file.read_bytes())
    content[len(content) // 3] ^= 1
    file.write_bytes(content)


def copy_over(folder: Path) -> None:
    shutil.copy(folder / "part-0000001.parquet", folder / "part-0000002.parquet")


def put_a_link(folder: Path) -> None:
    (folder / "part-0000003.parquet").unlink()
    (folder / "part-0000003.parquet").symlink_to(folder / "part-0000000.parquet")


def cut_manifest(folder: Path) -> None:
    """In the middle of the last line, as a kill may leave it."""
    manifest = folder / "_parts.jsonl"
    lines = manifest.read_text().splitlines()
    last = next(line for line in lines if "part-0000003" in line)
    manifest.write_text("\n".join([*(line for line in lines if line != last), last[:-20]]))


def exchange_lines(folder: Path) -> None:
    manifest = folder / "_parts.jsonl"
    text = manifest.read_text().replace("part-0000000", "part-x").replace("part-0000001", "part-0000000")
    manifest.write_text(text.replace("part-x", "part-0000001"))


@pytest.mark.parametrize(
    ("tamper", "parts"),
    [
        (flip, [1]),
        (copy_over, [2]),
        (put_a_link, [3]),
        (cut_manifest, [3]),
        (exchange_lines, [0, 1]),
        (lambda folder: (folder / "_parts.jsonl").unlink(), [0, 1, 2, 3]),
        (lambda folder: (folder / "_parts.jsonl").write_bytes(b"\xff\n[]\n{}\n3\n"), [0, 1, 2, 3]),
    ],
)
def test_parts_that_are_not_as_they_were_written_are_computed_again_and_reported(swept, tmp_path, tamper, parts):
    whole, folder = rows(swept / "runs"), tmp_path / "runs"
    shutil.copytree(swept / "runs", folder)
    tamper(folder)
    done = sweep(*ASKED, "-o", folder)
    assert done.returncode == 0
    assert re.findall(r"part-\d{6}(\d)\.parquet", done.stderr) == [str(part) for part in parts]
    assert rows(folder).equals(whole)
    assert not (folder / "part-0000003.parquet").is_symlink()
    assert sweep(*ASKED, "-o", folder) == (0, "")


def test_a_sweep_of_standard_input_named_a_temporary_file(swept):
    done = sweep("-", *ASKED[1:], "-o", swept / "runs", "--json", swept / "again.json", text=CRANE.read_text())
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads((swept / "again.json").read_text())["scene"]["file"] == "-"


@pytest.mark.parametrize(
    ("change", "part"),
    [
        (("--grid", "m=50:500:7"), "parameters"),
        pytest.param(("--tol", "1e-10"), "options", marks=pytest.mark.long),
        pytest.param(("--chunk", "6"), "chunk", marks=pytest.mark.long),
        (("--set", "M=300"), "scene"),
    ],
)
def test_another_sweep_in_the_same_folder_is_refused(swept, change, part):
    arguments = list(ASKED)
    if change[0] in arguments:
        place = arguments.index(change[0])
        arguments[place : place + 2] = change
    else:
        arguments += change
    refused = sweep(*arguments, "-o", swept / "runs")
    assert refused.returncode == 2
    assert re.search(message_of(ErrorKind.OTHER_SWEEP, part), refused.stderr)
    assert refused.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--keep", "final"), message_of(ErrorKind.NOTHING_VARIES)),
        (("--grid", "m=1:2"), message_of(ErrorKind.MALFORMED_AXIS)),
        (("--grid", "m=1:2:3", "--keep", "x.y"), message_of(ErrorKind.NOT_AN_OUTPUT, "x.y")),
        (("--grid", "m=1:2:3", "--tol", "7"), message_of(ErrorKind.TOLERANCE_OUT_OF_RANGE)),
        (
            ("--grid", "m=1:2:3", "--grid", "c=1:2:3", "--grid", "g=1:2:3", "--plot", "p.svg"),
            message_of(ErrorKind.NOT_PLOTTED),
        ),
        (("--grid", "m=1:2:3", "--resume"), message_of(ErrorKind.NOTHING_TO_RESUME)),
        (("--grid", "nothing=1:2:3"), message_of(ErrorKind.NOT_SETTABLE, "nothing")),
        (("--grid", "m=1:2:3", "--set", "m=2"), message_of(ErrorKind.NOT_AN_AXIS, "m")),
        (("--grid", "m=1:2:3", "--keep", "lambda7"), message_of(ErrorKind.NOT_AN_OUTPUT, "lambda7")),
        *(
            (("--grid", "m=1:2:3", "--dask", address), message_of(ErrorKind.NOT_A_SCHEDULER))
            for address in ("", "nowhere", "file:///etc/passwd", "tcp://a b:1", "inproc://x", "127.0.0.1:99999")
        ),
    ],
)
def test_bad_options_are_reported_in_one_sentence(tmp_path, monkeypatch, options, told):
    monkeypatch.chdir(tmp_path)
    refused = sweep(CRANE, *options, "-o", tmp_path / "runs")
    assert refused.returncode == 2
    assert re.search(told, refused.stderr)
    assert refused.stderr.count("\n") == 1
    assert not (tmp_path / "runs").exists()


def test_a_folder_with_other_things_is_left_alone(tmp_path):
    (tmp_path / "thesis.tex").write_text("dear")
    refused = sweep(CRANE, "--grid", "m=1:2:3", "-o", tmp_path)
    assert (refused.returncode, [path.name for path in tmp_path.iterdir()]) == (2, ["thesis.tex"])


FULL = """
import resource, sys
import holonom.sweeps.run as run
from holonom.cli.group import run as command
compute = run.compute
def into_small_files(*arguments):
    resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, 50_000))
    compute(*arguments)
run.compute = into_small_files
sys.argv[1:] = ["sweep", sys.argv[1], "--grid", "m=50:500:2000", "-o", sys.argv[2], "--workers", "1"]
sys.exit(command())
"""


def test_a_full_disk_is_one_sentence_and_no_truncated_part(tmp_path):
    command = [sys.executable, "-c", FULL, str(CRANE), str(tmp_path / "runs")]
    refused = subprocess.run(command, capture_output=True, text=True, timeout=200)
    assert (refused.returncode, without_notice(refused.stderr).count("\n")) == (3, 1)
    assert "part-0000000.parquet: " in refused.stderr
    assert sorted(path.name for path in (tmp_path / "runs").iterdir()) == ["_sweep.json", "_sweep.lock"]


def test_python_gets_a_lazy_dataset_and_leaves_nothing(tmp_path):
    swept = holonom.sweep(holonom.load(CRANE), grid={"m": (50, 500, 6)}, values={"c": [0, 10, 40]}, keep="final,x")
    assert swept.dataset.count_rows() == 18
    frame = swept.to_pandas()
    assert frame.loc[4, "c"] == 10
    assert (frame["status"] == "ok").all()
    assert swept.plot("x")._repr_svg_().startswith("<?xml")
    folder = swept.path
    del swept
    assert not os.path.exists(folder)


def test_a_sweep_started_a_worker_for_each_core_of_the_machine(monkeypatch, tmp_path):
    """Truth: one for each that the process may use."""
    started = []
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 3, 5}, raising=False)
    monkeypatch.setattr(run, "compute", lambda plan, chunks, take, workers, scheduler: started.append(workers))
    wanted = SweepRequest(read_axes(["m=50:500:2"], [], [], None, None), read_quantities(["x"]))
    run.run_sweep(CRANE, Request(None), wanted, tmp_path / "runs", Limits())
    assert started == [3]
