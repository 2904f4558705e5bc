"""Machines on which bubblewrap cannot work: which tests ask for it, and what each command says there."""

import pytest

from holonom.cli.options import UNWALLED
from holonom.confined import bubblewrap

WALLS_STAND = bubblewrap() is not None

walled = pytest.mark.skipif(not WALLS_STAND, reason="bubblewrap is missing or forbidden")


def without_notice(said: str) -> str:
    """Standard error of a command, without the one line which says that no walls stand, where none can."""
    return said if WALLS_STAND else said.replace(f"{UNWALLED}\n", "", 1)
