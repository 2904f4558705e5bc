"""The languages that a motion program is written in: each module here is one, by its name.

A module has a function ``write(program)`` that returns a text; or, where the scene's start, law and constraints go
along, ``write_model(model, name)`` that returns the texts of files by their names, or the bytes of one file.
"""

from importlib import import_module
from pathlib import Path
from types import ModuleType

JSON = "json"  # the program's own document
FORMS = (JSON, *sorted(file.stem for file in Path(__file__).parent.glob("[!_]*.py")))


def target(name: str) -> ModuleType:
    """Return the module of a language."""
    return import_module(f".{name}", __name__)
