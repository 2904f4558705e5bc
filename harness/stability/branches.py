"""Equilibria over a control: the branches of a bifurcation diagram."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..program.motion_problem import MotionProblem
from ..shown import Shown
from .equilibria import Equilibria, find_equilibria
from .linear_equations import LinearEquations

if TYPE_CHECKING:
    import pandas

    from ..figures.style import Picture


@dataclass(frozen=True, repr=False)
class Branches(Shown):
    """Equilibria that were found for some values of a control, perhaps not all.

    Attributes
    ----------
    control : str
        Name of the control that varies.
    at : tuple of Equilibria
        One for each value, in their order.

    Examples
    --------
    >>> import holonom
    >>> branches = holonom.load("examples/pendulum.mac").branches("u", [1, 2])
    >>> [[each.coordinates["y"] for each in found] for found in branches]
    [[-1.0, 1.0], [-2.0, 2.0]]
    """

    control: str
    at: tuple[Equilibria, ...]

    def __iter__(self) -> Iterator[Equilibria]:
        return iter(self.at)

    def __len__(self) -> int:
        return len(self.at)

    @property
    def values(self) -> list[float]:
        """Values of the control."""
        return [found.controls[self.control] for found in self.at]

    def documents(self) -> list[dict[str, Any]]:
        """Return the content of the JSON document for each value.

        Returns
        -------
        list of dict
        """
        return [found.document() for found in self.at]

    def to_pandas(self) -> "pandas.DataFrame":
        """Return a table with a row for each equilibrium.

        Its columns are controls, coordinates, multipliers and stability.

        Returns
        -------
        pandas.DataFrame
        """
        import pandas

        return pandas.DataFrame(
            {**found.controls, **each.coordinates, **each.multipliers, "stability": str(each.stability)}
            for found in self.at
            for each in found
        )

    def plot(self) -> "Picture":
        """Return a figure of the coordinates over the control.

        Returns
        -------
        Picture

        Raises
        ------
        HolonomError
            Matplotlib is not installed.
        """
        from ..figures.branches import branches_figure
        from ..figures.style import Picture

        return Picture(branches_figure(self))


def find_branches(
    problem: MotionProblem,
    equations: LinearEquations,
    control: str,
    values: Sequence[float],
    controls: Mapping[str, float],
    starts: int,
    seed: int,
) -> Branches:
    """Search for equilibria at each value of a control.

    Those found at one value are starting points at the next.

    Parameters
    ----------
    problem, equations : MotionProblem, LinearEquations
        As for `find_equilibria`.
    control : str
        Name of the control that varies.
    values : sequence of float
        At least one.
    controls : mapping of str to float
        Constant values of the others.
    starts, seed : int
        As for `find_equilibria`.

    Returns
    -------
    Branches

    Raises
    ------
    HolonomError
        As `find_equilibria`.
    """
    at: list[Equilibria] = []
    for value in values:
        near = at[-1].found if at else ()
        at.append(find_equilibria(problem, equations, {**controls, control: value}, starts, seed, near))
    return Branches(control, tuple(at))
