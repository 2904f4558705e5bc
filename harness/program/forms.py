"""The motion program of a scene, asked of Maxima, and the forms it can be taken away in."""

from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from ..documents import ask
from ..extras import naming_the_extra
from ..failures import Failure, HolonomError
from ..files import write_files, write_whole
from ..formats import Document
from ..sandbox import Limits
from ..source import Source, source_of
from .identifiers import default_name
from .motion_program import Program, read_program
from .request import Request
from .targets import JSON, target

if TYPE_CHECKING:
    from .c_function import CFunction
    from .numpy_function import NumpyFunction

Written = str | Mapping[str, str] | bytes


class MotionProgram:
    """The motion program of a scene, and the forms in which it can be taken elsewhere."""

    def __init__(self, file: Source | Path, request: Request, limits: Limits) -> None:
        self._source, self._request = source_of(file, limits), request

    @cached_property
    def document(self) -> str:
        """The program as one JSON document."""
        asked = self._request
        return ask(Document.PROGRAM, self._source, asked.scene, asked.solve, settings=asked.settings)

    @cached_property
    def program(self) -> Program:
        """The program as objects."""
        return read_program(self.document)

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of what it takes."""
        return self.program.inputs

    @property
    def outputs(self) -> tuple[str, ...]:
        """Names of what it computes."""
        return tuple(self.program.outputs)

    @property
    def operations(self) -> int:
        """What one evaluation costs."""
        return self.program.operations

    @naming_the_extra()
    def compile(self) -> "CFunction":
        """Return a function of an array (inputs,) or (inputs, points), compiled by the system's C compiler."""
        from .c_function import compile_c

        return compile_c(self.program)

    @naming_the_extra()
    def lambdify(self) -> "NumpyFunction":
        """Return the same function by NumPy alone."""
        from .numpy_function import NumpyFunction

        return NumpyFunction(self.program)

    def to_python(self) -> str:
        """Return a Python module that needs the standard library alone."""
        return self.written("python")

    def to_javascript(self) -> str:
        """Return a script for a page or for Node that needs nothing but Math."""
        return self.written("javascript")

    def to_c(self, directory: str | Path, name: str | None = None, parameters: Sequence[str] = ()) -> None:
        """Write a library in C11, as ``holonom program --to c`` does.

        Parameters
        ----------
        directory : str or Path
            It is made where it is missing.
        name : str or None
            What every public name begins with; None for the file's name.
        parameters : sequence of str
            Those that stay open although the scene gives them values.
        """
        write_files(Path(directory), self.written("c", name, parameters))

    def to_fmu(self, file: str | Path, name: str | None = None, parameters: Sequence[str] = ()) -> None:
        """Write an FMI 3.0 unit for model exchange; otherwise like `to_c`."""
        write_whole(Path(file), self.written("fmu", name, parameters))

    def written(self, form: str, name: str | None = None, parameters: Sequence[str] = ()) -> Written:
        """Return it in a form of `targets.FORMS`: a text, the texts of files by their names, or the bytes of one file.

        Raises
        ------
        HolonomError
            The form is a text, which takes no name and no parameters; or as `to_c`.
        """
        module = None if form == JSON else target(form)
        if hasattr(module, "write_model"):
            from .model import scene_model

            model = scene_model(self._source, self._request, parameters, self._source.limits)
            return module.write_model(model, name or default_name(self._source.file))
        if name or parameters:
            raise HolonomError(Failure.NO_NAME_IN_TEXT, detail=form)
        return self.document if module is None else module.write(self.program)

    def __repr__(self) -> str:
        return (
            f"<MotionProgram of {len(self.inputs)} inputs, {len(self.outputs)} outputs, {self.operations} operations>"
        )
