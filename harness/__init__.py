"""Holonom derives, checks and simulates controllable holonomic systems.

Maxima derives the equations, SymPy checks them, and they are integrated numerically.

    import holonom
    scene = holonom.load("pendulum.mac")
    scene.equations, scene.check(), scene.free(), scene.series(), scene.simulate(until=10)

Importing the package imports no other module and has no side effect. A name imports its modules at its first use.
"""

from importlib import import_module

TYPE_CHECKING = False  # as in `typing`, which takes longer to import than all that is here
if TYPE_CHECKING:
    from .equations import Equations
    from .failures import HolonomError
    from .program.forms import MotionProgram
    from .sandbox import Limits, Sandbox
    from .scene import Scene, load, sweep, system

PUBLIC = {
    "load": ".scene",
    "system": ".scene",
    "sweep": ".scene",
    "Scene": ".scene",
    "Equations": ".equations",
    "MotionProgram": ".program.forms",
    "Limits": ".sandbox",
    "Sandbox": ".sandbox",
    "HolonomError": ".failures",
}
__all__ = ["Equations", "HolonomError", "Limits", "MotionProgram", "Sandbox", "Scene", "load", "sweep", "system"]


def __getattr__(name: str) -> object:
    if name not in PUBLIC:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(PUBLIC[name], __name__), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *PUBLIC})
