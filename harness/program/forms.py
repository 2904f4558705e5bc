"""The motion program of a scene and its forms in other languages."""

from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from ..documents import ask
from ..extras import naming_the_extra
from ..failures import ErrorKind, HolonomError
from ..files import write_files, write_whole
from ..formats import Document, nothing_collected
from ..language import translatable
from ..sandbox import Limits
from ..source import Source, source_of
from .identifiers import default_name
from .motion_program import Program, read_program
from .request import Request
from .targets import JSON, MODULES, target

if TYPE_CHECKING:
    from .c_function import CFunction
    from .numpy_function import NumpyFunction

Written = str | Mapping[str, str] | bytes


class MotionProgram:
    """Motion program of a scene, in the forms in which it can be written.

    Examples
    --------
    >>> type(scene.program()).__name__
    'MotionProgram'
    """

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
        """Names of the inputs."""
        return self.program.inputs

    @property
    def outputs(self) -> tuple[str, ...]:
        """Names of the outputs."""
        return tuple(self.program.outputs)

    @property
    def operations(self) -> int:
        """Number of operations of one evaluation."""
        return self.program.operations

    @naming_the_extra()
    def compile(self) -> "CFunction":
        """Return a function of arrays (inputs,) or (inputs, points), compiled as C.

        Returns
        -------
        CFunction
            Function with one result for each output.
        """
        from .c_function import compile_c

        return compile_c(self.program)

    @naming_the_extra()
    def lambdify(self) -> "NumpyFunction":
        """Return the function with NumPy only.

        Returns
        -------
        NumpyFunction
            Function with one result for each output.
        """
        from .numpy_function import NumpyFunction

        return NumpyFunction(self.program)

    def to_python(self, module: str | None = None, parameters: Sequence[str] = (), name: str | None = None) -> Written:
        """Return a Python module for the standard library or for another package.

        Parameters
        ----------
        module : str or None
            ``"numpy"``, ``"jax"`` or ``"casadi"``: functions of arrays: the motion, the control law, the time
            derivatives of the state. Without it, a function of numbers with the scene's parameters.
        parameters : sequence of str
            With a module: parameters that stay open although the scene gives them values.
        name : str or None
            With a module: its name, with which those of CasADi's functions begin, or None for the file's name.

        Returns
        -------
        str
            Source text of the module.
        """
        return self.written("python", name, parameters, module)

    def to_matlab(self, parameters: Sequence[str] = (), name: str | None = None) -> Written:
        """Return a function for MATLAB and GNU Octave, for a file of its name.

        Parameters
        ----------
        parameters : sequence of str
            Parameters that stay open although the scene gives them values.
        name : str or None
            Name of the function, or None for the file's name.

        Returns
        -------
        str
            Source text of the function.
        """
        return self.written("matlab", name, parameters)

    def to_javascript(self) -> str:
        """Return a script without dependencies, for a page or for Node.

        Returns
        -------
        str
            Source text of the script.
        """
        return self.written("javascript")

    def to_c(self, directory: str | Path, name: str | None = None, parameters: Sequence[str] = ()) -> None:
        """Write a library in C11, as ``holonom program --to c`` does.

        Parameters
        ----------
        directory : str or Path
            It is made where it is missing.
        name : str or None
            What every public name begins with, or None for the file's name.
        parameters : sequence of str
            Those that stay open although the scene gives them values.
        """
        write_files(Path(directory), self.written("c", name, parameters))

    def to_fmu(self, file: str | Path, name: str | None = None, parameters: Sequence[str] = ()) -> None:
        """Write an FMI 3.0 unit for model exchange, with the arguments of `to_c`.

        Parameters
        ----------
        file : str or Path
            File to write, usually with the suffix ``.fmu``.
        name : str or None
            Name of the model, or None for the file's name.
        parameters : sequence of str
            Parameters that stay open although the scene gives them values.
        """
        write_whole(Path(file), self.written("fmu", name, parameters))

    def written(
        self, form: str, name: str | None = None, parameters: Sequence[str] = (), package: str | None = None
    ) -> Written:
        """Return the program in a form of `targets.FORMS`.

        Parameters
        ----------
        form : str
            Name of the form.
        name : str or None
            Name with which public names begin. None for the file's name.
        parameters : sequence of str
            Parameters that stay open although the scene gives them values.
        package : str or None
            Package of `targets.MODULES` that Python computes with. None for the standard library.

        Returns
        -------
        str, mapping of str to str or bytes
            A text, a mapping of file names to texts, or the bytes of one file.

        Raises
        ------
        HolonomError
            The form is a motion program, which takes no name and no parameters. There is no such package, or the form
            is not Python. Also for the reasons of `to_c`.
        """
        if package and (form != "python" or package not in MODULES):
            raise HolonomError(
                ErrorKind.NO_SUCH_MODULE, detail=translatable("%(package)s with %(form)s", package=package, form=form)
            )
        module = None if form == JSON else target(f"{form}_{package}" if package else form)
        if hasattr(module, "write_model"):
            from .model import scene_model

            model = scene_model(self._source, self._request, parameters, self._source.limits)
            with nothing_collected():
                return module.write_model(model, name or default_name(self._source.file))
        if name or parameters:
            raise HolonomError(ErrorKind.NO_NAME_IN_TEXT, detail=form)
        return self.document if module is None else module.write(self.program)

    def __repr__(self) -> str:
        return (
            f"<MotionProgram of {len(self.inputs)} inputs, {len(self.outputs)} outputs, {self.operations} operations>"
        )
