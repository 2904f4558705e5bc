"""The engines by name: adding one takes its file and a line here.

One begins a motion where nothing else is asked for, or the quickest of those that are compared; another one goes on
where that meets an obstacle, and is imported for that alone: SciPy takes long.
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
    """Return the class of an engine, imported when it is first asked for; see `Engine`."""
    module, _, attribute = ENGINES[name].partition(":")
    return getattr(import_module(module, __package__), attribute)


def compared_engines() -> list[Any]:
    """Return the classes of the engines that may begin a motion, `DEFAULT` first."""
    return [engine_class(name) for name in ENGINES if name != FALLBACK]
