"""A scene's model as a Python module for JAX, in double precision.

The functions are pure, for jit, vmap and grad.
"""

from ..model import Model
from ..python_module import Package, module_text
from ..templates import template
from .python_numpy import IN_SPAN, USAGE

ARRAY = """\
def _array(values):
    array = xp.asarray(values, dtype=float)
    if array.dtype != "float64":
        raise TypeError("JAX's numbers are of single precision: call jax.config.update('jax_enable_x64', True) first")
    return array


"""
PURE = (
    "They are pure, and take jit, vmap and grad. They compute with double precision, which JAX has to enable first: "
    "jax.config.update('jax_enable_x64', True), or JAX_ENABLE_X64=1 in the environment. A sign counts as constant."
)
JAX = Package(
    module="jax.numpy",
    usage=f"{USAGE} {PURE}",
    imports="import jax.numpy as xp",
    in_span=IN_SPAN,
    support=ARRAY + template("arrays.py.txt"),
    elsewhere={"erf": "jax.scipy.special"},
    differentiates=True,
)


def write_model(model: Model, name: str) -> str:
    """Write a model as a Python module that needs JAX.

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
    return module_text(model, name, JAX)
