"""Where something has no value."""


class IrregularPoint(ArithmeticError):
    """An expression has no finite real value at the point."""
