"""Machines on which bubblewrap cannot work: the mark of tests that need it, and the line that commands print there."""

import pytest

from holonom.sandbox import UNSANDBOXED, has_sandbox

SANDBOXED = has_sandbox()

needs_sandbox = pytest.mark.skipif(not SANDBOXED, reason="bubblewrap is missing or forbidden")


def without_notice(said: str) -> str:
    """Remove the line about a missing sandbox from the standard error of a command, if this machine has none."""
    return said if SANDBOXED else said.replace(f"holonom: warning: {UNSANDBOXED}\n", "", 1)
