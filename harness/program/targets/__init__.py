"""Languages of a motion program: each module here is one, by its name.

A module has a function ``write(program)`` that returns a text, or ``write_model(model, name)`` that includes the
scene's initial state, law and constraints and returns a text, the texts of files by their names, or the bytes of one
file. ``python_jax`` is Python for JAX, chosen by the option --module.
"""

from importlib import import_module
from pathlib import Path
from types import ModuleType

JSON = "json"  # the program's own document
_NAMES = sorted(file.stem for file in Path(__file__).parent.glob("[!_]*.py"))
FORMS = (JSON, *(name for name in _NAMES if "_" not in name))
MODULES = tuple(name.removeprefix("python_") for name in _NAMES if "_" in name)


def target(name: str) -> ModuleType:
    """Return the module of a language.

    Parameters
    ----------
    name : str
        Name of a module in this folder.

    Returns
    -------
    ModuleType
    """
    return import_module(f".{name}", __name__)
