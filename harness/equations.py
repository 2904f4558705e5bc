"""Equations of a scene, by their place, the equation number or their id."""

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, overload

from .failures import HolonomError

if TYPE_CHECKING:
    from .record import Equation


class Equations(Sequence["Equation"]):
    """Equations in the paper's order, which a notebook typesets.

    ``equations[0]`` is the first. ``equations["8"]`` are those with the number (8), and
    ``equations["multipliers"]`` the one with that id.

    Examples
    --------
    >>> scene.equations[0].id
    'constraints'
    """

    def __init__(self, equations: Iterable["Equation"]) -> None:
        self._equations = tuple(equations)

    def __len__(self) -> int:
        return len(self._equations)

    @overload
    def __getitem__(self, key: int) -> "Equation": ...
    @overload
    def __getitem__(self, key: str | slice) -> "Equations": ...
    def __getitem__(self, key: int | str | slice) -> "Equation | Equations":
        if isinstance(key, int):
            return self._equations[key]
        if isinstance(key, slice):
            return Equations(self._equations[key])
        found = [equation for equation in self._equations if key in (equation.id, equation.number)]
        if not found:
            raise KeyError(f"no equation has the number or id {key!r}; there are {', '.join(self.titles())}")
        return Equations(found)

    def titles(self) -> Iterator[str]:
        """Return number, id and name of each equation.

        Returns
        -------
        iterator of str
        """
        return (f"({equation.number}) {equation.id}: {equation.name}" for equation in self._equations)

    def solved_for(self, name: str) -> Any:
        """Return the right side for a quantity on the left side, in SymPy.

        Of several, it is the first without multipliers: (11) for an acceleration, not (4).

        Parameters
        ----------
        name : str
            Name of the quantity, such as ``ddot(x)``.

        Returns
        -------
        SymPy expression

        Raises
        ------
        KeyError
            There is none.
        """
        from .typeset.notebook import TypesetSymbol

        relations = [(equation.id, relation) for equation in self._equations for relation in equation.relations]
        multipliers = {str(relation.left) for id_, relation in relations if id_ == "multipliers"}
        found = [relation.right for _, relation in relations if str(relation.left) == name]
        if not found:
            raise KeyError(name)
        solved = (each for each in found if not multipliers & {str(symbol) for symbol in each.free_symbols})
        expression = next(solved, found[0])
        return expression.xreplace({each: TypesetSymbol(each.name) for each in expression.free_symbols})

    def __repr__(self) -> str:
        return "\n".join(self.titles())

    def _repr_html_(self) -> str | None:
        from .typeset.notebook import equations_html

        try:
            return equations_html(self._equations)
        except HolonomError:  # without latex2mathml the notebook takes the LaTeX
            return None

    def _repr_latex_(self) -> str:
        from .typeset.notebook import equations_latex

        return equations_latex(self._equations)
