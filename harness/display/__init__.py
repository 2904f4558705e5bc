"""Tables: of results on the console, in notebooks and at the Python prompt."""

from typing import TYPE_CHECKING

from ..shown import Shown

if TYPE_CHECKING:
    from rich.console import Console


def show(console: "Console", result: Shown) -> None:
    """Print the table of a result.

    Parameters
    ----------
    console : Console
        Console to print on.
    result : Shown
        A result of one of the kinds listed in the function.
    """
    match type(result).__name__:
        case "Branches":
            from .stability import show_branches as table
        case "CheckReport":
            from .derivation import show_verdicts as table
        case "Equilibria":
            from .stability import show_equilibria as table
        case "FreeMotion":
            from .free_motion import show_free_motion as table
        case "Linearization":
            from .stability import show_linearization as table
        case "LinearizedMotion":
            from .stability import show_linearized_motion as table
        case "MeasuredCosts":
            from .measurements import show_costs as table
        case "MotionSeries":
            from .motion import show_series as table
        case "Simulation":
            from .motion import show_simulation as table
    table(console, result)


def _as_text(result: Shown) -> str:
    from .text import text_of

    return text_of(lambda console: show(console, result))


def _as_html(result: Shown) -> str:
    from .text import html_of

    return html_of(lambda console: show(console, result))


Shown.as_text, Shown.as_html = _as_text, _as_html
