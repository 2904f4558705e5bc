"""Texts of programs in other languages, with places to be filled, written @{name}."""

from importlib.resources import files
from string import Template


class _Text(Template):
    """Text in whose languages @ has no meaning."""

    delimiter = "@"


def template(name: str) -> str:
    """Return a file of this folder.

    Parameters
    ----------
    name : str
        Name of the file.

    Returns
    -------
    str
        Its text.
    """
    return files(__name__).joinpath(name).read_text(encoding="utf-8")


def filled(file: str, /, **values: object) -> str:
    """Return a file of this folder with its places filled.

    Parameters
    ----------
    file : str
        Name of the file.
    **values : object
        Value of each place.

    Returns
    -------
    str
        The text.

    Raises
    ------
    KeyError
        A place has no value.
    """
    return _Text(template(file)).substitute(values)
