"""`make bench`: the planar chain against peers, one table and one log-log figure.

    python tests/benchmarks/run.py build/benchmarks

Every peer starts from the same description and ends with the same compiled C function; its values are compared with
those of the solve by hand before they are timed.
"""

import json
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from math import log
from pathlib import Path

import chain
import matplotlib
import numpy as np
from numpy.typing import NDArray
from peers import PEERS
from timing import TooLong, many_points, time_limit

from holonom.failures import ErrorKind, HolonomError
from holonom.program.c_function import CFunction, compile_c, load_c
from holonom.program.heyoka_function import COMPACT_FROM, heyoka_expressions, import_heyoka
from holonom.program.motion_program import Program
from holonom.program.timing import Batch, Timer, shortest_times

LINKS = (1, 2, 4, 8, 16, 32, 64)
SECONDS = 30.0  # a peer that takes longer is not asked for a longer chain
LARGEST_COMPILED = 20_000  # operations; the C compiler would take minutes
POINTS = 1000
TOLERANCE = 1e-9  # relative, against the solve by hand
HAND_WRITTEN = Path(__file__).with_name("chain.c")
BY_HAND, OURS, HEYOKA = "by hand", "Holonom", "Holonom, heyoka"
COLUMNS = ("links", "method", "derive s", "compile s", "operations", "one point us", "a point of many us", "to hand")


@dataclass(frozen=True)
class Row:
    """What one method takes for one chain; None where it was not measured."""

    method: str
    links: int
    derive: float | None
    compile: float | None
    operations: int
    one_point: float | None = None
    many_points: float | None = None


def main(directory: Path) -> None:
    """Measure, then write ``chain.json``, ``chain.txt`` and ``chain.svg`` into a directory."""
    rows = list(measurements())
    report = table(rows) + "\n" + "\n".join(summary(rows)) + "\n"
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "chain.json").write_text(json.dumps([asdict(row) for row in rows], indent=1) + "\n", encoding="utf-8")
    (directory / "chain.txt").write_text(report, encoding="utf-8")
    figure(rows, directory / "chain.svg")
    print(report)
    print(f"The table is in {directory / 'chain.txt'}, the figure in {directory / 'chain.svg'}.")


def measurements() -> Iterator[Row]:
    """All rows; a method that takes too long is left out from there on."""
    timer, methods = Timer(), dict(PEERS)
    for links in LINKS:
        points = np.column_stack([chain.consistent_point(links, seed) for seed in range(POINTS)])
        yield by_hand(links, points, timer)
        for method, derive in tuple(methods.items()):
            start = time.perf_counter()
            try:
                with time_limit(SECONDS):
                    program = derive(links, SECONDS)
            except (TooLong, HolonomError) as reason:
                if isinstance(reason, HolonomError) and reason.kind is not ErrorKind.TOO_LONG:
                    raise
                del methods[method]
                continue
            yield from compiled_rows(method, links, program, time.perf_counter() - start, points, timer)


def by_hand(links: int, points: NDArray[np.float64], timer: Timer) -> Row:
    """The row of chain.c, which says how many operations it takes."""
    one = timer.batch(hand_written(links), points[:, 0].copy(), 3 * links)
    return Row(BY_HAND, links, None, None, 23 * links - 9, seconds_a_call(one))


def hand_written(links: int) -> Callable[..., None]:
    """The compiled function of chain.c."""
    return load_c(f"#define LINKS {links}\n" + HAND_WRITTEN.read_text(encoding="utf-8")).chain


def seconds_a_call(batch: Batch) -> float:
    """The shortest time of one call."""
    return shortest_times({0: batch})[0]


def compiled_rows(
    method: str, links: int, program: Program, derive: float, points: NDArray[np.float64], timer: Timer
) -> Iterator[Row]:
    """Rows of a program: compiled by the C compiler, and ours by heyoka too."""
    row, operations = partial(Row, method, links, derive), program.operations
    if operations > LARGEST_COMPILED:
        yield row(None, operations)
        return
    given = np.ascontiguousarray(points[[chain.inputs(links).index(name) for name in program.inputs]])
    start = time.perf_counter()
    function = compile_c(program)
    seconds = time.perf_counter() - start
    require_agreement(method, links, function, given[:, 0].copy(), points[:, 0].copy())
    one = seconds_a_call(timer.evaluation(function, given[:, 0].copy()))
    yield row(seconds, operations, one, many_points(function, given))
    if method == OURS:
        start = time.perf_counter()
        variables = {name: import_heyoka().expression(name) for name in program.inputs}
        results = heyoka_expressions(program, variables)
        compact = program.operations >= COMPACT_FROM
        jit = import_heyoka().cfunc(list(results.values()), vars=list(variables.values()), compact_mode=compact)
        seconds = time.perf_counter() - start
        yield Row(HEYOKA, links, derive, seconds, operations, None, many_points(jit, given))


def require_agreement(
    method: str, links: int, function: CFunction, given: NDArray[np.float64], point: NDArray[np.float64]
) -> None:
    """Refuse to time a method that gets other numbers than the solve by hand."""
    expected = np.empty(3 * links)
    one = hand_written(links)
    one.argtypes = function.one.argtypes
    one(point.ctypes.data, expected.ctypes.data)
    values = dict(zip(function.outputs, function(given), strict=True))
    deviation = max(abs(values[name] - value) for name, value in zip(chain.outputs(links), expected, strict=True))
    if not deviation <= TOLERANCE * max(abs(expected)):
        raise ArithmeticError(f"{method} deviates by {deviation} from the solve by hand at {links} links")


def table(rows: Sequence[Row]) -> str:
    """The rows as text."""
    hand = {row.links: row for row in rows if row.method == BY_HAND}
    lines = [COLUMNS]
    for row in rows:
        limit = hand[row.links]
        speed = "" if row.one_point is None else f", {row.one_point / limit.one_point:.2f} time"
        lines.append(
            (
                str(row.links),
                row.method,
                *(_shown(seconds, "{:.3f}") for seconds in (row.derive, row.compile)),
                str(row.operations),
                *(_shown(seconds, "{:.3f}", 1e6) for seconds in (row.one_point, row.many_points)),
                f"{row.operations / limit.operations:.2f} operations{speed}",
            )
        )
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)) for line in lines)


def summary(rows: Iterable[Row]) -> Iterator[str]:
    """How our program grows from 16 to 64 links, and the ratios that matter at 64."""
    rows = tuple(rows)
    ours, compiled = ({row.links: row for row in rows if row.method == method} for method in (OURS, HEYOKA))
    middle, long = ours[16], ours[64]
    yield f"operations grow as N^{_exponent(middle.operations, long.operations):.2f}"
    for row in (long, compiled[64]):
        yield f"{row.method}, scene to compiled callable at 64 links: {row.derive + row.compile:.2f} s"
        ratio = long.one_point / row.many_points
        yield f"{row.method}, many points at 64 links: {ratio:.2f} times as fast a point as one at a time in C"


def figure(rows: Sequence[Row], file: Path) -> None:
    """Seconds to derive, operations and time for one point against the number of links."""
    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "holonom"
    from matplotlib import pyplot

    quantities = {
        "time to derive / s": lambda row: row.derive,
        "operations": lambda row: row.operations,
        "time for one point / µs": lambda row: row.one_point and row.one_point * 1e6,
    }
    drawing, axes = pyplot.subplots(1, len(quantities), figsize=(15, 5), layout="constrained")
    for axis, (label, quantity) in zip(axes, quantities.items(), strict=True):
        for colour, method in enumerate((BY_HAND, *PEERS)):
            curve = [(row.links, quantity(row)) for row in rows if row.method == method and quantity(row)]
            if curve:
                axis.loglog(*zip(*curve, strict=True), marker="o", color=f"C{colour}", label=method)
        axis.set(xlabel="links N", ylabel=label, xticks=LINKS, xticklabels=LINKS)
        axis.grid(alpha=0.3)
    drawing.legend(*axes[1].get_legend_handles_labels(), loc="outside lower center", ncols=len(PEERS) + 1)
    drawing.savefig(file, metadata={"Date": None})


def _exponent(at_16: float, at_64: float) -> float:
    return log(at_64 / at_16) / log(64 / 16)


def _shown(value: float | None, form: str, factor: float = 1.0) -> str:
    return "" if value is None else form.format(value * factor)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
