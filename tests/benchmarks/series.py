"""`make bench`: the initial motion of the paper's example as a power series, against peers, one table and one figure.

    python tests/benchmarks/series.py build/benchmarks

Every method expands the same motion, under u = 3/10 + t; its coefficients of q1 are compared with the exact ones
before its time counts. A method that takes longer than the limit for one order is not asked for a higher one.
"""

import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from fractions import Fraction
from math import log
from pathlib import Path

from series_peers import METHODS, Expansion, Method, exact
from timing import TooLong, time_limit

from holonom.figures.style import INK, MARKERS, PALETTE, figure_style, new_figure, write_figure

ORDERS = (5, 10, 20, 40, 80, 160)
SECONDS = 20.0
SHORT = 3.0  # seconds: what takes less is measured several times
REPEATS = 5
TOLERANCE = 1e-6  # relative, of the coefficients in double precision
OURS, MPMATH = "Holonom, heyoka double", "mpmath"
COLUMNS = ("order", "method", "compile s", "expand s")


@dataclass(frozen=True)
class Row:
    """What one method takes for one order; None where it took too long."""

    method: str
    order: int
    compile: float | None
    expand: float | None


def main(directory: Path) -> None:
    """Measure, then write ``series.json``, ``series.txt`` and ``series.svg`` into a directory."""
    rows = list(measurements())
    report = table(rows) + "\n" + "\n".join(summary(rows)) + "\n"
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "series.json").write_text(json.dumps([asdict(row) for row in rows], indent=1) + "\n", encoding="utf-8")
    (directory / "series.txt").write_text(report, encoding="utf-8")
    draw(rows, directory / "series.svg")
    print(report)
    print(f"The table is in {directory / 'series.txt'}, the figure in {directory / 'series.svg'}.")


def measurements() -> Iterator[Row]:
    """All rows."""
    expected = [Fraction(text) for text in exact(max(ORDERS)).coefficients]
    too_slow = set()
    for order in ORDERS:
        for name, method in METHODS.items():
            found = None if name in too_slow else within_limit(method, order)
            if found is None:
                too_slow.add(name)
                yield Row(name, order, None, None)
            else:
                require_agreement(name, found, expected)
                yield Row(name, order, found.compile, found.expand)


def within_limit(method: Method, order: int) -> Expansion | None:
    """The shortest of several expansions, if one takes less than the limit."""
    try:
        with time_limit(SECONDS):
            first = method(order)
    except TooLong:
        return None
    if first.expand + (first.compile or 0) > SHORT:
        return first
    return min((first, *(method(order) for _ in range(REPEATS))), key=lambda found: (found.expand, found.compile or 0))


def require_agreement(name: str, found: Expansion, expected: Sequence[Fraction]) -> None:
    """Refuse to time a method that gets other numbers."""
    pairs = zip(found.coefficients, expected, strict=False)
    worst = max(abs(Fraction(str(value)) - true) / abs(true) for value, true in pairs)
    if worst > TOLERANCE:
        raise ArithmeticError(f"{name} deviates by {float(worst)} from the exact coefficients")


def table(rows: Sequence[Row]) -> str:
    """The rows as text."""
    lines = [COLUMNS]
    for row in rows:
        expand = f"over {SECONDS:.0f}, left out from here on" if row.expand is None else f"{row.expand:.2e}"
        lines.append((str(row.order), row.method, "" if row.compile is None else f"{row.compile:.3f}", expand))
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    padded = ("  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in lines)
    return "\n".join(padded)


def summary(rows: Sequence[Row]) -> Iterator[str]:
    """How each method grows, and how we compare with mpmath's series of the same order."""
    seconds = {(row.method, row.order): row.expand for row in rows if row.expand is not None}
    for name in METHODS:
        reached = max(order for order in ORDERS if (name, order) in seconds)
        before = max(reached // 4, ORDERS[0])
        if reached > before:
            exponent = log(seconds[name, reached] / seconds[name, before]) / log(reached / before)
            yield f"{name} grows as N^{exponent:.2f} from order {before} to {reached}, its start-up included"
    for order in ORDERS:
        if (MPMATH, order) in seconds:
            ratio = seconds[MPMATH, order] / seconds[OURS, order]
            yield f"{OURS}, once compiled, is {ratio:.0f} times as fast as {MPMATH} at order {order}"


def draw(rows: Sequence[Row], file: Path) -> None:
    """Seconds against the order; compile times dashed."""
    with figure_style():
        figure = new_figure(7, 5.5)
        axes = figure.subplots()
        for name, colour, marker in zip(METHODS, (*PALETTE, INK), (*MARKERS, "x"), strict=True):
            expand = [(row.order, row.expand) for row in rows if row.method == name and row.expand]
            axes.loglog(*zip(*expand, strict=True), color=colour, marker=marker, label=name)
            if compiled := [(row.order, row.compile) for row in rows if row.method == name and row.compile]:
                axes.loglog(*zip(*compiled, strict=True), "--", color=colour, linewidth=1, label=f"{name}: compile")
        axes.set(xlabel="order N", ylabel="time to expand / s")
        axes.set_xticks(ORDERS, ORDERS)
        axes.minorticks_off()
        figure.legend(loc="outside lower center", ncols=2)
        write_figure(figure, file)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
