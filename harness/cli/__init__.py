"""The command line, thin: it reads options, calls one function, and shows or writes its result.

Exit status: 0 when all is well, 1 when a check fails, 2 for bad input, 3 where the machine lacks something, 70 after an
internal error, 130 when interrupted, 141 where nobody reads what is written.

Modules are imported inside the commands: ``holonom --help`` waits for no SymPy.
"""

from . import benchmark, companion, derivation, free_motion, installation, motion, programs, sweep
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
    "sweep",
]
