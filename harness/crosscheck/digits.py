"""Decimal digits and points of the comparison."""

DIGITS = 50
"""Digits to which two values agree at least."""

WORKING_DIGITS = DIGITS + 20
"""Digits carried, so that cancellation and a linear solve leave the stated ones untouched."""

CONFIRMING_DIGITS = 3 * WORKING_DIGITS
"""Digits in which each point is taken again."""

BOUNDING_DIGITS = (CONFIRMING_DIGITS, 4 * CONFIRMING_DIGITS)
"""Digits in which a difference is compared with the bound on its rounding error, the first that decide."""

POINTS = 8
"""Random points at which two expressions are compared."""
