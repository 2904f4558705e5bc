"""The seed of random points."""

import secrets


def fresh_seed() -> str:
    """Draw a seed that cannot be foreseen, for points at which no equation can have been made to vanish."""
    return secrets.token_hex(8)
