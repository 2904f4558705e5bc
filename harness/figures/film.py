"""Write films of motions as SVG, HTML, GIF or, with ffmpeg, MP4."""

import shutil
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..described import Shape
from ..failures import ErrorKind, HolonomError
from ..files import write_whole
from ..hidden import visible_line
from ..language import translatable
from ..temporary import private_directory
from .drawing import Film, animation, extents, film_of
from .style import BLUE, VERMILION, figure_style, new_figure

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from ..simulation.result import Simulation

EVEN = 1e-9  # of the time span: by how much times may differ from equidistant ones
INCHES, DOTS, MARGIN = 6.0, 100, 0.05  # width, dots per inch, and room around the picture in terms of its size
PAGE = '<!DOCTYPE html>\n<html><head><meta charset="utf-8"><title>{title}</title></head>\n<body>{svg}</body></html>\n'
ESCAPES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;"})


class MovingPicture:
    """A film for notebooks and files."""

    def __init__(self, film: Film) -> None:
        self.film = film

    def save(self, path: str | Path) -> None:
        """Write the film as SVG, HTML, GIF or MP4, by the suffix of the name.

        Parameters
        ----------
        path : str or Path
            File to write. Its suffix is .svg, .html, .gif or .mp4.

        Raises
        ------
        HolonomError
            There is no such format, or ffmpeg, which MP4 needs, is not installed, or the file cannot be written.
        """
        write_whole(Path(path), film_format(Path(path))(self.film))

    def _repr_html_(self) -> str:
        return animation(self.film)


def moving_picture(simulation: "Simulation") -> MovingPicture:
    """Return the film of a motion.

    Parameters
    ----------
    simulation : Simulation
        A motion with a drawing and its trajectory at equidistant times.

    Returns
    -------
    MovingPicture

    Raises
    ------
    HolonomError
        The system has no drawing, the scene does not observe the trajectory, or the samples are not equidistant.
    """
    times = simulation.times.astype(float)
    even = np.linspace(times[0], times[-1], len(times))
    if simulation.drawing is None:
        raise HolonomError(ErrorKind.NOT_FILMED, detail=translatable("the system has no drawing"))
    if not simulation.coordinates:
        raise HolonomError(ErrorKind.NOT_FILMED, detail=translatable("the scene does not observe its trajectory"))
    if len(times) < 2 or np.abs(times - even).max() > EVEN * np.ptp(times):
        raise HolonomError(ErrorKind.NOT_FILMED, detail=translatable("the samples are not equidistant"))
    return MovingPicture(film_of(simulation, simulation.drawing))


def film_format(path: Path) -> Callable[[Film], str | bytes]:
    """Return the function that encodes films for a file name.

    Parameters
    ----------
    path : Path
        Name of the file. Its suffix selects the format.

    Returns
    -------
    callable
        Takes a `Film`. Returns str for SVG and HTML, bytes for GIF and MP4.

    Raises
    ------
    HolonomError
        There is no such format, or ffmpeg, which MP4 needs, is not installed.
    """
    if path.suffix not in FORMATS:
        raise HolonomError(ErrorKind.NO_SUCH_FORMAT, path, ", ".join(FORMATS))
    if path.suffix == ".mp4" and shutil.which("ffmpeg") is None:
        raise HolonomError(ErrorKind.NO_FFMPEG, path)
    return FORMATS[path.suffix]


def _page(film: Film) -> str:
    return PAGE.format(title=visible_line(film.title).translate(ESCAPES), svg=animation(film))


def _frames(film: Film, suffix: str) -> bytes:
    """Draw frame by frame, on white."""
    with figure_style(), private_directory() as folder:
        from matplotlib.animation import FFMpegWriter, PillowWriter

        (left, right), (low, high) = extents(film.shapes, film.numbers)
        room = MARGIN * (max(right - left, high - low) or 1)
        height = INCHES * min(max((high - low) / max(right - left, 1e-300), 0.25), 1.5)
        figure = new_figure(INCHES, height)
        axes = figure.subplots()
        axes.set(xlim=(left - room, right + room), ylim=(low - room, high + room), aspect="equal")
        axes.set_title(visible_line(film.title), fontsize="small")
        moves = [artist(axes, shape, numbers) for shape, numbers in zip(film.shapes, film.numbers, strict=True)]
        count = len(film.times)
        writer = {".gif": PillowWriter, ".mp4": FFMpegWriter}[suffix](fps=count / film.seconds)
        with writer.saving(figure, str(folder / f"film{suffix}"), DOTS):
            for frame in range(count):
                for move in moves:
                    move(frame)
                axes.set_xlabel(f"t = {film.times[frame]:.4g}")
                writer.grab_frame(facecolor="white")
        return (folder / f"film{suffix}").read_bytes()


def artist(axes: "Axes", shape: Shape, numbers: NDArray[np.float64], **look: Any) -> Callable[[int], None]:
    """Add a shape. Return the function that moves it to a frame.

    Parameters
    ----------
    axes : Axes
    shape : Shape
    numbers : ndarray, shape (k, numbers of the shape)
        Numbers at each frame, as in `Film`.
    **look : object
        Properties of Matplotlib's lines, in place of those of the shape.

    Returns
    -------
    callable
    """
    if shape is Shape.CIRCLE:
        from matplotlib.patches import Circle

        circle: Artist = axes.add_patch(Circle((0, 0), 1, fill=False, **({"color": BLUE} | look)))

        def move_circle(frame: int) -> None:
            circle.set(center=numbers[frame, :2], radius=abs(numbers[frame, 2]))

        return move_circle
    usual = {"marker": "o", "color": VERMILION} if shape is Shape.POINT else {"color": BLUE}
    (line,) = axes.plot([], [], **(usual | look))

    def move_line(frame: int) -> None:
        line.set_data(numbers[frame, ::2], numbers[frame, 1::2])

    return move_line


FORMATS: Mapping[str, Callable[[Film], str | bytes]] = {
    ".svg": animation,
    ".html": _page,
    ".gif": partial(_frames, suffix=".gif"),
    ".mp4": partial(_frames, suffix=".mp4"),
}
