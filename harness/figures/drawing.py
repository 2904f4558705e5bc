"""Draw a system in motion, as an animated SVG or as a strip of positions.

    film = film_of(simulation, drawing)
    animation(film), strip(film)        # SVG, in the reader's ink like all figures

The animation needs no script. The strip shows positions at several times, later ones more strongly. Both show the
scale and the time at the foot. Fixed parts, such as a hinge or a rail, are drawn in ink. Moving parts are drawn in
colour, and bodies leave a trace.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from numpy.typing import NDArray

from ..described import Shape
from ..hidden import visible
from ..language import gettext
from ..program.drawing import Drawing
from .style import BLUE, INK_RULE, VERMILION

if TYPE_CHECKING:
    from ..simulation.result import Simulation

FRAMES = 180  # at most
ROUNDS = 6.0  # a film ends when a body has gone this many times through the whole picture
SHORTEST, LONGEST = 4.0, 12.0  # seconds that a film takes
POSITIONS = 9  # in a strip
FAINTEST = 0.12  # opacity of the first of them
TALL = 0.45  # width by height below which the positions stand side by side
FLAT = 0.15  # height by width below which they stand in a column
WIDTH, HIGHEST, HIGHEST_IN_ROW, LOWEST, MARGIN, FOOT = 520.0, 400.0, 220.0, 24.0, 16.0, 48.0  # pixels
BODY, HINGE = 5.0, 3.5  # radii, pixels
STEADY = 1e-9  # of the picture: what moves less does not move
STILL = {"class": "fixed"}
STYLE = (
    f"{INK_RULE}svg{{font:18px 'DejaVu Sans',sans-serif}}"
    "line,polyline,circle{fill:none;stroke:currentColor;stroke-width:1.5;stroke-linejoin:round;stroke-linecap:round}"
    "text{fill:currentColor}"
    f".rod{{stroke:{BLUE};stroke-width:2.5}}.body{{fill:{VERMILION};stroke:none}}"
    f".trace{{stroke:{VERMILION};stroke-width:1;opacity:.7}}.hinge{{stroke-width:2}}"
    ".fixed{opacity:.7}.fixed .rod{stroke:currentColor;stroke-width:1.5}"
)


@dataclass(frozen=True)
class Film:
    """The shapes of a drawing at the times of a motion."""

    title: str
    times: NDArray[np.float64]  # shape (k,): equidistant
    shapes: tuple[Shape, ...]
    # shape (k, numbers of the shape): as `Drawing.numbers`, nan from the frame on at which a shape has vanished
    numbers: tuple[NDArray[np.float64], ...]

    @property
    def span(self) -> float:
        """Time from the first to the last frame."""
        return float(self.times[-1] - self.times[0])

    @property
    def seconds(self) -> float:
        """Duration of the film in seconds."""
        return min(max(self.span, SHORTEST), LONGEST)

    @property
    def pace(self) -> float:
        """Time of the motion that passes in a second of the film."""
        return self.span / self.seconds

    def parts(self) -> Iterator[tuple[Shape, NDArray[np.float64], bool]]:
        """Yield each shape with its numbers and its mobility.

        Yields
        ------
        shape : Shape
        numbers : ndarray, shape (k, numbers of the shape)
            As in `Film`.
        moves : bool
            True if the shape moves by more than rounding.
        """
        least = STEADY * max(map(np.ptp, extents(self.shapes, self.numbers)))
        for shape, numbers in zip(self.shapes, self.numbers, strict=True):
            yield shape, numbers, bool((np.nanmax(numbers, axis=0) - np.nanmin(numbers, axis=0)).max() > least)


def film_of(simulation: "Simulation", drawing: Drawing) -> Film:
    """Return the film of a motion.

    If the motion crosses the picture too often, the film shows its beginning. It has 180 frames at most.

    Parameters
    ----------
    simulation : Simulation
        Its times are many and equidistant. It has the coordinates.
    drawing : Drawing
        Shapes of the system.

    Returns
    -------
    Film
    """
    times = simulation.times.astype(float)
    numbers = drawing.numbers(times, simulation.coordinates)
    last = _last_frame(drawing.shapes, numbers)
    chosen = slice(0, last + 1, math.ceil(last / FRAMES))
    return Film(simulation.title, times[chosen], drawing.shapes, tuple(each[chosen] for each in numbers))


def animation(film: Film) -> str:
    """Return a film as animated SVG in a loop.

    Parameters
    ----------
    film : Film
        Shapes of the system at equidistant times.

    Returns
    -------
    str
        SVG document.
    """
    stage = _Stage(film, HIGHEST)
    stage.draw_traces()
    stage.draw(stage.group(), slice(None), moving=True)
    stage.draw(stage.group(**STILL), slice(1), moving=False)
    stage.draw_foot(range(len(film.times)))
    return stage.text()


def strip(film: Film) -> str:
    """Return a film as a strip of pictures in SVG.

    Positions over each other, side by side if it is tall, in a column if flat.

    Parameters
    ----------
    film : Film
        Shapes of the system at equidistant times.

    Returns
    -------
    str
        SVG document.
    """
    frames = np.unique(np.linspace(0, len(film.times) - 1, POSITIONS).round().astype(int))
    width, height = map(np.ptp, extents(film.shapes, film.numbers))
    arrange = _row if width < TALL * height else _column if height < FLAT * width else _superposition
    stage = arrange(film, frames)
    stage.draw_foot(frames)
    return stage.text()


def _superposition(film: Film, frames: NDArray[np.int_]) -> "_Stage":
    stage = _Stage(film, HIGHEST)
    stage.draw_traces()
    for frame, opacity in zip(frames, _opacities(frames), strict=True):
        stage.draw(stage.group(opacity=f"{opacity:.2f}"), slice(frame, frame + 1), moving=True)
    stage.draw(stage.group(**STILL), slice(1), moving=False)
    return stage


def _row(film: Film, frames: NDArray[np.int_]) -> "_Stage":
    stage = _Stage(film, HIGHEST_IN_ROW, across=len(frames))
    for place, frame in enumerate(frames):
        stage.draw_apart(frame, stage.width * (place - (len(frames) - 1) / 2), 0)
    return stage


def _column(film: Film, frames: NDArray[np.int_]) -> "_Stage":
    stage = _Stage(film, HIGHEST, down=len(frames))
    for place, frame in enumerate(frames):
        stage.draw_apart(frame, 0, stage.height * (place - (len(frames) - 1) / 2))
    return stage


class _Stage:
    """An SVG page with the scale of a film for pictures across and down.

    The y axis points down, as in SVG.

    Attributes
    ----------
    width, height : float
        What each picture may take, in pixels.
    """

    def __init__(self, film: Film, highest: float, across: int = 1, down: int = 1) -> None:
        self.film = film
        (left, right), (low, high) = extents(film.shapes, film.numbers)
        self.width = (WIDTH - 2 * MARGIN) / across
        self.scale = min(self.width / max(right - left, 1e-300), highest / max(high - low, 1e-300))
        self.height = max(LOWEST, self.scale * (high - low)) + (2 * MARGIN if down == 1 else 0)
        self.foot = self.height * down
        self.origin = (WIDTH / 2 - self.scale * (left + right) / 2, self.foot / 2 + self.scale * (low + high) / 2)
        size = {"viewBox": f"0 0 {WIDTH:g} {self.foot + FOOT:.1f}", "width": f"{WIDTH:g}"}
        self.root = Element("svg", {"xmlns": "http://www.w3.org/2000/svg", **size, "role": "img"})
        SubElement(self.root, "title").text = film.title
        SubElement(self.root, "style").text = STYLE

    def group(self, **attributes: str) -> Element:
        return SubElement(self.root, "g", attributes)

    def draw(self, parent: Element, frames: slice, moving: bool) -> None:
        """Draw the moving or the fixed shapes at some frames."""
        for shape, numbers, moves in self.film.parts():
            present = ~np.isnan(numbers[frames, 0])
            if moves is moving and present.any():
                last = numbers[frames][present][-1]
                tag, attributes, columns = self._element(
                    shape, np.where(present[:, None], numbers[frames], last), moves
                )
                if not present.all():
                    columns["visibility"] = np.where(present, "visible", "hidden").tolist()
                _animate(SubElement(parent, tag, attributes), columns, self.film.seconds)

    def draw_apart(self, frame: int, x: float, y: float) -> None:
        """Draw all shapes of a frame, shifted."""
        shift = {"transform": f"translate({x:.1f},{y:.1f})"}
        self.draw(self.group(**shift), slice(frame, frame + 1), moving=True)
        self.draw(self.group(**STILL, **shift), slice(1), moving=False)

    def draw_traces(self) -> None:
        """Draw the trajectory of each body."""
        traces = self.group()
        for shape, numbers, moves in self.film.parts():
            if moves and shape is Shape.POINT:
                way = _places(self._pixels(numbers).ravel())
                SubElement(traces, "polyline", {"class": "trace", "points": way})

    def draw_foot(self, frames: Sequence[int] | NDArray[np.int_]) -> None:
        """Draw the scale, and the time as a line with a moving mark or several marks."""
        level = self.foot + FOOT / 2 - 8
        self._draw_scale(MARGIN + 4, level)
        self._draw_clock(WIDTH / 2, WIDTH - MARGIN - 4, level, frames)

    def text(self) -> str:
        """Return the page as text."""
        return visible(ElementTree.tostring(self.root, encoding="unicode")) + "\n"

    def _element(self, shape: Shape, numbers: NDArray[np.float64], moves: bool) -> tuple[str, dict, dict]:
        """Return tag, attributes and the further attributes of a shape at each frame."""
        match shape:
            case Shape.POINT:
                mark = {"class": "body", "r": f"{BODY}"} if moves else {"class": "hinge", "r": f"{HINGE}"}
                return "circle", mark, _columns(("cx", "cy"), self._pixels(numbers))
            case Shape.CIRCLE:
                pixels = np.column_stack([self._pixels(numbers[:, :2]), self.scale * abs(numbers[:, 2])])
                return "circle", {"class": "rod"}, _columns(("cx", "cy", "r"), pixels)
            case _:
                return "polyline", {"class": "rod"}, {"points": [_places(row) for row in self._pixels(numbers)]}

    def _draw_scale(self, start: float, level: float) -> None:
        length = _round_length(WIDTH / 4 / self.scale)
        end = start + self.scale * length
        bar = self.group()
        way = [start, level - 4, start, level + 4, start, level, end, level, end, level - 4, end, level + 4]
        SubElement(bar, "polyline", {"points": _places(way)})
        _write(bar, start, level + 22, gettext("length %(length)g", length=length), "start")

    def _draw_clock(self, start: float, end: float, level: float, frames: Sequence[int] | NDArray[np.int_]) -> None:
        clock = self.group()
        SubElement(clock, "polyline", {"points": _places([start, level, end, level])})
        places = [f"{start + (end - start) * frame / (len(self.film.times) - 1):.1f}" for frame in frames]
        mark = {"class": "body", "r": "4", "cy": f"{level:.1f}"}
        if len(frames) == len(self.film.times):
            _animate(SubElement(clock, "circle", mark), {"cx": places}, self.film.seconds)
        else:
            for x, opacity in zip(places, _opacities(frames), strict=True):
                SubElement(clock, "circle", {**mark, "cx": x, "opacity": f"{opacity:.2f}"})
        for x, time, anchor in ((start, self.film.times[0], "start"), (end, self.film.times[-1], "end")):
            _write(clock, x, level + 22, f"t = {time:.4g}", anchor)

    def _pixels(self, numbers: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return positions in pixels, x and y by turns."""
        columns = numbers.shape[1]
        return np.resize(self.origin, columns) + numbers * np.resize([self.scale, -self.scale], columns)


def _animate(element: Element, frames: dict[str, list[str]], seconds: float) -> None:
    """Give an element the attributes of the first frame, and animate the others."""
    for name, texts in frames.items():
        element.set(name, texts[0])
        if len(texts) > 1:
            run = {"dur": f"{seconds:.3g}s", "repeatCount": "indefinite"}
            SubElement(element, "animate", {"attributeName": name, "values": ";".join(texts), **run})


def _columns(names: Iterable[str], pixels: NDArray[np.float64]) -> dict[str, list[str]]:
    return {name: [f"{x:.1f}" for x in column] for name, column in zip(names, pixels.T, strict=True)}


def _opacities(frames: Sequence[int] | NDArray[np.int_]) -> NDArray[np.float64]:
    return np.linspace(FAINTEST, 1, len(frames))


def _write(parent: Element, x: float, y: float, text: str, anchor: str) -> None:
    SubElement(parent, "text", {"x": f"{x:.1f}", "y": f"{y:.1f}", "text-anchor": anchor}).text = text


def _places(pixels: Iterable[float]) -> str:
    numbers = [f"{x:.1f}" for x in pixels]
    return " ".join(map(",".join, zip(numbers[::2], numbers[1::2], strict=True)))


def _round_length(longest: float) -> float:
    """Return the largest of 1, 2 or 5 times a power of ten up to a length."""
    power = 10.0 ** math.floor(math.log10(longest))
    return next(digit * power for digit in (5, 2, 1) if digit * power <= longest)


def extents(shapes: Sequence[Shape], numbers: Sequence[NDArray[np.float64]]) -> list[NDArray[np.float64]]:
    """Return least and greatest x, least and greatest y.

    Parameters
    ----------
    shapes : sequence of Shape
        Kinds of the shapes.
    numbers : sequence of ndarray, shape (k, numbers of the shape)
        Numbers of each shape, as in `Film`.

    Returns
    -------
    list of ndarray, shape (2,)
        Least and greatest x, then least and greatest y.
    """
    return [
        np.array([min(np.nanmin(low) for low, _ in sides), max(np.nanmax(high) for _, high in sides)])
        for sides in ([_sides(shape, row, axis) for shape, row in zip(shapes, numbers, strict=True)] for axis in (0, 1))
    ]


def _sides(shape: Shape, numbers: NDArray[np.float64], axis: int) -> tuple[NDArray, NDArray]:
    if shape is Shape.CIRCLE:
        return numbers[:, axis] - abs(numbers[:, 2]), numbers[:, axis] + abs(numbers[:, 2])
    return numbers[:, axis::2], numbers[:, axis::2]


def _last_frame(shapes: Sequence[Shape], numbers: Sequence[NDArray[np.float64]]) -> int:
    """Return the last frame of the film.

    It is earlier than the end if a body has crossed the picture too often.
    """
    places = [row[:, :2] if shape is Shape.CIRCLE else row for shape, row in zip(shapes, numbers, strict=True)]
    xy = np.concatenate([row.reshape(len(row), -1, 2) for row in places], axis=1)
    gone = np.nancumsum(np.linalg.norm(np.diff(xy, axis=0), axis=2), axis=0).max(axis=1)
    highest, lowest = (each.accumulate(each.reduce(xy, axis=1), axis=0) for each in (np.fmax, np.fmin))
    reach = (highest - lowest).max(axis=1)[1:]
    often = np.flatnonzero(gone > ROUNDS * reach)
    return int(often[0]) + 1 if len(often) else len(xy) - 1
