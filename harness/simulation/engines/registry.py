"""Registry of the engines by name. A new engine needs its file and a line here.

The default engine, or the quickest of the compared ones, begins a motion: the default one estimates how many steps are
ahead. The robust engine continues at an obstruction. It is imported only then, because SciPy takes long to import.
"""

from importlib import import_module
from typing import Any

ENGINES = {
    "taylor": ".taylor:TaylorEngine",
    "runge-kutta": ".runge_kutta:RungeKuttaEngine",
    "robust": ".robust:RobustEngine",
}
DEFAULT, FALLBACK = "taylor", "robust"


def engine_class(name: str) -> Any:
    """Return the class of an engine, imported on first use.

    Parameters
    ----------
    name : str
        A key of `ENGINES`.

    Returns
    -------
    type
        It follows `Engine`.
    """
    module, _, attribute = ENGINES[name].partition(":")
    return getattr(import_module(module, __package__), attribute)


def compared_engines() -> list[Any]:
    """Return the classes of the engines that may begin a motion, `DEFAULT` first.

    Returns
    -------
    list of type
    """
    return [engine_class(name) for name in ENGINES if name != FALLBACK]
