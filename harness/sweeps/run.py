"""Run a sweep: derive the equations, compute chunk by chunk, read the rows lazily."""

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..failures import ErrorKind, HolonomError
from ..language import translatable
from ..processes import usable_cores
from ..program.motion_problem import DOUBLE_DIGITS, MotionProblem, problem_document, read_problem
from ..program.precision import read_precision
from ..program.request import Request
from ..sandbox import Limits
from ..simulation.engines.taylor import checked_tolerance
from ..source import Source, source_of
from .axes import Axes, Grid, Listed, Sample, not_an_axis
from .dataset import SweepDocument, SweepFolder, SweptOptions, SweptParameter, SweptScene, chunks_of
from .outputs import Kind
from .request import SweepRequest
from .rows import Plan, RowMaker
from .workers import compute, require_address

if TYPE_CHECKING:
    from pandas import DataFrame
    from pyarrow.dataset import Dataset

    from ..figures.style import Picture

PACKAGES = ("holonom", "heyoka", "numpy", "pyarrow")  # whose versions may decide about the last bit
Progress = Callable[[int], None]


@dataclass(frozen=True)
class Sweep:
    """A sweep in its folder. Rows are read at their first use.

    Attributes
    ----------
    path : Path
        The folder.
    document : mapping
        What was swept, and how. See `holonom.sweeps.dataset.SweepDocument`.
    mended : tuple of str
        Files that were there and not as they were written: they have been computed again.
    """

    path: Path
    document: Mapping[str, Any]
    mended: tuple[str, ...] = ()
    _directory: Any = field(default=None, repr=False, compare=False)  # a folder that goes with the last of its sweeps

    @property
    def dataset(self) -> "Dataset":
        """The rows as a dataset of pyarrow, which is read lazily."""
        import pyarrow.dataset

        return pyarrow.dataset.dataset([self.path / chunk.name for chunk in chunks_of(self.document)], format="parquet")

    @property
    def statuses(self) -> dict[str, int]:
        """Number of rows by status."""
        counts: dict[str, int] = {}
        for batch in self.dataset.to_batches(columns=["status"]):
            for entry in batch.column(0).value_counts().to_pylist():
                counts[entry["values"]] = counts.get(entry["values"], 0) + entry["counts"]
        return dict(sorted(counts.items()))

    def to_pandas(self) -> "DataFrame":
        """Return all rows as a pandas DataFrame, by their numbers.

        Returns
        -------
        DataFrame
            Indexed by the row number.
        """
        return self.dataset.to_table().to_pandas().set_index("row")

    def plot(self, quantity: str | None = None) -> "Picture":
        """Return a map over two parameters, or a curve over one.

        Parameters
        ----------
        quantity : str or None
            A column. None for the first recorded one.

        Returns
        -------
        Picture

        Raises
        ------
        HolonomError
            Matplotlib is not installed. There are not one or two parameters in rows and columns, or no such quantity.
        """
        from ..figures.style import Picture
        from ..figures.sweep import sweep_figure

        return Picture(sweep_figure(self, quantity))


def run_sweep(
    file: Source | Path,
    request: Request,
    wanted: SweepRequest,
    folder: Path,
    limits: Limits,
    progress: Progress | None = None,
) -> Sweep:
    """Compute the missing chunks of a sweep in a folder.

    Parameters
    ----------
    file : Source or Path
        Scene file.
    request : Request
        Scene and its settings.
    wanted : SweepRequest
        Axes, outputs, tolerance, workers and size of chunks.
    folder : Path
        Folder to write to. It is created if missing.
    limits : Limits
        Limits of each run of Maxima.
    progress : Progress or None
        Called with the number of finished rows after each chunk.

    Returns
    -------
    Sweep
        The sweep with all its rows.

    Raises
    ------
    HolonomError
        The request cannot be met, or the folder holds something else, or as `holonom.program.motion_problem`.
    """
    require_address(wanted.scheduler)
    checked_tolerance(wanted.tol, read_precision("double"))
    source = source_of(file, limits)
    kinds = {output.kind for output in wanted.outputs}
    if both := [name for name in wanted.axes.names if name in request.settings]:
        raise not_an_axis(translatable("%(name)s is varied and set to a value; drop one of both", name=both[0]))
    text = _derived(source, replace(request, derivatives=Kind.DERIVATIVE in kinds), wanted.axes)
    problem = read_problem(text)
    _require_parameters(problem, wanted.axes)
    plan = Plan(problem, wanted.axes, wanted.outputs, wanted.tol, wanted.until, wanted.stabilization)
    maker = RowMaker(plan)  # rejects what cannot be computed before there is a folder
    target = SweepFolder(folder, _document(source, request, wanted, text, maker))
    with target.locked(wanted.resume):
        absent, altered = target.missing()
        chunks = sorted([*absent, *altered], key=lambda chunk: chunk.index)
        done = wanted.axes.rows - sum(chunk.last - chunk.first for chunk in chunks)

        def take(chunk: Any, content: bytes) -> None:
            nonlocal done
            target.write(chunk, content)
            done += chunk.last - chunk.first
            if progress is not None:
                progress(done)

        if chunks:
            compute(plan, chunks, take, wanted.workers or usable_cores(), wanted.scheduler)
    return Sweep(folder, target.document, tuple(chunk.name for chunk in altered))


def _derived(source: Source, request: Request, axes: Axes) -> str:
    """Return the document of the motion with its parameters open.

    If the derivation needs values, they are those of the middle row.
    """
    try:
        return problem_document(source, request, source.limits, DOUBLE_DIGITS, axes.names)
    except HolonomError as refused:
        if refused.kind is not ErrorKind.REFUSED:
            raise
        middle = axes.numbers(axes.rows // 2, axes.rows // 2 + 1)[:, 0]
        numbers = {name: str(Fraction(float(x))) for name, x in zip(axes.names, middle, strict=True)}
        given = replace(request, settings={**request.settings, **numbers})
        try:
            return problem_document(source, given, source.limits, DOUBLE_DIGITS, axes.names)
        except HolonomError:
            raise refused from None


def _require_parameters(problem: MotionProblem, axes: Axes) -> None:
    if foreign := [name for name in axes.names if name not in problem.parameters]:
        raise not_an_axis(translatable("unknown parameter %(name)s of %(scene)s", name=foreign[0], scene=problem.scene))


def _document(source: Source, request: Request, wanted: SweepRequest, derived: str, maker: RowMaker) -> SweepDocument:
    text, problem, axes = source.text, maker.plan.problem, wanted.axes
    return SweepDocument(
        SweptScene(
            file=wanted.called or str(source.file),
            name=problem.scene,
            title=problem.title,
            system=problem.system.title,
            text=text,
            sha256=hashlib.sha256(text.encode()).hexdigest(),
            motion_sha256=hashlib.sha256(derived.encode()).hexdigest(),
        ),
        settings=request.settings,
        parameters=tuple(map(_axis, (*axes.values, *axes.samples))),
        size=axes.size if axes.samples else None,
        seed=axes.seed if axes.samples else None,
        rows=axes.rows,
        chunk=wanted.chunk,
        keep=tuple(output.text for output in wanted.outputs),
        columns=("row", *axes.names, *maker.columns, str(Kind.RESIDUAL), "status", "note"),
        options=SweptOptions(
            wanted.tol, None if wanted.until is None else str(wanted.until), wanted.stabilization, request.solve
        ),
        versions={name: version(name) for name in PACKAGES},
    )


def _axis(axis: Grid | Listed | Sample) -> SweptParameter:
    return SweptParameter(axis.name, str(axis.distribution) if isinstance(axis, Sample) else "values", axis.text)
