"""The benchmark of simulation as a JSON document, a table and a figure."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from simulation_bars import ENGINES, Bar, faster_engine

from holonom.benchmark.machine import PACKAGES, this_machine
from holonom.figures.style import MARKERS, PALETTE, figure_style, new_figure, write_figure

if TYPE_CHECKING:
    from simulation import Row

COLUMNS = ("motion", "method", "run ms", "to ours", "compile s", "with compile s", "to ours", "")
BAR_COLUMNS = ("motion", "what", "measured", "bar", "")
TITLE = "Time to a relative error of 1e-9"
CAPTION = "compilation apart; interpolated between the two tolerances about 1e-9"


def write_report(rows: "Sequence[Row]", bars: Sequence[Bar], directory: Path) -> None:
    """Write ``simulation.json``, ``simulation.txt`` and ``simulation.svg``, and print the table."""
    machine = this_machine((*PACKAGES, "casadi", "sympy"))
    blocks = [TITLE, _aligned(table(rows)), "The bars", _aligned(bar_table(bars)), f"Measured on {machine}."]
    document = {
        "machine": asdict(machine),
        "rows": [asdict(row) for row in rows],
        "bars": [asdict(bar) | {"verdict": bar.verdict} for bar in bars],
    }
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "simulation.json").write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    (directory / "simulation.txt").write_text("\n\n".join(blocks) + "\n", encoding="utf-8")
    figure(rows, str(machine), directory / "simulation.svg")
    print("\n\n".join(blocks))


def table(rows: "Sequence[Row]") -> Iterator[tuple[str, ...]]:
    """The rows as text, times as ratios to our faster engine beside them."""
    yield COLUMNS
    by_motion = {name: {row.method: row for row in rows if row.motion == name} for name in {row.motion for row in rows}}
    for row in rows:
        named = by_motion[row.motion]
        own = named[faster_engine(named)]
        if row.seconds is None:
            yield (row.motion, row.method, "", "", "", "", "", row.reason)
            continue
        whole, own_whole = row.seconds + row.compile, own.seconds + own.compile
        yield (
            row.motion,
            row.method,
            f"{1e3 * row.seconds:.4g}",
            f"{row.seconds / own.seconds:.2f}",
            f"{row.compile:.3f}",
            f"{whole:.3f}",
            f"{whole / own_whole:.2f}",
            "",
        )


def bar_table(bars: Sequence[Bar]) -> Iterator[tuple[str, ...]]:
    """The bars as text."""
    yield BAR_COLUMNS
    for bar in bars:
        bound = "" if bar.bound is None else f"{'at least' if bar.at_least else 'at most'} {bar.bound:g}"
        yield bar.motion, bar.what, f"{bar.value:.3g}", bound, bar.verdict


def figure(rows: "Sequence[Row]", machine: str, file: Path) -> None:
    """Each method's time on each motion."""
    motions = list(dict.fromkeys(row.motion for row in rows))
    methods = sorted(dict.fromkeys(row.method for row in rows), key=lambda method: method not in ENGINES)
    with figure_style():
        drawing = new_figure(11, 6)
        axes = drawing.subplots()
        for index, method in enumerate(methods):
            points = [(motions.index(row.motion), row.seconds) for row in rows if row.method == method and row.seconds]
            style = {"color": PALETTE[index % len(PALETTE)], "marker": MARKERS[index // len(PALETTE) % len(MARKERS)]}
            line = "-" if method in ENGINES else "none"
            axes.semilogy(*zip(*points, strict=True), linestyle=line, label=method, **style)
        axes.set(xticks=range(len(motions)), xticklabels=motions, ylabel="time / s", title=f"{TITLE}, {CAPTION}")
        axes.legend(loc="center left", bbox_to_anchor=(1, 0.5))
        drawing.supxlabel(machine, x=0.01, ha="left", fontsize="x-small")
    write_figure(drawing, file)


def _aligned(lines: Iterator[tuple[str, ...]]) -> str:
    table = list(lines)
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in table
    )
