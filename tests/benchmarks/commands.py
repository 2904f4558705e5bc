"""`make bench`: whole commands against each other, and against bars, one table.

    python tests/benchmarks/commands.py build/benchmarks

Processor time of a command and of all that it starts. `derive` stands beside `program` in the same run, for systems
too large for closed forms; the linkage of 40 loops goes through 20 singular configurations, and its end is held against
elliptic functions; laws given by tables tell how the time grows with their points.
"""

import json
import sys
from itertools import pairwise
from math import log, sin
from pathlib import Path
from tempfile import TemporaryDirectory

from timing import cost_of_command, program_of_command, write_report

sys.path.append(str(Path(__file__).parents[1] / "simulation"))

from truths import linkage_tip

EXAMPLES = Path(__file__).parents[2] / "examples"
DERIVED = {"chain": (16, 32, 64, 128), "ring": (4, 8, 16)}
LOOPS, UNTIL = 40, 20
POINTS = (1000, 3000, 10000, 30000)
DERIVATION, LINKAGE, GROWTH = 2.0, 9.0, 1.1  # bars: derive to program; seconds; exponent
TABLE = """
load("holonom.mac")$
winch : holonomic_system(coordinates = [x, y], controls = [u], kinetic_energy = (dot(x)^2 + dot(y)^2)/2,
  potential_energy = 981/100*y, constraints = [x^2 + y^2 - u^2])$
recorded : holonomic_scene(winch, control_law = [u = table("points.csv", clamped)],
  initial_state = [x = 1/5, dot(x) = 0], initial_guess = [y = -2], time_span = [0, 4])$
"""


def derivations() -> list[str]:
    """Of each system the time to derive it, to that of writing its program."""
    lines, ratios = ["system  size  program s  derive to program"], []
    for system, sizes in DERIVED.items():
        file = EXAMPLES / f"{system}.mac"
        for size in sizes:
            seconds = program_of_command(file, f"N={size}")[1]
            ratios.append(cost_of_command("derive", str(file), "--set", f"N={size}")[0] / seconds)
            lines.append(f"{system:<6}  {size:<4}  {seconds:<9.2f}  {ratios[-1]:.2f}")
    return [*lines, bar("derive to program, at most", max(ratios), DERIVATION)]


def linkage() -> list[str]:
    """The motion through its singular configurations, by the whole command."""
    with TemporaryDirectory() as directory:
        written = Path(directory, "motion.json")
        options = ("--set", f"N={LOOPS}", "--until", str(UNTIL), "--final", "--json", str(written))
        seconds = cost_of_command("simulate", str(EXAMPLES / "linkage.mac"), *options)[0]
        found = json.loads(written.read_text(encoding="utf-8"))["coordinates"]
    error = max(
        abs(float(found[name]) - true) for name, true in zip(("x0", "y0"), linkage_tip(LOOPS, UNTIL), strict=True)
    )
    said = f"linkage of {LOOPS} loops over {UNTIL} s: error at the end {error:.1e}"
    return [said, bar("processor seconds of the linkage", seconds, LINKAGE)]


def tables() -> list[str]:
    """How commands grow with the points of a table."""
    lines = [f"points  {'  '.join(f'{command} s' for command in ('program', 'derive', 'simulate'))}"]
    costs = []
    for points in POINTS:
        with TemporaryDirectory() as directory:
            scene = Path(directory, "scene.mac")
            scene.write_text(TABLE, encoding="utf-8")
            times = [4 * k / (points - 1) for k in range(points)]
            rows = "".join(f"{t:.6f},{2 - 0.2 * sin(3 * t):.6f}\n" for t in times[:-1]) + "4,2.1\n"
            Path(directory, "points.csv").write_text(rows, encoding="utf-8")
            written = str(Path(directory, "written.json"))
            asked = (("program", "-o", written), ("derive",), ("simulate", "--final"))
            costs.append([cost_of_command(command, str(scene), *rest)[0] for command, *rest in asked])
        lines.append(f"{points:<6}  " + "  ".join(f"{seconds:.2f}" for seconds in costs[-1]))
    exponents = [
        log(later / earlier) / log(more / points)
        for (points, first), (more, second) in pairwise(zip(POINTS, costs, strict=True))
        for earlier, later in zip(first, second, strict=True)
    ]
    return [*lines, bar("power of the points that the time grows with, at most", max(exponents), GROWTH)]


def bar(what: str, value: float, limit: float) -> str:
    """A line that says whether a bar holds."""
    return f"{what}: {value:.3g}; bar {limit}: {'holds' if value <= limit else 'FAILS'}"


def main(directory: Path) -> None:
    """Measure, and write ``commands.txt`` into a directory."""
    cost_of_command("derive", str(EXAMPLES / "pendulum.mac"))  # an image of Maxima is made where there is none yet
    write_report(directory / "commands.txt", "\n".join([*derivations(), "", *linkage(), "", *tables()]) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
