"""The command line: read options, call one function, show or write its result.

Modules are imported inside the commands, so that ``holonom --help`` does not import SymPy.
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
