"""Modules of SciPy by themselves.

All of ``scipy.linalg``, or ``scipy.integrate``, takes ten times as long to import as the one module that is wanted of
it, and longer than a short motion takes to be followed.
"""

import sys
from functools import cache
from importlib.machinery import PathFinder
from importlib.util import module_from_spec
from pathlib import Path
from types import ModuleType
from typing import Any


@cache
def lapack() -> ModuleType:
    """LAPACK."""
    if (compiled := _alone("scipy.linalg._flapack")) is not None:
        return compiled
    from scipy.linalg import lapack

    return lapack


@cache
def superlu() -> ModuleType:
    """SuperLU, which factors sparse matrices."""
    if (compiled := _alone("scipy.sparse.linalg._dsolve._superlu")) is not None:
        return compiled
    from scipy.sparse.linalg._dsolve import _superlu

    return _superlu


def dormand_prince() -> Any:
    """Coefficients of the method of Dormand and Prince, 8(5,3), as its attributes A, B, C, E3 and E5."""
    if (coefficients := _alone("scipy.integrate._ivp.dop853_coefficients")) is not None:
        return coefficients
    from scipy.integrate import DOP853

    return DOP853


def _alone(name: str) -> ModuleType | None:
    """A module of SciPy without the packages around it; None where SciPy has none of that name."""
    import scipy

    if name not in sys.modules:
        folders = name.split(".")[1:-1]
        found = PathFinder.find_spec(name, [str(Path(root, *folders)) for root in scipy.__path__])
        if found is None:
            return None
        sys.modules[name] = module_from_spec(found)  # the packages around it take the same one later
        found.loader.exec_module(sys.modules[name])
    return sys.modules[name]
