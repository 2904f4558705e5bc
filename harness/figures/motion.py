"""Draw a motion over the time, and a path with and without an effect."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..failures import ErrorKind, HolonomError
from ..language import gettext, translatable, translated
from .style import BLUE, LINES, PALETTE, VERMILION, figure_style, new_figure, svg_text, with_symbols, write_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..simulation.result import Simulation


WIDTH, HEIGHT_OF_PANEL = 6.5, 2.8  # inches
UNLIKE = 30.0  # how many times larger a curve is that leaves another one flat
NOTHING = 1e-9  # relative to the largest value: rounding alone
IN_A_COLUMN = 12  # curves in a column of a legend


def draw_motion(simulation: "Simulation", file: Path, curves: Sequence[str] | None = None) -> None:
    """Draw a motion, or some curves of it, into a file, SVG or PNG.

    Parameters
    ----------
    simulation : Simulation
        The motion.
    file : Path
        File to write. The suffix .png selects PNG, any other SVG.
    curves : sequence of str or None
        As for `motion_figure`.

    Raises
    ------
    HolonomError
        Matplotlib is not installed, or the file cannot be written.
    """
    with figure_style():
        write_figure(motion_figure(simulation, curves), file)


def motion_figure(simulation: "Simulation", curves: Sequence[str] | None = None) -> "Figure":
    """Return the figure of a motion, a panel for each kind of quantity that it holds.

    Parameters
    ----------
    simulation : Simulation
        The motion.
    curves : sequence of str or None
        Names of quantities as in `Simulation.keys`, or None for all but residuals and sensitivities.

    Returns
    -------
    Figure

    Raises
    ------
    HolonomError
        Matplotlib is not installed, or there is no such quantity, or the scene does not observe it.
    """
    groups = {
        gettext("coordinates"): simulation.coordinates,
        gettext("velocities"): simulation.velocities,
        gettext("multipliers"): simulation.multipliers,
        gettext("constraint forces"): simulation.constraint_forces,
        gettext("controls"): simulation.controls,
        gettext("outputs"): simulation.outputs,
        gettext("energy"): simulation.energy,
    }
    if curves is not None:
        others = {gettext("residuals"): simulation.residual_columns(), gettext("derivatives"): simulation.sensitivities}
        groups = _chosen(groups | others, curves)
    drawn = [(title, part) for title, curves in groups.items() for part in of_like_size(curves)]
    with figure_style():
        figure = new_figure(WIDTH, HEIGHT_OF_PANEL * len(drawn))
        panels = figure.subplots(len(drawn), 1, sharex=True, squeeze=False)[:, 0]
        for panel, (title, curves) in zip(panels, drawn, strict=True):
            _draw(panel, simulation.times.astype(float), curves, simulation.report.joints)
            panel.set_ylabel(gettext("%(quantity)s\n(units of the scene)", quantity=title))
        panels[0].set_title(translated(simulation.title))
        panels[-1].set_xlabel(gettext("t (units of the scene)"))
    return figure


def _chosen(groups: Mapping[str, Mapping[str, NDArray]], names: Sequence[str]) -> dict[str, dict[str, NDArray]]:
    known = {name for group in groups.values() for name in group}
    if unknown := [name for name in names if name not in known] or [""] * (not names):
        raise HolonomError(
            ErrorKind.NO_CURVE,
            detail=translatable("%(name)s; there are %(names)s", name=repr(unknown[0]), names=", ".join(sorted(known))),
        )
    return {title: {name: group[name] for name in group if name in names} for title, group in groups.items()}


def of_like_size(curves: Mapping[str, NDArray]) -> list[dict[str, NDArray]]:
    """Return groups of curves, each of which can be read on one axis.

    Within a group the sizes differ by a factor of hundreds at most. Curves that are zero except for rounding are in the
    group with the smallest values.

    Parameters
    ----------
    curves : mapping of str to ndarray, shape (k,)
        Samples by name of the quantity.

    Returns
    -------
    list of dict
        The group with the largest values first. Names keep their order within a group.
    """
    sizes = {name: float(np.max(np.abs(samples.astype(float)), initial=0.0)) for name, samples in curves.items()}
    parts: list[dict[str, NDArray]] = []
    top, largest = 0.0, max(sizes.values(), default=0.0)
    for name in sorted(curves, key=sizes.__getitem__, reverse=True):
        if not parts or NOTHING * largest < sizes[name] < top / UNLIKE:
            parts.append({})
            top = sizes[name]
        parts[-1][name] = curves[name]
    return [{name: curves[name] for name in curves if name in part} for part in parts]


def _draw(axes: "Axes", times: NDArray[np.float64], curves: Mapping[str, NDArray], joints: Mapping[str, str]) -> None:
    for index, (name, samples) in enumerate(curves.items()):
        line = LINES[index // len(PALETTE) % len(LINES)]
        colour = PALETTE[index % len(PALETTE)]
        label = f"{with_symbols(name)} ({joints[name]})" if name in joints else with_symbols(name)
        axes.plot(times, samples.astype(float), linestyle=line, color=colour, label=label)
    low, high = axes.dataLim.intervaly
    size = max(abs(low), abs(high))
    if high - low < NOTHING * size:
        axes.set_ylim(low - size / 20, high + size / 20)
    columns = math.ceil(len(curves) / IN_A_COLUMN)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), ncols=columns)


HEIGHT_OF_WAYS = 3.6  # inches


def draw_with_and_without(present: "Simulation", absent: "Simulation", across: str, along: str) -> str:
    """Draw the path of a body in a plane, with and without an effect, as SVG.

    The plane is that of two coordinates.

    Parameters
    ----------
    present : Simulation
        Motion with the effect.
    absent : Simulation
        Motion without the effect.
    across : str
        Name of the horizontal coordinate.
    along : str
        Name of the vertical coordinate.

    Returns
    -------
    str
        SVG document.
    """
    reach = 1.05 * max(abs(motion.coordinates[name]).max() for motion in (present, absent) for name in (across, along))
    with figure_style():
        figure = new_figure(WIDTH, HEIGHT_OF_WAYS)
        panels = figure.subplots(1, 2, sharex=True, sharey=True)
        panels[0].set(xlim=(-reach, reach), ylim=(-reach, reach))
        for panel, motion, colour in zip(panels, (absent, present), (BLUE, VERMILION), strict=True):
            _draw_way(panel, motion, across, along, colour)
            panel.set_xlabel(gettext("%(quantity)s (units of the scene)", quantity=across))
        panels[0].set_ylabel(gettext("%(quantity)s (units of the scene)", quantity=along))
        return svg_text(figure)


def _draw_way(axes: "Axes", motion: "Simulation", across: str, along: str, colour: str) -> None:
    x, y = motion.coordinates[across], motion.coordinates[along]
    axes.plot(x, y, color=colour, linewidth=1)
    axes.plot(x[:1], y[:1], "o", color=colour, label=gettext("start"))
    axes.plot(x[-1:], y[-1:], "s", color=colour, label=f"t = {motion.times[-1]:g}")
    axes.set_title(translated(motion.title), fontsize="small")
    axes.set_aspect("equal")
    axes.legend(loc="upper right")
