"""Extras: the extra that installs a package, and the error without it."""

import re
from collections.abc import Iterator
from contextlib import contextmanager

from .failures import ErrorKind, HolonomError

REQUIREMENT = re.compile(r"(?P<package>[\w.-]+)[^;]*(?:;.*extra\s*==\s*['\"](?P<extra>\w+)['\"])?")
NO_ROOM = ("failed to map segment", "annot allocate memory")  # message of the loader of libraries


def extra_of(package: str) -> str | None:
    """Return the extra that installs a package.

    Parameters
    ----------
    package : str
        Name of the package, in upper or lower case.

    Returns
    -------
    str or None
        None if no extra installs it.
    """
    from importlib import metadata  # takes longer to import than all else here

    found = (REQUIREMENT.match(requirement) for requirement in metadata.requires("holonom") or ())
    return next((each["extra"] for each in found if each["package"].lower() == package.lower()), None)


def missing_package(package: str) -> HolonomError:
    """Return the error for a missing package.

    It names the command that installs the package's extra.

    Parameters
    ----------
    package : str
        Name of the package.

    Returns
    -------
    HolonomError
    """
    extra = extra_of(package)
    named = f"holonom[{extra}]" if extra else package
    return HolonomError(
        ErrorKind.EXTRA_MISSING, detail=f"{package}, which is not installed; run `pip install '{named}'`"
    )


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
        if extra_of(package) is None:
            raise
        raise missing_package(package) from None
    except ImportError as error:
        require_room(error)
        raise
