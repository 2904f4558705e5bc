"""The command line, thin: it reads options, calls one function, and shows or writes its result.

Modules are imported inside the commands: ``holonom --help`` waits for no SymPy.
"""

from . import benchmark, companion, derivation, free_motion, installation, motion, programs, stability, sweep
from .group import holonom, main, run

__all__ = [
    "benchmark",
    "companion",
    "derivation",
    "free_motion",
    "holonom",
    "installation",
    "main",
    "motion",
    "programs",
    "run",
    "stability",
    "sweep",
]
