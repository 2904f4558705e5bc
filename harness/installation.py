"""Installed and missing components, and the library in Maxima's search path."""

import os
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from .documents import ask
from .extras import USERS_EXTRAS, requirements, version_of
from .failures import ErrorKind, HolonomError
from .files import shared, write_files, write_whole, written_before
from .formats import Document, read
from .maxima import LIBRARY
from .preloaded import quoted
from .reference.maxima_help import help_files
from .sandbox import has_sandbox
from .structs import entry

# Names of the system's packages, by the command that installs them.
INSTALLERS = {
    "apt-get": ("apt-get install", {"maxima": "maxima maxima-share", "cc": "gcc libc6-dev"}),
    "dnf": ("dnf install", {"maxima": "maxima", "cc": "gcc"}),
    "pacman": ("pacman -S", {"maxima": "maxima", "cc": "gcc"}),
    "brew": ("brew install", {"maxima": "maxima", "cc": "gcc"}),
}
PROGRAMS = {
    "maxima": "everything: it derives the equations",
    "cc": "compiled programs, --to fmu, the Runge-Kutta engine",
    "bwrap": "the sandbox of scene files",
}
ALLOW = "allow bubblewrap to make user namespaces, which this machine forbids"
NEEDED = "maxima"


@dataclass(frozen=True)
class Component:
    """A program or package that Holonom uses."""

    name: str = entry("A program of the system or a Python package.")
    version: str | None = entry("null if it is missing or does not run, empty if it prints none.")
    purpose: str = entry("Purpose.")
    needed: bool = entry("Nothing works without it.")
    hint: str = entry("The command that installs it, or what else is to be done.")


@dataclass(frozen=True)
class Installation:
    """Installed and missing components."""

    components: tuple[Component, ...] = entry("All that Holonom uses.")


@dataclass(frozen=True)
class MaximaVersions:
    """Versions of Maxima and its Lisp."""

    maxima: str = entry("Maxima's version.")
    lisp: str = entry("The Lisp that it runs on.")
    lisp_version: str = entry("That Lisp's version.")


def components() -> Iterator[Component]:
    """Yield all components, programs of the system first.

    Yields
    ------
    Component
    """
    for program, purpose in PROGRAMS.items():
        version = None if shutil.which(program) is None else ""
        hint = _install_program(program)
        if program == "maxima" and version is not None:
            version = _maxima_version()
        elif program == "bwrap" and version is not None and (hindrance := _hindrance_of_sandbox()):
            version, hint = None, hindrance
        yield Component(program, version, purpose, program == NEEDED, hint)
    for package, extra in requirements():
        if extra is None:
            yield Component(package, version_of(package), "the core", True, "pip install holonom")
        elif extra in USERS_EXTRAS:
            yield Component(package, version_of(package), extra, False, f"pip install 'holonom[{extra}]'")


def _hindrance_of_sandbox() -> str:
    """Return the hint to make bubblewrap work, empty if it works."""
    try:
        return "" if has_sandbox() else ALLOW
    except HolonomError as error:
        return str(error)


def _maxima_version() -> str | None:
    """Return the versions of Maxima and its Lisp."""
    try:
        found = read(Document.VERSIONS, ask(Document.VERSIONS, LIBRARY / "holonom.mac"), MaximaVersions)
    except HolonomError:
        return None
    return f"{found.maxima} on {found.lisp} {found.lisp_version}"


def versions() -> dict[str, str]:
    """Return the versions that affect Holonom's results.

    Returns
    -------
    dict of str to str
        By name. ``not installed`` for a missing component.
    """
    packages = {name: version_of(name.lower()) for name in ("heyoka", "SymPy")}
    found = {"holonom": version_of("holonom"), "Maxima": _maxima_version(), **packages}
    return {name: version or "not installed" for name, version in found.items()}


def _install_program(program: str) -> str:
    for installer, (command, packages) in INSTALLERS.items():
        if shutil.which(installer):
            return f"{command} {packages.get(program, 'bubblewrap')}"
    return f"install {program} with the package manager of your system"


STUB = "holonom.mac"
HELP = "holonom"
MARK = "/* Holonom, put here by `holonom maxima-path`, which puts it here anew when the library has moved. */"


def user_directory() -> Path:
    """Return the directory that Maxima calls maxima_userdir.

    Returns
    -------
    Path
        An absolute path. It may not exist.
    """
    named = os.environ.get("MAXIMA_USERDIR")
    return Path(named or Path.home() / ".maxima").absolute()


def put_into_maxima(directory: Path) -> Path:
    """Install the library and its help in a directory that Maxima searches.

    Parameters
    ----------
    directory : Path
        A directory that Maxima searches. It is created if it is missing.

    Returns
    -------
    Path
        The file that ``load(holonom)`` loads.

    Raises
    ------
    HolonomError
        The directory has a file of such a name that is not Holonom's, or cannot be written to.
    """
    stub, helping, files = directory / STUB, directory / HELP, help_files()
    if stub.exists() and not _is_own(stub):
        raise HolonomError(ErrorKind.UNRELATED_IN_MAXIMA, detail=str(stub))
    for name in files.keys() - written_before(helping):
        if (helping / name).exists():
            raise HolonomError(ErrorKind.UNRELATED_IN_MAXIMA, detail=str(helping / name))
    write_files(helping, files)
    write_whole(stub, _stub_text(shared("maxima"), helping))
    return stub


def _stub_text(library: Path, helping: Path) -> str:
    """Return the Maxima file that loads the library and its help."""
    return (
        f"{MARK}\n\n"
        f"load({quoted(library / 'holonom.mac')})$\n"
        f"load({quoted(library / 'help.lisp')})$\n"
        f"?holonom\\-help({quoted(f'{helping}/')})$\n"
    )


def _is_own(stub: Path) -> bool:
    try:
        return stub.read_bytes().startswith(MARK.encode())
    except OSError:
        return False
