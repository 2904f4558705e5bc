"""A linearised motion on the console: its eigenvalues and modes."""

from math import pi
from typing import TYPE_CHECKING

from ..hidden import visible_line

if TYPE_CHECKING:
    from rich.console import Console

    from ..stability.linearization import Linearization

ROUNDING = 1e-9  # share of a size that is shown as zero
SHOWN_COORDINATES = 8  # columns for which there is room
MOVING = "The motion goes on from here: these eigenvalues belong to this instant and say nothing about stability."


def show_linearization(console: "Console", found: "Linearization") -> None:
    """Print eigenvalues, frequencies, damping and modes, and what the controls reach."""
    from rich.table import Table

    table = Table("eigenvalue", "frequency", "damping", title=_title(found), title_justify="left")
    shown = found.coordinates[:SHOWN_COORDINATES]
    for name in shown:
        table.add_column(name, justify="right")
    largest = max(map(abs, found.eigenvalues), default=0.0)
    for value, damping, mode in zip(found.eigenvalues, found.damping, found.modes.T, strict=True):
        if value.imag >= 0:  # the conjugate has the conjugate mode
            seen = _rounded(value, largest)
            ratio = f"{damping:.4g}" if seen and seen.real else "0"
            table.add_row(_pair(seen), f"{abs(seen) / (2 * pi):.6g}", ratio, *map(_number, mode[: len(shown)]))
    console.print(table)
    m = len(found.leading)
    console.print(f"{m} degrees of freedom, by {', '.join(found.leading) or 'none'}; {2 * m} eigenvalues.")
    if found.at_rest and found.controls:
        console.print(f"The controls reach {found.controllable_rank} of {2 * m} directions of the state.")
    if not found.at_rest:
        console.print(MOVING)


def _title(found: "Linearization") -> str:
    return f"{visible_line(found.scene)}, linearised at t = {found.at:.10g}; modes by coordinates"


def _rounded(value: complex, size: float) -> complex:
    """The number without parts that are rounding beside a size."""
    real, imaginary = (0.0 if abs(part) <= ROUNDING * size else float(part) for part in (value.real, value.imag))
    return complex(real, imaginary)


def _pair(value: complex) -> str:
    """An eigenvalue; one above the real axis stands for its conjugate, too."""
    if not value.imag:
        return f"{value.real:.6g}"
    return f"{value.real:.6g} ± {value.imag:.6g} i" if value.real else f"± {value.imag:.6g} i"


def _number(value: complex) -> str:
    """An entry of a mode, whose largest is 1."""
    seen = _rounded(value, 1.0)
    if not seen.imag:
        return f"{seen.real:.6g}"
    return f"{seen.real:.6g} {'-' if seen.imag < 0 else '+'} {abs(seen.imag):.6g} i"
