"""Draw a sweep as a map over two parameters, or as a curve over one."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..failures import ErrorKind, HolonomError
from ..language import translatable
from .style import BLUE, figure_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..sweeps.axes import Axes as SweepAxes
    from ..sweeps.run import Sweep

WIDTH, HEIGHT = 7.0, 5.0  # inches
BESIDE = ("row", "residual", "status", "note")


def sweep_figure(sweep: "Sweep", quantity: str | None = None) -> "Figure":
    """Return the figure of a column of a sweep, by default of the first quantity.

    Rows without a value are not drawn.

    Parameters
    ----------
    sweep : Sweep
        A finished sweep over one parameter, or over two in a grid.
    quantity : str or None
        Name of a column, or None for `plotted`.

    Returns
    -------
    Figure

    Raises
    ------
    HolonomError
        Matplotlib is not installed, there is no such quantity, or not one parameter varies, nor two in a grid.
    """
    names = [axis["name"] for axis in sweep.document["parameters"]]
    shown = quantity or _plotted(sweep.document)
    if shown not in sweep.document["columns"] or shown in ("status", "note"):
        raise HolonomError(
            ErrorKind.NOT_PLOTTED, detail=translatable("the sweep does not record %(shown)s", shown=shown)
        )
    table = sweep.dataset.to_table(columns=[*names, shown])
    columns = [np.array(table.column(name).to_numpy(zero_copy_only=False), dtype=float) for name in [*names, shown]]
    with figure_style():
        figure = new_figure(WIDTH, HEIGHT)
        panel = figure.subplots()
        if len(names) == 1:
            _curve(panel, *columns)
            panel.set_ylabel(f"{shown} (units of the scene)")
        else:
            _map(figure, panel, columns, f"{shown} (units of the scene)")
            panel.set_ylabel(f"{names[1]} (units of the scene)")
        panel.set_xlabel(f"{names[0]} (units of the scene)")
        panel.set_title(sweep.document["scene"]["title"])
    return figure


def require_plottable(axes: "SweepAxes") -> None:
    """Raise if a sweep is neither a curve nor a map.

    It may vary one parameter, or two in a grid.

    Parameters
    ----------
    axes : SweepAxes
        Parameters of the sweep.

    Raises
    ------
    HolonomError
        More than two parameters vary, or two that are sampled.
    """
    if len(axes.names) > 2 or (len(axes.names) == 2 and axes.samples):
        raise HolonomError(
            ErrorKind.NOT_PLOTTED, detail=translatable("a curve takes one parameter, a map two in grids or lists")
        )


def _plotted(document: dict[str, Any]) -> str:
    """Return the first quantity that a sweep records, or its residual."""
    names = {axis["name"] for axis in document["parameters"]}
    outputs = [name for name in document["columns"] if name not in names and name not in BESIDE]
    return outputs[0] if outputs else "residual"


def _curve(panel: "Axes", values: NDArray[np.float64], quantity: NDArray[np.float64]) -> None:
    order = np.argsort(values, kind="stable")
    panel.plot(values[order], quantity[order], color=BLUE, marker="." if len(values) < 100 else "")


def _map(figure: "Figure", panel: "Axes", columns: list[NDArray[np.float64]], label: str) -> None:
    across, up = np.unique(columns[0]), np.unique(columns[1])
    cells = np.full((len(up), len(across)), np.nan)
    cells[np.searchsorted(up, columns[1]), np.searchsorted(across, columns[0])] = columns[2]
    drawn = panel.pcolormesh(across, up, cells, shading="nearest", rasterized=True)
    figure.colorbar(drawn, ax=panel, label=label)
