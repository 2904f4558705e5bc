"""The seed of random points."""

import secrets


def fresh_seed() -> str:
    """Draw an unpredictable seed.

    No equation can have been made to vanish at its points.

    Returns
    -------
    str
        16 hexadecimal digits.
    """
    return secrets.token_hex(8)
