"""Motion programs compiled by the system's C compiler."""

import ctypes
import os
import shlex
import shutil
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..failures import ErrorKind, HolonomError
from ..language import translatable
from ..sandbox import LimitExceeded, Limits, Place, Sandbox, run_process
from ..supervisor import doing
from ..temporary import private_directory
from .c_source import c_source
from .motion_program import Program

COMPILERS = ("cc", "gcc", "clang")
# Not less than -O2: below it GCC leaves the upper halves of vector registers in use, and code without AVX that runs
# afterwards waits for them again and again: it took 2 to 8 times as long.
OPTIONS = ("-std=c99", "-O2", "-ffp-contract=fast", "-shared", "-fPIC")
NATIVE = "-march=native"  # for the processor at hand; compilers for some kinds of processors know no such option
COMPILER_LIMITS = Limits(sandbox=Sandbox.TRUSTED)
SHOWN = 200  # characters of a compiler's message
POINTERS = (ctypes.c_void_p, ctypes.c_void_p)


class CFunction:
    """A motion program in a shared object.

    Parameters
    ----------
    library : ctypes.CDLL
        Holds ``motion`` and ``motion_batch``.
    """

    def __init__(self, program: Program, library: ctypes.CDLL) -> None:
        self.inputs = program.inputs
        self.outputs = tuple(program.outputs)
        self.one, self.many = library.motion, library.motion_batch
        self.one.argtypes, self.one.restype = POINTERS, None
        self.many.argtypes, self.many.restype = (ctypes.c_size_t, *POINTERS), None

    def __call__(self, inputs: ArrayLike) -> NDArray[np.float64]:
        """Evaluate the program.

        Parameters
        ----------
        inputs : array_like, shape (inputs,) or (inputs, points)
            Inputs of the program in its order.

        Returns
        -------
        ndarray, shape (outputs,) or (outputs, points)
            Where the program's pivots vanish, infinities and nans.

        Raises
        ------
        ValueError
            The inputs have another shape.
        """
        given = np.ascontiguousarray(inputs, dtype=float)
        if given.ndim not in (1, 2) or len(given) != len(self.inputs):
            raise ValueError(f"shape ({len(self.inputs)},) or ({len(self.inputs)}, points) needed, not {given.shape}")
        result = np.empty((len(self.outputs), *given.shape[1:]))
        if given.ndim == 1:
            self.one(given.ctypes.data, result.ctypes.data)
        else:
            self.many(given.shape[1], given.ctypes.data, result.ctypes.data)
        return result


def compile_c(program: Program) -> CFunction:
    """Compile a program with the system's C compiler and load it.

    Parameters
    ----------
    program : Program

    Returns
    -------
    CFunction

    Raises
    ------
    HolonomError
        There is no C compiler, or it rejects the source.
    """
    return CFunction(program, load_c(c_source(program)))


def load_c(source: str, *options: str) -> ctypes.CDLL:
    """Compile C99 source into a shared object and load it.

    The object is written to a private directory. It stays usable when the directory is removed.

    Parameters
    ----------
    source : str
        Source text in C99.
    *options : str
        Further options of the compiler.

    Returns
    -------
    CDLL

    Raises
    ------
    HolonomError
        As `compile_c`.
    """
    with private_directory() as directory:
        source_file, library = directory / "motion.c", directory / "motion.so"
        source_file.write_text(source, encoding="utf-8")
        try:
            compile_shared([source_file], library, NATIVE, *OPTIONS, *options)
        except HolonomError as refused:
            if refused.kind is not ErrorKind.COMPILER_REFUSED:
                raise
            compile_shared([source_file], library, *OPTIONS, *options)
        try:
            return ctypes.CDLL(str(library))
        except OSError as error:
            raise HolonomError(
                ErrorKind.COMPILER_UNUSABLE, detail=translatable("it made no library; %(reason)s", reason=error)
            ) from None


def unload(library: ctypes.CDLL) -> None:
    """Close a library whose functions and numbers are not used any more.

    Parameters
    ----------
    library : CDLL
        Library from `load_c`.
    """
    close = ctypes.CDLL(None).dlclose
    close.argtypes = (ctypes.c_void_p,)
    close(library._handle)


def compile_shared(sources: Sequence[Path], library: Path, *options: str) -> None:
    """Compile C sources into a shared object.

    Parameters
    ----------
    sources : sequence of Path
        Files in C.
    library : Path
        Shared object to write.
    *options : str
        Options of the compiler.

    Raises
    ------
    HolonomError
        As `compile_c`.
    """
    command = [*_compiler(), *map(str, sources), "-o", str(library), *options, "-lm"]
    messages = bytearray()
    try:
        with doing("compiling C"):
            status = run_process(command, Place(library.parent, os.environ, COMPILER_LIMITS), messages)
    except LimitExceeded as exceeded:
        raise HolonomError(
            ErrorKind.COMPILER_UNUSABLE,
            detail=translatable("%(command)s took more than %(limit)s", command=command[0], limit=exceeded.detail),
        ) from None
    except OSError as error:
        raise HolonomError(ErrorKind.COMPILER_UNUSABLE, detail=f"{command[0]}: {error.strerror}") from None
    if status != 0:
        shown = " ".join(messages.decode(errors="replace").split())[:SHOWN]
        raise HolonomError(
            ErrorKind.COMPILER_REFUSED, detail=shown or translatable("exit status %(status)s", status=status)
        )
    if not library.exists():
        raise HolonomError(
            ErrorKind.COMPILER_UNUSABLE, detail=translatable("%(command)s made no library", command=command[0])
        )


def has_compiler() -> bool:
    """Return True if there is a C compiler.

    Returns
    -------
    bool
    """
    with suppress(HolonomError):
        return bool(_compiler())
    return False


def _compiler() -> list[str]:
    """Return the compiler's command: the value of CC, or the first installed one."""
    if named := os.environ.get("CC"):
        command = _words(named)
        found = shutil.which(command[0])
    else:
        command = [""]
        found = next(filter(None, map(shutil.which, COMPILERS)), None)
    if found is None:
        raise HolonomError(ErrorKind.COMPILER_MISSING)
    return [found, *command[1:]]


def _words(command: str) -> list[str]:
    try:
        words = shlex.split(command)
    except ValueError:
        words = []
    if not words:
        raise HolonomError(ErrorKind.COMPILER_UNUSABLE, detail=translatable("CC is '%(command)s'", command=command))
    return words
