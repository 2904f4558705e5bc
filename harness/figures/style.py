"""Style of all figures: reproducible SVG with text, for light and dark pages.

    with figure_style():
        figure = new_figure(9, 4)
        left, right = figure.subplots(1, 2)
        left.plot(times, values, color=BLUE, label="...")
    write_figure(figure, Path("build/motion.svg"))

Axes, text and grid are drawn in `INK`, which is replaced by the reader's text colour: dark on a light page, light on
a dark one, inside an <img> as well as inside a page. The background is transparent. Colours are those of Okabe and
Ito that are visible on both and distinct with any colour vision. Markers and line styles must repeat the distinction.

References
----------
Okabe & Ito, Color Universal Design (2008).
"""

import io
import re
import unicodedata
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from ..extras import missing_package
from ..failures import ErrorKind, HolonomError
from ..files import write_whole
from ..hidden import visible
from ..language import spoken

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BLUE, VERMILION, GREEN = "#0072b2", "#d55e00", "#009e73"
ORANGE, SKY, PURPLE = "#e69f00", "#56b4e9", "#cc79a7"
PALETTE = (BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY)
MARKERS = ("o", "s", "^", "D", "v", "P")
LINES = ("-", "--", "-.", ":")
RATE, NUMBERED = re.compile(r"(d{1,3})ot\((.+)\)"), re.compile(r"(.*?)(\d*)", re.DOTALL)
DOTS = {"d": "\N{COMBINING DOT ABOVE}", "dd": "\N{COMBINING DIAERESIS}", "ddd": "\N{COMBINING THREE DOTS ABOVE}"}
LOWERED = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
DOLLAR = re.compile(r"(?<!\\)\$")
INK = "#1f2328"
INK_ON_DARK = "#d1d7e0"

SETTINGS = {
    "axes.edgecolor": INK,
    "axes.grid": True,
    "axes.labelcolor": INK,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlecolor": INK,
    "axes.titlelocation": "left",
    "axes.titlesize": "medium",
    "errorbar.capsize": 3.0,
    "figure.facecolor": "none",
    "axes.facecolor": "none",
    "font.family": "sans-serif",
    "grid.alpha": 0.15,
    "grid.color": INK,
    "legend.frameon": False,
    "lines.linewidth": 1.6,
    "lines.markersize": 5.0,
    "savefig.facecolor": "none",
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
}
LATIN = "DejaVu Sans"
OPEN_FONTS = {"zh": ("Noto Sans CJK SC", "Source Han Sans SC", "WenQuanYi Micro Hei", "Droid Sans Fallback")}
"""Open fonts for the letters of a language that the first has not; the first that is installed is taken."""
WRITING = {"svg.fonttype": "none", "svg.hashsalt": "holonom"}
INK_RULE = f"svg{{color:{INK}}}@media(prefers-color-scheme:dark){{svg{{color:{INK_ON_DARK}}}}}"
COLOUR_OF_INK = f"<style>{INK_RULE}</style>"


@contextmanager
def figure_style() -> Iterator[None]:
    """Apply this style inside the block, and restore Matplotlib's settings after it.

    Yields
    ------
    None

    Raises
    ------
    HolonomError
        Matplotlib is not installed.
    """
    matplotlib = _import_matplotlib()
    with matplotlib.rc_context(), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing", UserWarning)  # the reader may have the font
        default = {name: value for name, value in matplotlib.rcParamsDefault.items() if name != "backend"}
        matplotlib.rcParams.update({**default, **SETTINGS, "font.sans-serif": _fonts()})  # no backend, so no pyplot
        matplotlib.rcParams["axes.prop_cycle"] = matplotlib.cycler(color=PALETTE)
        yield


def _fonts() -> list[str]:
    """Return the fonts of labels in the current language."""
    wanted = OPEN_FONTS.get(spoken(), ())
    if not wanted:
        return [LATIN]
    from matplotlib.font_manager import fontManager

    installed = {font.name for font in fontManager.ttflist}
    return [LATIN, *[font for font in wanted if font in installed][:1]]


def new_figure(width: float, height: float) -> "Figure":
    """Return an empty figure without window or global state.

    Panels do not overlap.

    Parameters
    ----------
    width : float
        In inches.
    height : float
        In inches.

    Returns
    -------
    Figure

    Raises
    ------
    HolonomError
        Matplotlib is not installed.
    """
    _import_matplotlib()
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def legend_above(axes: "Axes") -> None:
    """Put the legend of a panel above it, where it covers no data.

    Parameters
    ----------
    axes : Axes
        Panel whose curves have labels.
    """
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, borderaxespad=0.2)


def with_symbols(name: str) -> str:
    """Return the name of a quantity in symbols: λ₁ for lambda1, φ̇ for dot(phi).

    Parameters
    ----------
    name : str
        ASCII name of a quantity.

    Returns
    -------
    str
    """
    if rate := RATE.fullmatch(name):
        letter, *rest = with_symbols(rate[2])
        return letter + DOTS[rate[1]] + "".join(rest)
    stem, number = NUMBERED.fullmatch(name).groups()
    return _in_greek(stem) + number.translate(LOWERED)


def _in_greek(name: str) -> str:
    """Return the Greek letter of that name, or the name."""
    case = "SMALL" if name.islower() else "CAPITAL"
    try:
        return unicodedata.lookup(f"GREEK {case} LETTER {name.lower().replace('lambda', 'lamda')}")
    except KeyError:
        return name


def write_figure(figure: "Figure", path: Path) -> None:
    """Write a figure as SVG, or as PNG on white if the suffix is .png.

    The file appears complete or not at all.

    Parameters
    ----------
    figure : Figure
        The figure to write.
    path : Path
        The file. Its content is replaced. The same figure gives the same bytes.

    Raises
    ------
    HolonomError
        The file cannot be written.
    """
    write_whole(path, _png(figure) if path.suffix == ".png" else svg_text(figure))


class Picture:
    """A figure for notebooks and files."""

    def __init__(self, figure: "Figure") -> None:
        self.figure = figure

    def save(self, path: str | Path) -> None:
        """Write the figure as SVG or PNG, by the suffix of the name.

        Parameters
        ----------
        path : str or Path
            File to write. The suffix .png selects PNG, any other SVG.

        Raises
        ------
        HolonomError
            The file cannot be written.
        """
        with figure_style():
            write_figure(self.figure, Path(path))

    def _repr_svg_(self) -> str:
        with figure_style():
            return svg_text(self.figure)


def svg_text(figure: "Figure") -> str:
    """Return a figure as the text of an SVG document, its ink the reader's.

    Parameters
    ----------
    figure : Figure
        Drawn in `figure_style`.

    Returns
    -------
    str
        SVG document.
    """
    buffer = io.StringIO()
    _take_text_for_text(figure)
    with _import_matplotlib().rc_context(WRITING):
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": "Holonom"})
    head, defs, rest = visible(buffer.getvalue()).partition("<defs>")
    lines = (line.rstrip() for line in (head + COLOUR_OF_INK + defs + rest.replace(INK, "currentColor")).splitlines())
    return "\n".join(lines) + "\n"


def _png(figure: "Figure") -> bytes:
    buffer = io.BytesIO()
    _take_text_for_text(figure)
    figure.savefig(buffer, format="png", facecolor="white", metadata={"Software": "Holonom"})
    return buffer.getvalue()


def _take_text_for_text(figure: "Figure") -> None:
    """Escape dollar signs in titles and labels, which Matplotlib reads as formulas."""
    from matplotlib.text import Text

    for written in figure.findobj(Text):
        written.set_text(DOLLAR.sub(r"\\$", visible(written.get_text())))


def _import_matplotlib() -> ModuleType:
    """Return Matplotlib."""
    try:
        import matplotlib
    except ImportError:
        raise missing_package("matplotlib") from None
    except UnicodeDecodeError as error:  # in the settings that it finds in the working directory, or at home
        place, byte = "matplotlibrc", error.object[error.start]
        raise HolonomError(ErrorKind.NOT_UTF8, place, f"0x{byte:02x}") from None
    return matplotlib
