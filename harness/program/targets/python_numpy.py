"""A scene's model as a Python module for NumPy, over arrays of points."""

from ..model import Model
from ..python_module import Package, module_text
from ..templates import template

USAGE = "Each is an array of a row for each name; t and the rows are numbers, or arrays of points, which are broadcast."
ARRAY = """\
def _array(values):
    return xp.asarray(values, dtype=float)


"""
IN_SPAN = """\
def in_span(t):
    return xp.where((t >= {}) & (t <= {}), t, nan)"""
NUMPY = Package(
    module="numpy",
    usage=USAGE,
    imports="import numpy as xp",
    in_span=IN_SPAN,
    support=ARRAY + template("arrays.py.txt"),
    elsewhere={"erf": "scipy.special"},
)


def write_model(model: Model, name: str) -> str:
    """Write a model as a Python module for NumPy, and SciPy for the error function.

    Parameters
    ----------
    model : Model
    name : str
        Name of the module, for its title.

    Returns
    -------
    str
        Source text.
    """
    return module_text(model, name, NUMPY)
