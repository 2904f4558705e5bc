"""Equilibria and linearised motions on the console."""

from math import pi
from typing import TYPE_CHECKING

from rich.text import Text

from ..hidden import visible_line
from .text import counted, styled

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rich.console import Console

    from ..stability.along import LinearizedMotion
    from ..stability.branches import Branches
    from ..stability.equilibria import Equilibria, Equilibrium
    from ..stability.linearization import Linearization

ROUNDING = 1e-9  # share of a size that is shown as zero
SHOWN_COORDINATES = 8  # columns for which there is room
MOVING = (
    "The state is not at rest, or the equations contain the time: the eigenvalues are those of this time and of the "
    "coordinates xi, delta q = basis . xi, whose basis may change, too. They do not determine stability."
)


def show_linearization(console: "Console", found: "Linearization") -> None:
    """Print eigenvalues, frequencies, damping, modes, and the controllable rank.

    Parameters
    ----------
    console : Console
        Console to print on.
    found : Linearization
        Linear system about one state.
    """
    from rich.table import Table

    table = Table("eigenvalue", "frequency", "damping", title=_title(found), title_justify="left")
    shown = found.coordinates[:SHOWN_COORDINATES]
    for name in shown:
        table.add_column(name, justify="right")
    largest = max(map(abs, found.eigenvalues), default=0.0)
    columns = found.eigenvalues, found.eigenvalue_errors, found.damping, found.modes.T
    for value, error, damping, mode in zip(*columns, strict=True):
        if abs(value) <= error:
            table.add_row(f"0 (to {abs(value):.1g})" if value else "0", "0", "0", *map(_number, mode[: len(shown)]))
        elif value.imag >= 0:  # the conjugate has the conjugate mode
            seen = _rounded(value, largest)
            ratio = f"{damping:.4g}" if seen and seen.real else "0"
            table.add_row(_pair(seen), f"{abs(seen) / (2 * pi):.6g}", ratio, *map(_number, mode[: len(shown)]))
    if not (m := len(found.leading)):
        console.print(_title(found))
        console.print("No degrees of freedom: the constraints and the controls determine the motion.")
        return
    console.print(table)
    leading = ", ".join(found.leading[:SHOWN_COORDINATES]) + (", ..." if m > SHOWN_COORDINATES else "")
    console.print(f"{counted(m, 'degree')} of freedom, by {leading}; {2 * m} eigenvalues.")
    if found.at_rest and found.controls:
        rank = found.controllable_rank
        how_many = "an unknown number" if rank is None else rank
        console.print(f"The controls reach {how_many} of {2 * m} directions of the state.")
    if not found.at_rest:
        console.print(MOVING)


def show_linearized_motion(console: "Console", along: "LinearizedMotion") -> None:
    """Print the growth of deviations, and verdicts on periodic and on free motions.

    Parameters
    ----------
    console : Console
        Console to print on.
    along : LinearizedMotion
        Linear system along a motion.
    """
    from rich.table import Table

    table = Table("t", "growth", title=visible_line(along.scene), title_justify="left")
    columns = [along.growth]
    if along.free is not None:
        table.add_column("multipliers")
        columns.append(along.free.sizes)
    for t, *row in zip(along.times, *columns, strict=True):
        table.add_row(f"{t:.10g}", *(f"{number:.6g}" for number in row))
    console.print(table)
    console.print("Growth: the longest deviation of all that have length one at the initial time, in the mass metric.")
    states = len(along.transition[0])
    if (free := along.free) is not None:
        console.print(f"The motion is free. {free.staying} of {states} small deviations stay free to first order.")
        if free.stability is not None:
            console.print(Text("Multipliers of the others: ") + styled(free.stability) + Text(", to first order."))
    if along.floquet is not None:
        largest = max(map(abs, along.floquet.multipliers), default=0.0)
        console.print(Text("The motion is periodic: ") + styled(along.floquet.stability) + Text("."))
        multipliers = ", ".join(_number(_rounded(value, largest)) for value in along.floquet.multipliers)
        console.print(f"Characteristic multipliers: {multipliers or 'none'}.")


def show_equilibria(console: "Console", equilibria: "Equilibria") -> None:
    """Print the equilibria, their stability, and the limits of the search.

    Parameters
    ----------
    console : Console
        Console to print on.
    equilibria : Equilibria
        Equilibria for constant controls.
    """
    from rich.table import Table

    title = ", ".join([visible_line(equilibria.scene), *(f"{u} = {x:.10g}" for u, x in equilibria.controls.items())])
    names = list(equilibria.found[0].coordinates)[:SHOWN_COORDINATES] if equilibria.found else []
    table = Table("", *names, "stability", title=title, title_justify="left")
    for each in equilibria:
        kind = styled(each.stability) if each.isolated else styled(each.stability) + Text(", perhaps not isolated")
        table.add_row(each.name, *(f"{each.coordinates[name]:.8g}" for name in names), kind)
    console.print(table)
    for each in equilibria:
        if values := list(_exact_values(each)):
            console.print(f"{each.name} exactly: {', '.join(values)}")
    console.print(_number_of(equilibria))
    if equilibria.more:
        console.print(f"{equilibria.more} more belong to the families of those that are perhaps not isolated.")
    if equilibria.singular:
        starts = f"{equilibria.singular} starts"
        console.print(f"{starts} led to singular configurations or sign changes, which are not classified.")
    if equilibria.turns:
        console.print(f"Whole turns of {', '.join(equilibria.turns)} are left out.")
    for e in equilibria.reversals:
        console.print(f"Of both signs of {', '.join(e)}, one is listed.")
    if equilibria.orientations:
        console.print("No motion changes the orientations: those listed have the ones of the initial state.")


def show_branches(console: "Console", branches: "Branches") -> None:
    """Print the number of equilibria of each stability at each value of the control.

    Parameters
    ----------
    console : Console
        Console to print on.
    branches : Branches
        Equilibria for each value of a control.
    """
    from rich.table import Table

    from ..stability.equilibria import Stability

    there = {each.stability for found in branches for each in found}
    kinds = [kind for kind in Stability if kind in there]
    fixed = [f"{u} = {x:.10g}" for u, x in branches.at[0].controls.items() if u != branches.control]
    table = Table(branches.control, title=", ".join([visible_line(branches.at[0].scene), *fixed]), title_justify="left")
    for kind in kinds:
        table.add_column(styled(kind), justify="right")
    for found in branches:
        counts = (sum(each.stability is kind for each in found) for kind in kinds)
        table.add_row(f"{found.controls[branches.control]:.8g}", *map(str, counts))
    console.print(table)
    if all(found.complete for found in branches):
        console.print("Numbers of equilibria. These are all, at each of these values.")
    else:
        console.print("Numbers of equilibria found; there may be others.")


def _exact_values(equilibrium: "Equilibrium") -> "Iterator[str]":
    """Yield exact values with a short form that the table shows rounded."""
    for name, value in equilibrium.coordinates.items():
        text = str(equilibrium.exact.get(name, ""))
        if text not in ("", f"{value:.8g}") and "CRootOf" not in text:
            yield f"{name} = {text}"


def _number_of(equilibria: "Equilibria") -> str:
    """Return a message on the number of equilibria found, and on their completeness."""
    found = f"{len(equilibria)} found from {equilibria.starts} starts"
    rounded = ", ".join(u for u in equilibria.controls if u not in equilibria.rational)
    rounded = f" for {rounded} as rounded" if rounded else ""
    if equilibria.complete:
        solutions = counted(len(equilibria), "real solution")
        return f"{found}; these are all: the equations have exactly {solutions}{rounded}."
    if equilibria.count is None:
        return f"{found}; there may be others."
    elsewhere = "" if equilibria.regular else ", but places where gradients of the constraints depend are not examined"
    return f"{found}; the equations have exactly {counted(equilibria.count, 'real solution')}{rounded}{elsewhere}."


def _title(found: "Linearization") -> str:
    where = "at an equilibrium" if found.at is None else f"at t = {found.at:.10g}"
    return f"{visible_line(found.scene)}, linearised {where}; modes by coordinates"


def _rounded(value: complex, size: float) -> complex:
    """Return the number without parts that are rounding errors relative to a size."""
    real, imaginary = (0.0 if abs(part) <= ROUNDING * size else float(part) for part in (value.real, value.imag))
    return complex(real, imaginary)


def _pair(value: complex) -> str:
    """Return the text of an eigenvalue, with its conjugate if it is complex."""
    if not value.imag:
        return f"{value.real:.6g}"
    return f"{value.real:.6g} ± {value.imag:.6g} i" if value.real else f"± {value.imag:.6g} i"


def _number(value: complex) -> str:
    """Return an entry of a mode, whose largest is 1."""
    seen = _rounded(value, 1.0)
    if not seen.imag:
        return f"{seen.real:.6g}"
    return f"{seen.real:.6g} {'-' if seen.imag < 0 else '+'} {abs(seen.imag):.6g} i"
