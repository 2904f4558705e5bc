"""The notebooks run, and show what they showed."""

import re
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

BEGINNING = re.compile(r"\D{0,20}")
NOTEBOOKS = sorted((Path(__file__).parents[2] / "examples" / "notebooks").glob("*.ipynb"))


def shown(notebook: nbformat.NotebookNode) -> list[list[str]]:
    """What kinds of output each cell has, in which forms, and how its text begins, to the first digit."""
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    return [
        [f"{sorted(output.get('data', [output.output_type]))} {begun(output)}" for output in cell.outputs]
        for cell in cells
    ]


def begun(output: nbformat.NotebookNode) -> str:
    return BEGINNING.match(output.get("data", {}).get("text/plain", ""))[0]


def test_there_are_five():
    assert [file.stem for file in NOTEBOOKS] == ["fit", "jax", "numbers_and_code", "own_system", "paper"]


@pytest.mark.parametrize(
    "file",
    [pytest.param(each, marks=[] if each.stem == "paper" else [pytest.mark.long]) for each in NOTEBOOKS],
    ids=lambda file: file.stem,
)
def test_a_notebook_runs_and_shows_what_it_showed(file, monkeypatch):
    monkeypatch.setenv("MOTIONS", "400")  # of the notebook about JAX
    stored = nbformat.read(file, as_version=4)
    ran = nbformat.read(file, as_version=4)
    NotebookClient(
        ran, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(file.parent)}}
    ).execute()
    assert all(cell.execution_count for cell in stored.cells if cell.cell_type == "code")
    assert shown(ran) == shown(stored)
