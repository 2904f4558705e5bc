"""Extras: the extra that installs a package, and the error without it."""

import re
from collections.abc import Iterator
from contextlib import contextmanager

from .failures import ErrorKind, HolonomError

USERS_EXTRAS = ("motion", "sweep", "companion")  # the others are for those who develop Holonom
REQUIREMENT = re.compile(r"(?P<package>[\w.-]+)[^;]*(?:;.*extra\s*==\s*['\"](?P<extra>\w+)['\"])?")
NO_ROOM = ("failed to map segment", "annot allocate memory")  # message of the loader of libraries


def _extra_of(package: str) -> str | None:
    """Return the extra that installs a package."""
    return next((extra for name, extra in requirements() if name.lower() == package.lower()), None)


def requirements() -> Iterator[tuple[str, str | None]]:
    """Yield each package that Holonom requires, and its extra.

    Yields
    ------
    package : str
    extra : str or None
        None for the core.
    """
    from importlib import metadata  # takes longer to import than all else here

    for requirement in metadata.requires("holonom") or ():
        found = REQUIREMENT.match(requirement)
        yield found["package"], found["extra"]


def version_of(package: str) -> str | None:
    """Return the version of an installed package.

    Parameters
    ----------
    package : str

    Returns
    -------
    str or None
        None if it is not installed.
    """
    from importlib import metadata

    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def missing_package(package: str) -> HolonomError:
    """Return the error for a missing package.

    It names the command that installs the package's extra, and all extras of users that are incomplete.

    Parameters
    ----------
    package : str
        Name of the package.

    Returns
    -------
    HolonomError
    """
    extra = _extra_of(package)
    lacking = {extra, *(other for name, other in requirements() if other in USERS_EXTRAS and version_of(name) is None)}
    named = f"holonom[{','.join(sorted(lacking))}]" if extra else package
    return HolonomError(ErrorKind.EXTRA_MISSING, package=package, named=named)


def require_room(error: ImportError) -> None:
    """Raise if a package is present but memory is too short to load it.

    Parameters
    ----------
    error : ImportError
        Error of the import.

    Raises
    ------
    MemoryError
        There is no room to load it.
    """
    if any(sign in str(error) for sign in NO_ROOM):
        raise MemoryError(str(error)) from error


@contextmanager
def naming_the_extra() -> Iterator[None]:
    """Name the extra in the error if one of its packages is missing.

    This is a context manager and a decorator.

    Yields
    ------
    None

    Raises
    ------
    HolonomError
        A package of an extra is not installed.
    MemoryError
        There is no room to load it.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        package = str(error.name).partition(".")[0]
        if _extra_of(package) is None:
            raise
        raise missing_package(package) from None
    except ImportError as error:
        require_room(error)
        raise
