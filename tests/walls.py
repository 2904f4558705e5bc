"""Machines on which bubblewrap cannot work: which tests ask for it, and what each command says there."""

import pytest

from holonom.sandbox import UNCONFINED, has_sandbox

WALLS_STAND = has_sandbox()

walled = pytest.mark.skipif(not WALLS_STAND, reason="bubblewrap is missing or forbidden")


def without_notice(said: str) -> str:
    """Standard error of a command, without the one line which says that no walls stand, where none can."""
    return said if WALLS_STAND else said.replace(f"holonom: {UNCONFINED}\n", "", 1)
