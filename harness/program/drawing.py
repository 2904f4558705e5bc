"""Drawings of a system: shapes in a plane, as a program of time and coordinates.

`maxima/drawing.mac` defines the shapes and their numbers.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ..described import Shape
from ..structs import entry
from .motion_program import Program
from .table import Table

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True)
class Drawing:
    """The drawing of a system."""

    shapes: tuple[Shape, ...] = entry("Shapes of the drawing.")
    program: Program = entry("Program that computes the numbers of the shapes.")
    tables: tuple[Table, ...] = ()  # whose polynomials it takes
    # of shapes, numbered from 1: time after which each is absent
    ends: Mapping[int, float] = field(default_factory=dict)

    def numbers(self, times: "NDArray", coordinates: "Mapping[str, NDArray]") -> "list[NDArray[np.float64]]":
        """Return the numbers of each shape along a motion.

        Parameters
        ----------
        times : ndarray, shape (k,)
            Times, in the scene's unit.
        coordinates : mapping of str to ndarray, shape (k,)
            Value of each coordinate at the times.

        Returns
        -------
        list of ndarray, shape (k, numbers of the shape)
            x and y of its places in their order, then, of a circle, the radius. nan where a shape is absent.
        """
        import numpy as np

        from .numpy_function import NumpyFunction
        from .table_numbers import pieces_of_tables

        known = {"t": times, **coordinates}
        for table, pieces in zip(self.tables, pieces_of_tables(self.tables), strict=True):
            known |= dict(zip(table.inputs, pieces.at(times), strict=True))
        given = [np.asarray(known.get(name, 0.0), dtype=float) for name in self.program.inputs]
        found = dict(zip(self.program.outputs, NumpyFunction(self.program)(given), strict=True))
        return [
            np.where(
                np.asarray(times)[:, None] <= self.ends.get(place, np.inf),
                np.column_stack([values for name, values in found.items() if name.startswith(f"drawing[{place},")]),
                np.nan,
            )
            for place in range(1, len(self.shapes) + 1)
        ]
