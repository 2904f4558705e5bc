"""The error of an expression without a value at a point."""


class IrregularPoint(ArithmeticError):
    """An expression has no finite real value at the point."""
