"""The engines by name: adding one takes its file and a line here.

The first one begins a motion where nothing else is asked for; the last one goes on where another meets an obstacle.
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
