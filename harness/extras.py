"""Packages of the extras: which extra installs a package, and the refusal to go on without one."""

import re
from collections.abc import Iterator
from contextlib import contextmanager

from .failures import Failure, HolonomError

REQUIREMENT = re.compile(r"(?P<package>[\w.-]+)[^;]*(?:;.*extra\s*==\s*['\"](?P<extra>\w+)['\"])?")
NO_ROOM = ("failed to map segment", "annot allocate memory")  # what the loader of libraries says


def extra_of(package: str) -> str | None:
    """Return the extra that installs a package; None where none does."""
    from importlib import metadata  # takes longer to import than all else here

    found = (REQUIREMENT.match(requirement) for requirement in metadata.requires("holonom") or ())
    return next((each["extra"] for each in found if each["package"].lower() == package.lower()), None)


def missing_package(package: str) -> HolonomError:
    """Return the refusal to go on without a package, with the command that installs the extra that it belongs to."""
    extra = extra_of(package)
    named = f"holonom[{extra}]" if extra else package
    return HolonomError(Failure.EXTRA_MISSING, detail=f"{package}, which is not installed; run `pip install '{named}'`")


def require_room(error: ImportError) -> None:
    """Tell a package that memory was too short to load from one that is not there.

    Raises
    ------
    MemoryError
        It was.
    """
    if any(sign in str(error) for sign in NO_ROOM):
        raise MemoryError(str(error)) from error


@contextmanager
def naming_the_extra() -> Iterator[None]:
    """Around what needs the packages of an extra, also as a decorator: where one is missing, say which and the remedy.

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
