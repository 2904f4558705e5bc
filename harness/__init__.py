"""Holonom: controllable holonomic systems, derived by Maxima, checked by SymPy, followed in numbers.

    import holonom
    scene = holonom.load("pendulum.mac")
    scene.equations, scene.check(), scene.free(), scene.series(), scene.simulate(until=10)

Importing the package imports nothing else and changes nothing; what a name needs is imported when it is first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .confined import Limits
    from .equations import Equations
    from .failures import HolonomError
    from .program.forms import MotionProgram
    from .scene import Scene, load, sweep, system

PUBLIC = {
    "load": ".scene",
    "system": ".scene",
    "sweep": ".scene",
    "Scene": ".scene",
    "Equations": ".equations",
    "MotionProgram": ".program.forms",
    "Limits": ".confined",
    "HolonomError": ".failures",
}
__all__ = ["Equations", "HolonomError", "Limits", "MotionProgram", "Scene", "load", "sweep", "system"]


def __getattr__(name: str) -> Any:
    if name not in PUBLIC:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(PUBLIC[name], __name__), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *PUBLIC})
