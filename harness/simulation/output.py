"""A motion as files: its samples as CSV, NumPy's NPZ or Parquet, and its figure. Each whole, or not at all.

Numbers that no double can hold are written as decimal text.
"""

import io
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from ..confined import MIB
from ..failures import Failure, HolonomError, missing_package
from ..files import write_whole
from ..program.motion_problem import MotionProblem
from .document import published_list
from .result import Simulation

BYTES_OF_NUMBER = 250  # while samples are collected and written as text: measured for 300000 of six numbers each
Columns = Mapping[str, NDArray[np.float64] | NDArray[np.str_]]


def require_formats(samples: Path | None, figure: Path | None) -> None:
    """Refuse names of files that cannot be written, before there is anything to write.

    Parameters
    ----------
    samples, figure : Path or None

    Raises
    ------
    HolonomError
        There is no format of that suffix, or what it needs is not installed.
    """
    if samples is not None:
        sample_format(samples)
    if figure is not None and figure.suffix not in FIGURES:
        raise _no_such_format(figure, FIGURES)


def require_memory(problem: MotionProblem, samples: int, memory_mib: int) -> None:
    """Refuse more samples than the memory holds, before the motion is followed.

    Parameters
    ----------
    problem : MotionProblem
    samples : int
    memory_mib : int

    Raises
    ------
    HolonomError
        It names what they take and how many there is room for.
    """
    numbers = 1 + len(problem.state) + len(problem.multipliers)
    needed = samples * numbers * BYTES_OF_NUMBER / MIB
    if needed > memory_mib:
        room = int(memory_mib * MIB / (numbers * BYTES_OF_NUMBER))
        said = f"{samples} samples take about {needed:.0f} MiB of memory, and there are {memory_mib} for {room}"
        raise HolonomError(Failure.TOO_MANY_SAMPLES, detail=said)


def write_files(simulation: Simulation, samples: Path | None, figure: Path | None) -> None:
    """Write the samples of a motion, and its figure, as far as they are wanted.

    Parameters
    ----------
    simulation : Simulation
    samples, figure : Path or None

    Raises
    ------
    HolonomError
        As `require_formats`; a file cannot be written.
    """
    if samples is not None:
        write_samples(simulation, samples)
    if figure is not None:
        from ..figures.motion import draw_motion

        draw_motion(simulation, figure)


def write_samples(simulation: Simulation, path: Path) -> None:
    """Write the samples of a motion.

    Parameters
    ----------
    simulation : Simulation
    path : Path
        Its suffix names the format: one of `FORMATS`.

    Raises
    ------
    HolonomError
        There is no such format, or what it needs is not installed; the file cannot be written.
    """
    form = sample_format(path)
    digits = simulation.report.digits
    write_whole(path, form({name: np.array(published_list(row, digits)) for name, row in simulation.columns()}))


def sample_format(path: Path) -> Callable[[Columns], bytes]:
    """What turns samples into the content of a file.

    Parameters
    ----------
    path : Path

    Returns
    -------
    callable

    Raises
    ------
    HolonomError
        There is no format of that suffix, or what it needs is not installed.
    """
    if path.suffix not in FORMATS:
        raise _no_such_format(path, FORMATS)
    if path.suffix == ".parquet":
        _import_parquet()
    return FORMATS[path.suffix]


def _csv(columns: Columns) -> bytes:
    """A line of names, then a line for each instant; a double as the shortest text that reads back the same."""
    texts = [[str(value) for value in column.tolist()] for column in columns.values()]
    lines = [",".join(columns), *map(",".join, zip(*texts, strict=True))]
    return ("\n".join(lines) + "\n").encode()


def _npz(columns: Columns) -> bytes:
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **columns)
    return buffer.getvalue()


def _parquet(columns: Columns) -> bytes:
    pyarrow, parquet = _import_parquet()
    buffer = io.BytesIO()
    table = pyarrow.table({name: pyarrow.array(column) for name, column in columns.items()})
    parquet.write_table(table.replace_schema_metadata({"creator": "holonom"}), buffer)
    return buffer.getvalue()


def _import_parquet() -> tuple[ModuleType, ModuleType]:
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError:
        raise missing_package("pyarrow") from None
    return pyarrow, parquet


def _no_such_format(path: Path, suffixes: Iterable[str]) -> HolonomError:
    return HolonomError(Failure.NO_SUCH_FORMAT, path, ", ".join(suffixes))


FIGURES = (".svg", ".png")
FORMATS: Mapping[str, Callable[[Columns], bytes]] = {".csv": _csv, ".npz": _npz, ".parquet": _parquet}
