"""Output of a motion: samples (CSV, NPZ, Parquet), figure, film and JSON document.

A file is written completely or not at all. Numbers beyond the range of doubles are written as decimal text.
"""

import csv
import io
import shutil
import zipfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ..explanations import engine_text, notes
from ..extras import missing_package
from ..failures import ErrorKind, HolonomError
from ..files import whole_file
from ..formats import Publication, published
from ..hidden import visible_line
from ..language import translatable
from ..program.motion_problem import MotionProblem
from ..sandbox import MIB
from ..structs import written
from .result import Report, Sampled, Simulation, SimulationDocument

BYTES_OF_NUMBER = 250  # while samples are collected and written as text: measured for 300000 of six numbers each
BYTES_IN_ARRAYS = 16  # of a double that is recorded in a block, and joined with others
Columns = Mapping[str, NDArray[np.float64] | NDArray[np.str_]]
Write = Callable[[Columns], None]
FORMULA = ("=", "+", "-", "@", "\t", "\r")  # with which a spreadsheet's formulas begin
Format = Callable[[BinaryIO], AbstractContextManager[Write]]


def require_formats(samples: Path | None, figure: Path | None, film: Path | None = None) -> None:
    """Reject names of files in unsupported formats.

    Parameters
    ----------
    samples : Path or None
        File of the samples, or None for no file.
    figure : Path or None
        File of the figure, or None for no file.
    film : Path or None
        File of the film, or None for no file.

    Raises
    ------
    HolonomError
        There is no format of that suffix, or what it needs is not installed.
    """
    if samples is not None:
        _sample_format(samples)
    if figure is not None and figure.suffix not in FIGURES:
        raise _no_such_format(figure, FIGURES)
    if film is not None:
        from ..figures.film import film_format

        film_format(film)


def require_memory(problem: MotionProblem, samples: int, memory_mib: int, of_number: int = BYTES_OF_NUMBER) -> None:
    """Reject more samples than the memory holds, before the integration.

    Parameters
    ----------
    problem : MotionProblem
        The motion, which gives the numbers in a sample.
    samples : int
        Number of samples.
    memory_mib : int
        Available memory, in MiB.
    of_number : int
        Bytes that a number takes.

    Raises
    ------
    HolonomError
        The samples need more memory. The message states the number that fits.
    """
    numbers = _numbers_a_sample(problem)
    needed = samples * numbers * of_number / MIB
    if needed > memory_mib:
        room = int(memory_mib * MIB / (numbers * of_number))
        estimate = translatable(
            "%(samples)s samples take about %(size)s MiB of memory, and there are %(free)s for %(room)s",
            samples=samples,
            size=f"{needed:.0f}",
            free=memory_mib,
            room=room,
        )
        raise HolonomError(ErrorKind.TOO_MANY_SAMPLES, detail=estimate)


def require_disk(problem: MotionProblem, samples: int, path: Path) -> None:
    """Reject more samples than the disk holds, before the integration.

    Parameters
    ----------
    problem : MotionProblem
        The motion, which gives the numbers in a sample.
    samples : int
        Number of samples.
    path : Path
        CSV or Parquet file to be written.

    Raises
    ------
    HolonomError
        The folder has less room. The message states the number that fits.
    """
    folder = path.resolve().parent
    free = shutil.disk_usage(folder).free / MIB
    size = _numbers_a_sample(problem) * BYTES_ON_DISK[path.suffix]
    if samples * size / MIB > free:
        estimate = translatable(
            "%(samples)s samples take about %(size)s MiB of disk", samples=samples, size=f"{samples * size / MIB:.0f}"
        )
        raise HolonomError(
            ErrorKind.DISK_TOO_SMALL,
            path,
            translatable(
                "%(estimate)s, and %(folder)s has room for %(count)s",
                estimate=estimate,
                folder=folder,
                count=int(free * MIB / size),
            ),
        )


def _numbers_a_sample(problem: MotionProblem) -> int:
    outputs = () if problem.outputs is None else problem.outputs.outputs
    return 1 + len(problem.state) + len(problem.multipliers) + len(outputs)


def write_files(
    simulation: Simulation,
    samples: Path | None,
    figure: Path | None,
    curves: Sequence[str] | None = None,
    film: Path | None = None,
) -> None:
    """Write the requested files of a motion: samples, figure and film.

    Parameters
    ----------
    simulation : Simulation
        The motion.
    samples : Path or None
        File of the samples, or None for no file.
    figure : Path or None
        File of the figure, or None for no file.
    curves : sequence of str or None
        Curves of the figure, as for `motion_figure`.
    film : Path or None
        File of the film, or None for no file.

    Raises
    ------
    HolonomError
        As `require_formats`, or a file cannot be written.
    """
    if samples is not None:
        _write_samples(simulation, samples)
    if figure is not None:
        from ..figures.motion import draw_motion

        draw_motion(simulation, figure, curves)
    if film is not None:
        simulation.film().save(film)


def _write_samples(simulation: Simulation, path: Path) -> None:
    """Write the samples of a motion into a file."""
    with sample_file(path, simulation.report.digits) as take:
        take(simulation)


def streams(path: Path) -> bool:
    """Return True if a file is written sample by sample.

    Parameters
    ----------
    path : Path
        Name of the file.

    Returns
    -------
    bool
    """
    return path.suffix in BYTES_ON_DISK


@contextmanager
def sample_file(path: Path, digits: int) -> Iterator[Callable[[Sampled], None]]:
    """Provide a file of samples that are written in blocks.

    The file appears, complete, if the block ends without an error.

    Parameters
    ----------
    path : Path
        File to write. Its suffix is .csv, .npz or .parquet.
    digits : int
        Decimal digits of numbers beyond double precision.

    Yields
    ------
    callable
        Takes samples that follow those before.

    Raises
    ------
    HolonomError
        There is no such format, or what it needs is not installed, or the file cannot be written.
    """
    form, text = _sample_format(path), partial(_text, digits=digits)
    with whole_file(path) as file, form(file) as write:
        yield lambda samples: write({name: np.array(written(row, text)) for name, row in samples.columns()})


def _sample_format(path: Path) -> Format:
    """Return the function that writes samples into a file of this name."""
    if path.suffix not in FORMATS:
        raise _no_such_format(path, FORMATS)
    if path.suffix == ".parquet":
        _import_parquet()
    return FORMATS[path.suffix]


@contextmanager
def _csv(file: BinaryIO) -> Iterator[Write]:
    """Provide a CSV writer: a line of names, then a line for each time.

    A double is the shortest text that reads back the same.
    """
    named = False

    def write(columns: Columns) -> None:
        nonlocal named
        text = io.StringIO()
        lines = csv.writer(text, lineterminator="\n")
        if not named:
            lines.writerow(map(_heading, columns))
        named = True
        lines.writerows(zip(*(column.tolist() for column in columns.values()), strict=True))
        file.write(text.getvalue().encode())

    yield write


def _heading(name: str) -> str:
    """Return a name as a heading that no spreadsheet takes for a formula."""
    return visible_line(f"'{name}" if name.startswith(FORMULA) else name)


@contextmanager
def _npz(file: BinaryIO) -> Iterator[Write]:
    """Collect all samples, and write each quantity as one array at the end."""
    columns: list[Columns] = []
    yield columns.append
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:  # as NumPy does, of names that it reserves, too
        for name in columns[0]:
            with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                np.lib.format.write_array(member, np.concatenate([each[name] for each in columns]), allow_pickle=False)


@contextmanager
def _parquet(file: BinaryIO) -> Iterator[Write]:
    """Provide a row group for the samples that come together."""
    pyarrow, parquet = _import_parquet()
    with ExitStack() as opened:
        writer = None

        def write(columns: Columns) -> None:
            nonlocal writer
            table = pyarrow.table({name: pyarrow.array(column) for name, column in columns.items()})
            table = table.replace_schema_metadata({"creator": "holonom"})
            if writer is None:
                writer = opened.enter_context(parquet.ParquetWriter(file, table.schema))
            writer.write_table(table)

        yield write


def _import_parquet() -> tuple[ModuleType, ModuleType]:
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError:
        raise missing_package("pyarrow") from None
    return pyarrow, parquet


def _no_such_format(path: Path, suffixes: Iterable[str]) -> HolonomError:
    return HolonomError(ErrorKind.NO_SUCH_FORMAT, path, ", ".join(suffixes))


FIGURES = (".svg", ".png")
FORMATS: Mapping[str, Format] = {".csv": _csv, ".npz": _npz, ".parquet": _parquet}
BYTES_ON_DISK = {".csv": 20, ".parquet": 9}
"""What a number takes in the formats that are written as samples come: measured for a swing in double precision."""


def simulation_document(simulation: Simulation) -> dict[str, Any]:
    """Return `report_document` with the samples by name under ``samples``.

    Parameters
    ----------
    simulation : Simulation
        The motion.

    Returns
    -------
    dict
    """
    return _document(simulation.report, simulation.scene, simulation.title, dict(simulation.columns()))


def report_document(report: Report) -> dict[str, Any]:
    """Return the report as a document.

    It contains ``trusted``, and the texts ``engine`` and ``notes`` next to segments and cases.

    Parameters
    ----------
    report : Report
        Report of a motion.

    Returns
    -------
    dict
    """
    return _document(report)


def _document(report: Report, *of_samples: Any) -> dict[str, Any]:
    content = SimulationDocument(report, engine_text(report.segments), tuple(notes(report)), *of_samples)
    return published(Publication.SIMULATION, content, partial(_text, digits=report.digits))


def _text(number: Any, digits: int) -> str:
    """Return decimal digits of a number that no double can hold."""
    import mpmath

    with mpmath.workdps(digits + 5):
        return mpmath.nstr(mpmath.mpf(str(number)), digits, strip_zeros=False)
