"""Each benchmark runs: at its smallest sizes, and whatever it measures."""

import subprocess
import sys
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).with_name("benchmarks")
SMALL = {
    "run": "b.LINKS, b.POINTS, b.SECONDS = (16, 64), 10, 2.0",
    "size": "b.LINKS, b.FROM, b.TO, b.SECONDS = (4, 8), 4, 8, {8: 5.0}",
    "ring": "b.BODIES = 3, 4",
    "tree": "b.BODIES = 3, 7",
    "commands": "b.DERIVED, b.LOOPS, b.UNTIL, b.POINTS = {'chain': (2, 3)}, 2, 1, (10, 20)",
    "series": "b.ORDERS = 2, 4",
    "simulation": "b.MOTIONS, b.PLACES = b.MOTIONS[:1], 1",
    "sweep": "b.MOTIONS, b.REPEATS, b.TURNS, b.FIRST = 160, 1, 1, 1",
    "sensitivities": "b.COUNTS, b.TURNS = (1,), 1",
}
OF_BENCH = {"run": "symengine", "series": "jax"}  # packages that the tests do not install


@pytest.mark.long
@pytest.mark.parametrize("name", SMALL)
def test_a_benchmark_writes_its_table(tmp_path, name):
    pytest.importorskip(OF_BENCH.get(name, "numpy"))
    share = ", 1e-4" if name == "sweep" else ""
    code = f"from pathlib import Path\nimport {name} as b\n{SMALL[name]}\nb.main(Path({str(tmp_path)!r}){share})"
    subprocess.run([sys.executable, "-c", code], cwd=BENCHMARKS, check=True, stdout=subprocess.DEVNULL)
    assert [file for file in tmp_path.glob("*.txt") if file.read_text(encoding="utf-8").strip()]
